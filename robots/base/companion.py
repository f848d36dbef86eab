"""The person whom a base escorts: how it senses them, and whether they keep up."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from mend.robots.base.body import BasePose

FALLS_BEHIND_M = 3.0
"""A base that leads somebody stands once they are farther than this."""
CAUGHT_UP_M = 2.0
"""It goes on, and believes that somebody is there, once they are as near as this."""
GLIMPSE_S = 1.0
"""Who is out of sight for no longer, behind a corner, is still taken to follow."""
IN_CABIN_M = 0.45
"""Who is in a cabin is so near to its middle."""


@dataclass(frozen=True, slots=True)
class Sighting:
    """Where a person is seen: metres from the base's middle, radians from ahead, left positive."""

    distance_m: float
    bearing_rad: float

    @property
    def told(self) -> str:
        """How a robot says it: `3.2 m behind me`."""
        turn = abs(self.bearing_rad)
        if turn <= math.pi / 4:
            where = "ahead of me"
        elif turn >= 3 * math.pi / 4:
            where = "behind me"
        else:
            where = "to my left" if self.bearing_rad > 0.0 else "to my right"
        return f"{self.distance_m:.1f} m {where}"


class Companion(Protocol):
    """What tells a base where the person is whom it escorts: a camera, or a badge that they wear.

    `range_m`: so far it senses anybody.
    """

    @property
    def range_m(self) -> float: ...

    def expect(self, person: str, place: str) -> None:
        """Want to meet somebody at a place, who hears of it; saying so again changes nothing."""
        ...

    def lead(self, person: str) -> None:
        """Have somebody follow from now on; saying so again changes nothing."""
        ...

    def leave(self) -> None:
        """Lead nobody any more, and expect nobody."""
        ...

    def sighting(self) -> Sighting | None:
        """Where they are, off by a little; None when out of sight, or out of range."""
        ...


class NoCompanion:
    """Where a body senses nobody."""

    range_m = 0.0

    def expect(self, person: str, place: str) -> None:
        """Nobody hears it."""

    def lead(self, person: str) -> None:
        """Nobody follows."""

    def leave(self) -> None:
        """Nothing."""

    def sighting(self) -> Sighting | None:
        """Nobody."""
        return None


class Company:
    """What a robot makes of where it sees the person whom it escorts."""

    def __init__(self, companion: Companion, time_s: Callable[[], float]) -> None:
        self._companion, self._time_s = companion, time_s
        self._seen_s = -math.inf
        self._keeps_up = False
        self.last: Sighting | None = None
        """Where they were seen last."""

    def start_anew(self) -> None:
        """Nobody has been seen yet."""
        self._seen_s, self._keeps_up, self.last = -math.inf, False, None

    def is_within(self, distance_m: float) -> bool:
        """Whether they are seen as near as this now."""
        seen = self._look()
        return seen is not None and seen.distance_m <= distance_m

    def is_at(self, to: BasePose, within_m: float, here: BasePose) -> bool:
        """Whether they are seen so near to a pose now, from where the base is."""
        seen = self._look()
        if seen is None:
            return False
        heading = here.yaw + seen.bearing_rad
        x = here.x + seen.distance_m * math.cos(heading)
        y = here.y + seen.distance_m * math.sin(heading)
        return math.hypot(x - to.x, y - to.y) <= within_m

    def keeps_up(self) -> bool:
        """Whether they follow; once a cycle. Who fell behind has to catch up first."""
        seen = self._look()
        if seen is not None:
            most_m = FALLS_BEHIND_M if self._keeps_up else CAUGHT_UP_M
            self._keeps_up = seen.distance_m <= most_m
        elif self._time_s() - self._seen_s > GLIMPSE_S:
            self._keeps_up = False
        return self._keeps_up

    def _look(self) -> Sighting | None:
        seen = self._companion.sighting()
        if seen is not None:
            self.last, self._seen_s = seen, self._time_s()
        return seen
