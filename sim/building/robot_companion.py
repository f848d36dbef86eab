"""What one robot of a building senses of the person whom it escorts."""

import math
from collections.abc import Callable

import numpy as np

from mend.robots.base.companion import Sighting
from mend.sim.building.building_robot import BuildingRobot
from mend.sim.building.draws import read_draws, written_draws
from mend.sim.building.floor_pose import FloorPose
from mend.sim.building.guests import Guests

RANGE_M = 6.0
PERIOD_S = 0.1
_NOISE_M, _NOISE_RAD = 0.05, 0.05


class RobotCompanion:
    """Implements `mend.robots.base.companion.Companion`: it sees all round, and not through walls.

    `sees`: whether nothing stands between two points of a floor.
    """

    range_m = RANGE_M

    def __init__(
        self,
        guests: Guests,
        robot: BuildingRobot,
        number: int,
        seed: int,
        sees: Callable[[FloorPose, FloorPose], bool],
    ) -> None:
        """`number`: which robot it belongs to."""
        self._guests, self._robot, self._number = guests, robot, number
        self._sees = sees
        self._rng = np.random.default_rng([seed, number, 0x5EE])
        self._seen_s = -math.inf
        self._seen: Sighting | None = None

    def expect(self, person: str, place: str) -> None:
        self._guests.expect(self._number, person, place)

    def lead(self, person: str) -> None:
        self._guests.lead(self._number, person)

    def leave(self) -> None:
        self._guests.leave(self._number, self._robot.time_s())

    def sighting(self) -> Sighting | None:
        now_s = self._robot.time_s()
        if now_s - self._seen_s >= PERIOD_S - 1e-9:
            self._seen_s, self._seen = now_s, self._look()
        return self._seen

    def _look(self) -> Sighting | None:
        guest, at = self._guests.there.get(self._number), self._robot.at
        if guest is None or guest.at.floor != at.floor:
            return None
        x, y = guest.at.x - at.x, guest.at.y - at.y
        if math.hypot(x, y) > RANGE_M or not self._sees(at, guest.at):
            return None
        off_m, off_rad = self._rng.normal(0.0, (_NOISE_M, _NOISE_RAD))
        return Sighting(
            max(0.0, math.hypot(x, y) + float(off_m)),
            math.remainder(math.atan2(y, x) - at.yaw + float(off_rad), math.tau),
        )

    def snapshot(self) -> str:
        """What its noise is drawn by next."""
        return written_draws(self._rng)

    def restore(self, draws: str) -> None:
        """Raises `ValueError` for draws that no generator wrote."""
        read_draws(self._rng, draws)
        self._seen_s, self._seen = -math.inf, None
