"""Mend: runs robots through task trees, and asks a person for help when they fail."""
