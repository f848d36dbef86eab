"""What the robot holds between its fingers, judged by their opening, their effort and a picture."""

from mend.robots.arm.grip.reading import GripReading, GripState

__all__ = ["GripReading", "GripState"]
