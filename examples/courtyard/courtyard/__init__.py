"""A courtyard: a world of robots that drive, with a behavior and a fault of their own."""
