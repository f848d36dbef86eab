"""Sites: simulated worlds that run with their robots, whether or not runs use them."""
