"""Where robots connect."""

ROBOT_PATH = "/ws/robot"


def robots_url(url: str) -> str:
    """Where the robots of the service at an address connect."""
    return f"ws{url.removeprefix('http')}{ROBOT_PATH}"
