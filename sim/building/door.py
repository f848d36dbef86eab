"""A door of the world: open or shut, by itself or by people."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from mend.maps.building.building import Door, DoorOpening
from mend.maps.building.clearance import distances_m
from mend.sim.building.floor_pose import FloorPose

NOTICES_M = 1.8
"""A door that opens itself does so when somebody is so near."""
_STAYS_OPEN_S = 4.0
"""After the last one has gone by."""
_OPENS_M = 1.0
_HOLDS_S = 10.0
"""Who walks opens a door that is so near, for so long."""


@dataclass(slots=True)
class WorldDoor:
    """`name`: `FLOOR/DOOR`; `is_shut` where it cannot be passed.

    `shuts_s`: when it falls shut if nobody is there; None for one that somebody left open.
    """

    name: str
    plan: Door
    is_shut: bool
    shuts_s: float | None = None
    is_locked: bool = False

    @property
    def segment(self) -> tuple[float, float, float, float]:
        """From post to post."""
        return (*self.plan.posts[0], *self.plan.posts[1])

    def distance_m(self, x: float, y: float) -> float:
        """How far a point is from the line between the posts."""
        return float(distances_m(np.array([[x, y]]), np.array([self.segment]))[0])

    def may_be_passed(self, time_s: float) -> bool:
        """Whether nobody has locked it, and it is one of the times at which it may be open."""
        spans = self.plan.open_s
        if self.is_locked:
            return False
        return not spans or any(opens <= time_s < shuts for opens, shuts in spans)

    def changes_s(self) -> Iterator[float]:
        """The times at which it may open or shut although nobody moves."""
        if not self.is_shut and self.shuts_s is not None:
            yield self.shuts_s
        for opens_s, shuts_s in self.plan.open_s:
            yield opens_s
            yield shuts_s

    @property
    def heeds_who_comes(self) -> bool:
        """Whether it may open or shut by itself; one that somebody left open or shut stays so."""
        opens = self.plan.opens is DoorOpening.ITSELF
        locks = self.is_locked and not self.is_shut
        return opens or locks or self.shuts_s is not None or bool(self.plan.open_s)

    def let_pass(self, time_s: float, *, somebody: bool) -> None:
        """One cycle: open for who is within `NOTICES_M`, shut behind them; on nobody."""
        if not self.may_be_passed(time_s):
            self.is_shut = self.is_shut or not somebody
            return
        if somebody and self.plan.opens is DoorOpening.ITSELF:
            self.hold_open(time_s + _STAYS_OPEN_S)
        elif self.shuts_s is not None and not somebody and time_s >= self.shuts_s:
            self.is_shut = True

    def lock(self) -> None:
        """Nobody opens it any more; it shuts once nobody is in it."""
        self.is_locked = True

    def unlock(self) -> None:
        """It is shut, and may be opened again."""
        self.is_locked = False

    def hold_open(self, until_s: float) -> None:
        """It is open, and does not fall shut before then."""
        self.is_shut, self.shuts_s = False, until_s


def open_doors(doors: Iterable[WorldDoor], at: FloorPose, time_s: float) -> bool:
    """Somebody who walks opens what is shut before them; whether anything was."""
    opened = False
    for door in doors:
        if (
            door.is_shut
            and door.name.startswith(f"{at.floor}/")
            and door.may_be_passed(time_s)
            and door.distance_m(at.x, at.y) < _OPENS_M
        ):
            door.hold_open(time_s + _HOLDS_S)
            opened = True
    return opened
