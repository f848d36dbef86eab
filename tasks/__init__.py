"""What is to be done: task trees, activation spreading, resolutions, scenes and their files."""
