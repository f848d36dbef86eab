"""How far off robots of a building are while they say that they know where they are."""

import math
from collections import Counter
from collections.abc import Sequence

import numpy as np

from mend.sim.building.building_robot import BuildingRobot

FAR_M, FAR_S = 2.0, 2.0
"""Who is farther off for longer, and says nothing of it, is wrong in silence."""


class BelievedPoses:
    """Looks at robots again and again, and judges what they believe by where they really are."""

    def __init__(self, robots: Sequence[BuildingRobot]) -> None:
        self.robots = robots
        self._far_s: Counter[int] = Counter()
        self._lost_since_s: dict[int, float] = {}
        self.lied_to: set[int] = set()
        """Robots by their numbers, whom somebody has told something that is not so."""
        self.off_m: list[float] = []
        self.silent: Counter[str] = Counter()
        """How often one was wrong in silence; apart from that, after a lie."""
        self.silent_s = 0.0
        self.lost_s: list[float] = []
        """How long each was lost that has found out since where it is."""

    def look(self, time_s: float, since_s: float) -> None:
        """As things are now; the look before was `since_s` ago."""
        for number, robot in enumerate(self.robots):
            if robot.belief is None:
                continue
            believed, lost = robot.belief.at, robot.whereabouts.is_lost
            off_m = math.hypot(believed.x - robot.at.x, believed.y - robot.at.y)
            self._note_lost(number, time_s, lost=lost)
            if not lost:
                self.off_m.append(off_m)
            before_s = self._far_s[number]
            far_s = before_s + since_s if off_m > FAR_M and not lost else 0.0
            self._far_s[number] = far_s  # type: ignore[assignment]
            self.silent_s += since_s if far_s else 0.0
            if before_s < FAR_S <= far_s:
                self.silent["silent after a lie" if number in self.lied_to else "silent"] += 1
            if off_m < FAR_M:
                self.lied_to.discard(number)

    @property
    def still_lost(self) -> int:
        """How many do not know where they are."""
        return len(self._lost_since_s)

    @property
    def told(self) -> str:
        """How far off they were; nothing where they know where they are."""
        if not self.off_m:
            return ""
        p50, p95, most = np.percentile(self.off_m, [50, 95, 100])
        return f"; off {p50:.3f} m (p50), {p95:.3f} m (p95), {most:.2f} m (max)"

    def _note_lost(self, number: int, time_s: float, *, lost: bool) -> None:
        if lost:
            self._lost_since_s.setdefault(number, time_s)
        elif number in self._lost_since_s:
            self.lost_s.append(time_s - self._lost_since_s.pop(number))
