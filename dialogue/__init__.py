"""Dialogue scripts: pure state machines of prompts, answers and resolutions."""
