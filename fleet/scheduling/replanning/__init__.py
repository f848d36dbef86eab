"""A fleet at work: what happens to it, and what becomes of its plan."""
