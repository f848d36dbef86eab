"""Before the first step: whether the object is held, where it is, and the path to walk."""

from collections.abc import Sequence
from dataclasses import dataclass

from robots.arm import Arm, Routine
from robots.behaviors.behavior import Behavior, Move, Situation, Step
from robots.body import ArmPath, CameraImage, ToolPose
from robots.catalogue import Part
from robots.link.messages import Location, WasDone
from robots.senses import Senses
from robots.vision.head import HeadSighting
from robots.vision.obstruction import Obstruction
from tasks.scene import StrictModel

LOOKS = 3
"""So often a part that is not wholly seen is looked for before that is believed."""
LOOK_AGAIN_S = 0.1


@dataclass(frozen=True, slots=True)
class Assignment:
    """What is to be executed, under which id; `was_done` as a `start` command has it."""

    execution: str
    behavior: Behavior
    parameters: StrictModel
    part: Part | None
    target: Location | None
    needs_help: bool
    was_done: WasDone | None = None


@dataclass(frozen=True, slots=True)
class Plan:
    """All steps, the number of the first that is still to walk, and the path from there on."""

    steps: Sequence[Step]
    first: int
    path: ArmPath | None

    def segment_of(self, number: int) -> int:
        """Which segment of the path a moving step follows."""
        return len(waypoints_of(self.steps[self.first - 1 : number - 1]))

    @property
    def picked_at(self) -> ToolPose | None:
        """Where the tool point is when the gripper first closes; None if it holds already."""
        pose = None
        for step in self.steps[self.first - 1 :]:
            if isinstance(step.action, Move):
                pose = step.action.to
            elif step.action.to == "closed":
                return pose
        return None


@dataclass(slots=True)
class Findings:
    """What was seen before the first step; `carrying`: the object is in the gripper already."""

    carrying: bool = False
    image: CameraImage | None = None
    sighting: HeadSighting | None = None
    path_found: bool = True
    obstruction: Obstruction | None = None


def check_carrying(part: Part | None, arm: Arm, senses: Senses) -> Routine[bool]:
    """Whether the object is in the gripper now, by fresh forearm pictures."""
    if part is None or not senses.holds(part.name):
        return False
    for _ in range(LOOKS):
        senses.read_grip()
        yield from arm.wait(senses.forearm_period_s)
    return senses.holds(part.name)


def find(part: Part | None, arm: Arm, senses: Senses, findings: Findings) -> Routine[None]:
    """Look for the object, again if it is not wholly seen."""
    for attempt in range(LOOKS):
        if attempt:
            yield from arm.wait(LOOK_AGAIN_S)
        findings.image = senses.look()
        if part is None:
            return
        findings.sighting = senses.sight(part, findings.image)
        if findings.sighting is not None and findings.sighting.complete:
            return


def make_plan(assignment: Assignment, arm: Arm, senses: Senses, findings: Findings) -> Plan | None:
    """Lay out the steps and plan their path; None if there is none, or the object is not seen.

    What it finds out about the way goes to `findings`.
    """
    sighting, part = findings.sighting, assignment.part
    if part is not None and sighting is None and not findings.carrying:
        return None
    steps = _lay_out(assignment, sighting, senses)
    first = assignment.behavior.first_carrying(steps) if findings.carrying else None
    first = 1 if first is None else first
    waypoints = waypoints_of(steps[first - 1 :])
    path = arm.body.plan_path(waypoints) if waypoints else None
    if waypoints and path is None:
        findings.path_found = False
        return None
    findings.obstruction = _obstruction(assignment, waypoints, arm, senses, findings)
    return Plan(steps, first, path)


def goes_on_carrying(assignment: Assignment, senses: Senses) -> bool:
    """Whether the behavior has a step at which to go on with its object in the gripper."""
    steps = _lay_out(assignment, None, senses)
    return assignment.behavior.first_carrying(steps) is not None


def _lay_out(
    assignment: Assignment, sighting: HeadSighting | None, senses: Senses
) -> Sequence[Step]:
    found = None
    if sighting is not None:
        found = Location(x=sighting.x, y=sighting.y, z=sighting.z, yaw=sighting.yaw)
    situation = Situation(assignment.part, found, assignment.target, senses.catalogue.table.height)
    return assignment.behavior.steps(assignment.parameters, situation)


def _obstruction(
    assignment: Assignment,
    waypoints: Sequence[ToolPose],
    arm: Arm,
    senses: Senses,
    findings: Findings,
) -> Obstruction | None:
    """What is seen on the way, on the object, or at the place where that is to go."""
    if findings.image is not None:
        on_the_way = senses.obstruction(findings.image, waypoints, arm.at_neutral)
        if on_the_way is not None:
            return on_the_way
    if assignment.part is None:
        return None
    image = findings.image or senses.look()
    return senses.occupant(
        image, assignment.part, findings.sighting, assignment.target, arm.at_neutral
    )


def waypoints_of(steps: Sequence[Step]) -> list[ToolPose]:
    """The poses that steps move through."""
    return [each.action.to for each in steps if isinstance(each.action, Move)]
