"""Before the first step: whether the object is held, where it is, how to grasp it, the path."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from robots.arm import Arm, Routine
from robots.behaviors.assignment import Assignment, Findings
from robots.behaviors.behavior import Move, Step
from robots.behaviors.grasp_choice import Crowding, crowding, others, ways_to_grasp
from robots.behaviors.legs import legs_of, table_box
from robots.body import ArmPath, CameraImage, NoWay, ToolPose
from robots.catalogue import Part
from robots.grasp import Grasp, UngraspableError
from robots.senses import Senses
from robots.vision.obstruction import Obstruction, obstruction_at, obstruction_by
from robots.vision.seen_box import SeenBox

LOOKS = 3
"""So often a part that is not wholly seen is looked for before that is believed."""
LOOK_AGAIN_S = 0.1


@dataclass(frozen=True, slots=True)
class Plan:
    """All steps, the number of the first that is still to walk, and the path from there on."""

    steps: Sequence[Step]
    first: int
    path: ArmPath | None
    grasp: Grasp | None

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


def check_carrying(part: Part | None, arm: Arm, senses: Senses) -> Routine[bool]:
    """Whether the object is in the gripper now, by fresh forearm pictures."""
    if part is None or not senses.holds(part.name):
        return False
    for _ in range(LOOKS):
        senses.read_grip()
        yield from arm.wait(senses.forearm_period_s)
    return senses.holds(part.name)


def find(part: Part | None, arm: Arm, senses: Senses, findings: Findings) -> Routine[None]:
    """Look for the object, again if it is not wholly seen.

    What something hides is taken to be where it was last seen whole: the fingers will tell.
    """
    for attempt in range(LOOKS):
        if attempt:
            yield from arm.wait(LOOK_AGAIN_S)
            if findings.sighting is None:
                senses.doubt()
        findings.image = senses.look()
        if part is None:
            return
        findings.sighting = senses.sight(part, findings.image)
        if findings.sighting is not None and findings.sighting.complete:
            return
    if part is not None and findings.sighting is None and findings.image is not None:
        findings.sighting = senses.recall(part, findings.image)


def make_plan(assignment: Assignment, arm: Arm, senses: Senses, findings: Findings) -> Plan | None:
    """Lay out the steps and plan their path; None if there is none, or the object is not seen.

    The first way of grasping the object is taken for which there is room and a path. What it
    finds out about the way goes to `findings`. What keeps the arm from it is in the way if it is
    unknown or leaves no room at the place; everything else is a reason to refuse.
    """
    part = assignment.part
    if part is not None and findings.sighting is None and not findings.carrying:
        return None
    boxes = others(part, senses.seen_boxes(findings.image or senses.look()))
    try:
        found = _plan_amid(boxes, assignment, arm, senses, findings)
        if isinstance(found, Plan):
            return found
        known = [each for each in boxes if each.name is not None]
        if isinstance(found, NoWay) and findings.obstruction is None and len(known) < len(boxes):
            without = _plan_amid(known, assignment, arm, senses, findings)
            if isinstance(without, Plan):
                strange = [each for each in boxes if each.name is None]
                image = findings.image or senses.look()
                findings.obstruction = obstruction_by(strange, findings.way, image)
                return None
    except UngraspableError as error:
        findings.refusal = str(error)
        return None
    if isinstance(found, Crowding):
        findings.refusal = str(found)
        if found.at_place and findings.obstruction is None:
            findings.obstruction = _standing_there(found, findings.image or senses.look())
    else:
        findings.refusal = f"with {_name(part)} the arm {found.reason}"
    return None


def _standing_there(found: Crowding, image: CameraImage) -> Obstruction:
    return replace(obstruction_at(found.by, image), what=str(found))


def _plan_amid(
    boxes: Sequence[SeenBox], assignment: Assignment, arm: Arm, senses: Senses, findings: Findings
) -> Plan | NoWay | Crowding:
    """The plan amid some boxes, or why there is none: no path, or no room.

    Raises `UngraspableError`.
    """
    part = assignment.part
    obstacles = [table_box(senses.catalogue.table), *boxes]
    refusals: list[NoWay | Crowding] = []
    for situation in ways_to_grasp(assignment, arm, senses, findings, boxes):
        steps = assignment.behavior.steps(assignment.parameters, situation)
        first = assignment.behavior.first_carrying(steps) if findings.carrying else None
        first = 1 if first is None else first
        left = steps[first - 1 :]
        if not refusals:
            _judge_way(waypoints_of(left), assignment, senses, findings)
        tight = crowding(left, arm.body.gripper, boxes)
        if tight is not None:
            refusals.append(tight)
            continue
        gripper, grasp = arm.body.gripper, situation.grasp
        legs = legs_of(left, part, grasp, gripper, carrying=findings.carrying)
        path = arm.body.plan_among(legs, obstacles) if legs else None
        if isinstance(path, NoWay):
            refusals.append(path)
            continue
        if refusals:
            # What stands in a way that is not taken is in nobody's way.
            _judge_way(waypoints_of(left), assignment, senses, findings)
        return Plan(steps, first, path, situation.grasp)
    # Where there was room, that there is none in another way is no reason.
    return next((each for each in refusals if isinstance(each, NoWay)), refusals[0])


def goes_on_carrying(assignment: Assignment, arm: Arm, senses: Senses) -> bool:
    """Whether the behavior has a step at which to go on with its object in the gripper."""
    (situation, *_) = ways_to_grasp(assignment, arm, senses, Findings(carrying=True), ())
    steps = assignment.behavior.steps(assignment.parameters, situation)
    return assignment.behavior.first_carrying(steps) is not None


def _name(part: Part | None) -> str:
    return "the place" if part is None else part.name


def _judge_way(
    way: Sequence[ToolPose], assignment: Assignment, senses: Senses, findings: Findings
) -> None:
    """Note what is seen on the way, on the object, or at the place where that is to go."""
    findings.way = way
    findings.obstruction = None
    image, part = findings.image, assignment.part
    if image is not None:
        findings.obstruction = senses.obstruction(image, way, part)
    if findings.obstruction is None and part is not None:
        image = image or senses.look()
        findings.obstruction = senses.occupant(image, part, findings.sighting, assignment.target)


def waypoints_of(steps: Sequence[Step]) -> list[ToolPose]:
    """The poses that steps move through."""
    return [each.action.to for each in steps if isinstance(each.action, Move)]
