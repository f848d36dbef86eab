"""Many robots and many helpers: scheduling with transfers, and whom to ask for help."""
