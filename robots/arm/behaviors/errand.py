"""An errand: an object, where it is and where it is to be, and the steps that bring it there."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from mend.robots.arm.behaviors.assignment import Assignment
from mend.robots.arm.behaviors.behavior import Situation, Step
from mend.robots.arm.behaviors.findings import Findings
from mend.robots.arm.grasp import Grasp
from mend.robots.arm.perception import Perception
from mend.robots.catalogue import Part
from mend.robots.link.messages import Location


@dataclass(frozen=True, slots=True)
class Errand:
    """What an arm is to do, and how steps are laid out for a situation.

    `carrying`: the object is in the gripper already, by `held_by` where that is known. `first`
    tells the number (from 1) of the first step that is still to walk.
    """

    lay_out: Callable[[Situation], Sequence[Step]]
    part: Part | None
    found: Location | None
    target: Location | None
    carrying: bool = False
    held_by: Grasp | None = None
    first: Callable[[Sequence[Step]], int] = lambda _: 1


def errand_of(assignment: Assignment, perception: Perception, findings: Findings) -> Errand:
    """What is to be executed, with the object where it was seen."""
    behavior, seen, grip = assignment.behavior, findings.sighting, perception.hand.grip
    found = None
    if seen is not None and assignment.part is not None:
        found = Location(x=seen.x, y=seen.y, z=seen.z, yaw=seen.yaw)

    def first(steps: Sequence[Step]) -> int:
        return (behavior.first_carrying(steps) or 1) if findings.carrying else 1

    return Errand(
        lambda situation: behavior.steps(assignment.parameters, situation),
        assignment.part,
        found,
        assignment.target,
        carrying=findings.carrying,
        held_by=grip.grasp if findings.carrying and grip is not None else None,
        first=first,
    )
