"""A run as a file for other programs: its events as CSV, all that it shows as MCAP."""
