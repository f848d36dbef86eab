"""A part as the head camera sees it."""

import math
from dataclasses import dataclass

from mend.robots.arm.grasp import half_turn
from mend.robots.catalogue import Part
from mend.robots.link.messages import Sighting
from mend.robots.vision.blob import Blob


@dataclass(frozen=True, slots=True, eq=False)
class HeadSighting:
    """An object in the head picture, in the base frame.

    (x, y, z) is the bottom centre, `yaw` of the part's own x axis (in [-pi/2, pi/2): parts look
    the same after half a turn), `top_z` the height of its top surface, without its knob. What has
    `toppled` lies on a side: bottom, top and axis are then those of how it lies.
    `complete` is False when so much of the top is hidden or outside the picture that the place
    may be wrong. `shown` is the share of the top that is seen.
    """

    x: float
    y: float
    z: float
    yaw: float
    top_z: float
    complete: bool
    shown: float
    blob: Blob
    time: float
    toppled: bool = False

    def to_message(self, part: Part) -> Sighting:
        """As the robot protocol tells it: with the yaw of the long axis."""
        turn = math.pi / 2 if part.size[1] > part.size[0] else 0.0
        yaw = half_turn(self.yaw + turn)
        return Sighting(x=self.x, y=self.y, z=self.z, yaw=yaw, time=self.time)
