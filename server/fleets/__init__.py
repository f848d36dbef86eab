"""Fleets: what people of a building ask for becomes legs, and each leg a run of one robot."""
