"""Corrective gradient refinement: few particles, each moved to where the map explains it best."""
