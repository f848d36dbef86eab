"""Readers of published benchmark instances, and the generator of buildings."""
