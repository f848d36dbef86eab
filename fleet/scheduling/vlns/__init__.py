"""Simulated annealing over very large neighbourhoods, with transfers."""
