"""Requests of one building's people, handed out to its robots leg by leg."""
