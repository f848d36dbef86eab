"""Worlds that stand in for hardware, and the simulated person who intervenes in them."""
