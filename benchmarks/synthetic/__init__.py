"""Made-up drives over vector maps: furniture, walking people, removed walls, drifting odometry."""
