"""Speech: what the robot says aloud, and what a person answers by voice."""
