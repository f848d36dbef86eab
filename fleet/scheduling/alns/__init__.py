"""Adaptive large neighbourhood search: items are removed from a plan and inserted again."""
