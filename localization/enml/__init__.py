"""Episodic non-Markov localization: mapped walls, furniture for a while, moving things."""
