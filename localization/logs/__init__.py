"""Recorded drives: one model, a reader per format."""
