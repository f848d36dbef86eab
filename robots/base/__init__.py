"""What belongs to a base that drives: its body, behaviors, monitors and looks."""
