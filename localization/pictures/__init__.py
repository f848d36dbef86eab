"""Pictures of drives: map, trajectory, covariances, and what each point was taken for."""
