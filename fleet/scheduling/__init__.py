"""Scheduling deliveries over several robots, with transfers between them. Pure algorithms."""
