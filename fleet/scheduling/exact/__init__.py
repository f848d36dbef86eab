"""Optimal schedules with transfers, by constraint programming (OR-Tools CP-SAT)."""
