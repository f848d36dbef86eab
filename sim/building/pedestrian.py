"""A person of a building: stands, or walks from place to place and minds robots as people do."""

import math
from dataclasses import dataclass

from mend.sim.building.building_robot import FloorPose

RADIUS_M = 0.25
WALKS_M_S = 1.2


@dataclass(slots=True)
class Pedestrian:
    """`goals`: where they still walk to, on their floor; nobody walks into what stands there."""

    at: FloorPose
    goals: tuple[tuple[float, float], ...] = ()

    def take(self, at: FloorPose) -> None:
        """Go to where nothing is in the way."""
        self.at = at
        if self.goals and math.hypot(self.goals[0][0] - at.x, self.goals[0][1] - at.y) < 1e-6:
            self.goals = self.goals[1:]

    def next_pose(self, period_s: float) -> FloorPose:
        """Where they are to be `period_s` later, if nothing is in their way."""
        if not self.goals:
            return self.at
        x, y = self.goals[0]
        left_m = math.hypot(x - self.at.x, y - self.at.y)
        share = min(1.0, WALKS_M_S * period_s / max(left_m, 1e-9))
        heading = math.atan2(y - self.at.y, x - self.at.x)
        return FloorPose(
            self.at.floor,
            self.at.x + share * (x - self.at.x),
            self.at.y + share * (y - self.at.y),
            heading,
        )
