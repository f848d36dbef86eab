"""Web push: calls helpers on their devices, also while no page of the console is open."""
