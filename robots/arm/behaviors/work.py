"""Work: an assignment, how far it has come, and the arm and perception that do it."""

from collections.abc import Callable
from dataclasses import dataclass

from mend.robots.arm.arm import Arm
from mend.robots.arm.behaviors.assignment import Assignment
from mend.robots.arm.behaviors.plan_memory import PlanMemory
from mend.robots.arm.behaviors.progress import ArmProgress
from mend.robots.arm.perception import Perception
from mend.robots.catalogue import Part
from mend.robots.link.messages import Location, ReportBody


@dataclass(frozen=True, slots=True)
class Work:
    """What all that prepares, walks and watches one execution shares; reports go to `report`.

    `plans` has what was planned while the arm waited, maybe by an execution before.
    """

    assignment: Assignment
    progress: ArmProgress
    arm: Arm
    perception: Perception
    report: Callable[[ReportBody], None]
    plans: PlanMemory

    @property
    def unconfirmed(self) -> tuple[Part, Location] | None:
        """The object and its place, if it was placed there and that could not be seen."""
        part, target = self.assignment.part, self.assignment.target
        if part is None or target is None or not self.progress.unconfirmed:
            return None
        return part, target
