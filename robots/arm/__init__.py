"""What belongs to an arm with a gripper and cameras: its body, behaviors, monitors and looks."""
