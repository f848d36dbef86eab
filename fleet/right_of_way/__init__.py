"""Robots that meet where they cannot pass each other: which of them makes way, and where to."""
