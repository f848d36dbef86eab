"""Schedules as pictures: who does what when, and where; SVG that needs nothing else."""
