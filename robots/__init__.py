"""What one robot does and senses: behaviors, fault monitors, vision and its end of the link."""
