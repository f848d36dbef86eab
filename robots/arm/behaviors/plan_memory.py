"""A plan that is made while a robot waits, so that it moves at once when it may go on."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mend.robots.arm.behaviors.assignment import Assignment
from mend.robots.arm.behaviors.planning import Plan
from mend.robots.body import Matrix4
from mend.robots.link.messages import Location
from mend.robots.vision.seen_box import SeenBox

_AT_REST = 1e-4
"""Metres, and parts of a unit vector: an arm that is held trembles by less."""


@dataclass(frozen=True, slots=True, eq=False)
class PlannedFor:
    """What a plan for empty hands depends on.

    `found`: where the object was seen; `boxes`: all else that was; `tool`: the tool point's pose.
    """

    assignment: Assignment
    found: Location | None
    boxes: Sequence[SeenBox]
    tool: Matrix4

    def is_same(self, other: "PlannedFor") -> bool:
        """Whether a plan for the one is a plan for the other."""
        mine, theirs = self.assignment, other.assignment
        return (
            type(mine.behavior) is type(theirs.behavior)
            and mine.parameters == theirs.parameters
            and mine.part == theirs.part
            and mine.target == theirs.target
            and self.found == other.found
            and list(self.boxes) == list(other.boxes)
            and bool(np.abs(self.tool - other.tool).max() < _AT_REST)
        )


class PlanMemory:
    """Keeps one plan, for one use: what failed once is not done the very same way again."""

    def __init__(self) -> None:
        self._kept: tuple[PlannedFor, Plan] | None = None

    def keep(self, made_for: PlannedFor, plan: Plan) -> None:
        """This is planned already."""
        self._kept = made_for, plan

    def knows(self, wanted: PlannedFor) -> bool:
        """Whether that is planned already."""
        return self._kept is not None and self._kept[0].is_same(wanted)

    def take(self, wanted: PlannedFor) -> Plan | None:
        """The plan that was kept, if it was made for just that; it is kept no longer."""
        plan = self._kept[1] if self._kept is not None and self.knows(wanted) else None
        self._kept = None
        return plan
