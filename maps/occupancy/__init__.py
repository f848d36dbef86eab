"""Occupancy maps, as Nav2's map server has them, and the lines in them."""
