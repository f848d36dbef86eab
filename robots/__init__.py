"""What one robot does and perception: behaviors, fault monitors, vision and its end of the link."""
