"""The plan of a behavior: its steps, how to grasp the object, and a path amid what is seen."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from robots.arm import Arm
from robots.behaviors.assignment import Assignment, Findings
from robots.behaviors.behavior import Move, Situation, Step
from robots.behaviors.grasp_choice import (
    Crowding,
    Grip,
    crowding,
    grips,
    others,
    roominess_m,
    ways_to_grasp,
)
from robots.behaviors.legs import legs_of, table_box
from robots.body import ArmPath, NoWay, ToolPose
from robots.catalogue import Part
from robots.grasp import Grasp, UngraspableError
from robots.senses import Senses
from robots.vision.carriers import bears
from robots.vision.obstruction import Obstruction, obstruction_at
from robots.vision.seen_box import SeenBox

_MOST_BARS = 3
"""Where more stand in the arm's way, it is told to be out of reach."""


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


@dataclass(frozen=True, slots=True)
class _Way:
    """One way of doing it: its steps, the first that is to walk, and what leaves it least room."""

    steps: Sequence[Step]
    first: int
    grasp: Grasp | None
    tight: Crowding | None

    @property
    def left(self) -> Sequence[Step]:
        return self.steps[self.first - 1 :]


def make_plan(assignment: Assignment, arm: Arm, senses: Senses, findings: Findings) -> Plan | None:
    """Lay out the steps and plan their path; None if there is none, or the object is not seen.

    Of the ways of grasping the object for which there is a path the one with most room is taken, up
    to enough; of equals the first. What it finds out about the way goes to `findings`. What keeps
    the arm from it is in the way if there is one without it, or if it leaves no room at the place;
    everything else is a reason to refuse.
    """
    part = assignment.part
    if part is not None and findings.sighting is None and not findings.carrying:
        return None
    boxes = others(part, senses.seen_boxes(findings.image or senses.look()))
    try:
        found = _plan_amid(boxes, assignment, arm, senses, findings)
        if isinstance(found, Plan):
            return found
        seen = findings.obstruction
        bar = None
        if isinstance(found, NoWay):
            bar = _bar(found, boxes, assignment, arm, senses, findings)
    except UngraspableError as error:
        findings.refusal = str(error)
        return None
    image = findings.image or senses.look()
    if isinstance(found, Crowding):
        findings.refusal = str(found)
        if found.at_place:
            bar = replace(obstruction_at(found.by, image), what=str(found))
    else:
        findings.refusal = f"with {_name(part)} the arm {found.reason}"
    findings.obstruction = seen or bar
    return None


def _bar(
    found: NoWay,
    boxes: Sequence[SeenBox],
    assignment: Assignment,
    arm: Arm,
    senses: Senses,
    findings: Findings,
) -> Obstruction | None:
    """What could be taken away so that there is a path; None if that would not help.

    What the object stands on, or is to stand on, cannot. Raises `UngraspableError`.
    """
    first: SeenBox | None = None
    for _ in range(_MOST_BARS):
        touched = found.touched
        if touched is None or touched not in boxes:
            return None
        if _carries(touched, assignment, senses, findings):
            return None
        first = first or touched
        # A plate and its knob have one name; pieces of something unknown have none, and go at once.
        boxes = [each for each in boxes if each.name != touched.name]
        without = _plan_amid(boxes, assignment, arm, senses, findings)
        if isinstance(without, Plan):
            what = f"{first.name or 'something unknown'} is in the arm's way"
            return replace(obstruction_at(first, findings.image or senses.look()), what=what)
        if isinstance(without, Crowding):
            return None
        found = without
    return None


def _carries(box: SeenBox, assignment: Assignment, senses: Senses, findings: Findings) -> bool:
    part, seen, target = assignment.part, findings.sighting, assignment.target
    if part is None:
        return False
    radius_m = math.hypot(*part.size[:2]) / 2
    spots = [] if seen is None else [(seen.x, seen.y, seen.z)]
    if target is not None:
        spots.append((target.x, target.y, senses.catalogue.height_of(target)))
    return any(bears(box, spot, radius_m) for spot in spots)


def _plan_amid(
    boxes: Sequence[SeenBox], assignment: Assignment, arm: Arm, senses: Senses, findings: Findings
) -> Plan | NoWay | Crowding:
    """The plan amid some boxes, or why there is none: no path, or no room.

    Raises `UngraspableError`.
    """
    part = assignment.part
    obstacles = [table_box(senses.catalogue.table), *boxes]
    refusals: list[NoWay | Crowding] = []
    situations = ways_to_grasp(assignment, arm, senses, findings, boxes)
    ways = _lay_out(situations, assignment, arm, findings, boxes)
    for way in sorted(ways, key=lambda each: -roominess_m(each.tight)):
        if not refusals:
            _judge_way(waypoints_of(way.left), assignment, senses, findings)
        if way.tight is not None and way.tight.is_too_much:
            refusals.append(way.tight)
            continue
        legs = legs_of(way.left, part, way.grasp, arm.body.gripper, carrying=findings.carrying)
        path = arm.body.plan_among(legs, obstacles) if legs else None
        if isinstance(path, NoWay):
            refusals.append(path)
            continue
        if refusals:
            # What stands in a way that is not taken is in nobody's way.
            _judge_way(waypoints_of(way.left), assignment, senses, findings)
        return Plan(way.steps, way.first, path, way.grasp)
    # Where there was room, that there is none in another way is no reason.
    return next((each for each in refusals if isinstance(each, NoWay)), refusals[0])


def _lay_out(
    situations: Iterable[Situation],
    assignment: Assignment,
    arm: Arm,
    findings: Findings,
    boxes: Sequence[SeenBox],
) -> list[_Way]:
    """The ways that begin in some situations, in their order."""
    gripper, ways = arm.body.gripper, []
    known: dict[Sequence[Grip], Crowding | None] = {}
    for situation in situations:
        steps = assignment.behavior.steps(assignment.parameters, situation)
        first = assignment.behavior.first_carrying(steps) if findings.carrying else None
        first = 1 if first is None else first
        # Ways that only pass higher grasp and let go alike.
        closings = grips(steps[first - 1 :], situation.grasp, gripper)
        if closings not in known:
            known[closings] = crowding(closings, gripper, boxes)
        ways.append(_Way(steps, first, situation.grasp, known[closings]))
    return ways


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
