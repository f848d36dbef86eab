"""The service's end of the robot link: who is connected, and the processes of simulated robots."""
