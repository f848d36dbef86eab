"""Finished results that a behavior covers: whether they are there until nobody can see them."""

from mend.robots.arm.behaviors.assignment import Assignment
from mend.robots.arm.perception import Perception
from mend.robots.arm.result import JudgedResult
from mend.robots.catalogue import Part
from mend.robots.execution.monitor import Reaction
from mend.robots.execution.phase import Phase
from mend.robots.execution.watch import Interruption
from mend.robots.link.messages import Location
from mend.tasks.footprint import Footprint

LOOK_PERIOD_S = 0.5

_PHASES = frozenset({Phase.LIFT, Phase.CARRY, Phase.PLACE})
_ON_TOP_M = 0.01


class CoveredResultGone(Interruption):
    """Something that the object is to be put on is seen gone."""

    def __init__(self) -> None:
        super().__init__(Reaction.GO_TO_NEUTRAL, "a result that is about to be covered is gone")


class Covering:
    """Looks past the arm at what the object will cover, while it is on its way there.

    What it has told of once it does not tell again: whoever was told decides how to go on.
    """

    def __init__(self, assignment: Assignment, perception: Perception) -> None:
        self._perception = perception
        self._watched = _covered(assignment, perception)
        self._doubted: list[JudgedResult] = []
        self._next_look_s = 0.0

    def look_if_due(self, phase: Phase, now_s: float) -> None:
        """Raises `CoveredResultGone` for what two pictures on end show to be gone."""
        if not self._watched or phase not in _PHASES:
            return
        if now_s < self._next_look_s - 1e-9 and not self._doubted:
            return
        self._next_look_s = now_s + LOOK_PERIOD_S
        gone = self._perception.head.seen_gone(self._perception.head.look(), self._watched)
        sure = [each for each in gone if each in self._doubted]
        self._watched = [each for each in self._watched if each not in sure]
        self._doubted = [each for each in gone if each not in sure]
        if sure:
            raise CoveredResultGone


def _covered(assignment: Assignment, perception: Perception) -> list[JudgedResult]:
    part, target = assignment.part, assignment.target
    if part is None or target is None:
        return []
    height_of = perception.catalogue.height_of
    own, bottom_z = _footprint(part, target), height_of(target)
    return [
        each
        for each in assignment.finished
        if height_of(each.target) + each.part.size[2] <= bottom_z + _ON_TOP_M
        and own.overlaps(_footprint(each.part, each.target))
    ]


def _footprint(part: Part, at: Location) -> Footprint:
    return Footprint(at.x, at.y, at.yaw, part.size[0], part.size[1])
