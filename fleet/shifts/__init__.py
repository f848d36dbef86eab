"""Shifts drawn by a seed for any building: what people ask, and what happens meanwhile."""
