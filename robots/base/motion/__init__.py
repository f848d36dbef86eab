"""How a base moves along its way: what its laser shows, the way round that, and velocities."""
