"""Buildings: floors with walls, places, lanes and doors, and the elevators between them."""
