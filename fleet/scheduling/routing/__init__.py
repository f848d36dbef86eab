"""Routes without transfers: ejection chains for few robots, adaptive large neighbourhood search."""
