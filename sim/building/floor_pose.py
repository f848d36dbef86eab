"""Where something is in a building."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class FloorPose:
    """Where something is: a floor by its name, a pose in the building's frame (metres, radians)."""

    floor: str
    x: float
    y: float
    yaw: float = 0.0
