"""Whether a base has come to believe that it is elsewhere than where it drove."""

import math

from mend.robots.base.body import BasePose

_FAR_M = 0.5
_FAR_RAD = 0.5
"""Less is steered against; after more the way there is no longer the one that was laid out."""


class Jumps:
    """Compares each pose with where the wheels have led since the one before."""

    def __init__(self) -> None:
        self._before: tuple[BasePose, BasePose] | None = None

    def note(self, here: BasePose, wheels: BasePose) -> bool:
        """Whether the pose jumped since the last call."""
        before, self._before = self._before, (here, wheels)
        if before is None:
            return False
        led = _driven(*before, wheels)
        return led.distance_m(here) > _FAR_M or led.turned_by_rad(here) > _FAR_RAD


def _driven(here: BasePose, was: BasePose, wheels: BasePose) -> BasePose:
    """Where who was here is now, by the wheels then and now."""
    turn = here.yaw - was.yaw
    x, y = wheels.x - was.x, wheels.y - was.y
    return BasePose(
        here.x + math.cos(turn) * x - math.sin(turn) * y,
        here.y + math.sin(turn) * x + math.cos(turn) * y,
        wheels.yaw + turn,
        here.z,
    )
