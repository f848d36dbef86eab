"""What in a scene a robot cannot do, found out before anything moves."""
