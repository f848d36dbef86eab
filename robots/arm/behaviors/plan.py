"""The plan of a behavior amid what is seen, and what keeps the arm from it if there is none."""

import math
from collections.abc import Sequence
from dataclasses import replace

from mend.robots.arm.behaviors.errand import Errand, errand_of
from mend.robots.arm.behaviors.grasp_choice import Crowding, others
from mend.robots.arm.behaviors.plan_memory import PlannedFor
from mend.robots.arm.behaviors.planning import Barred, Plan, bar_of, plan_amid
from mend.robots.arm.behaviors.work import Work
from mend.robots.arm.body import ToolPose
from mend.robots.arm.grasp import UngraspableError
from mend.robots.execution.routine import Routine
from mend.robots.vision.carriers import bears
from mend.robots.vision.obstruction import Obstruction, obstruction_at
from mend.robots.vision.seen_box import SeenBox


def make_plan(work: Work) -> Routine[Plan | None]:
    """Lay out the steps and plan their path; None if there is none, or the object is not seen.

    What it finds out about the way goes to what is seen. What keeps the arm from it is in the way
    if there is one without it, or if it leaves no room at the place; everything else is a reason
    to refuse.
    """
    assignment, perception, findings = work.assignment, work.perception, work.progress.seen
    part = assignment.part
    if part is not None and findings.sighting is None and not findings.carrying:
        return None
    boxes = others(part, perception.head.seen_boxes(findings.image or perception.head.look()))
    errand, table = errand_of(assignment, perception, findings), perception.catalogue.table
    try:
        found: Plan | Barred | None = None
        if not findings.carrying:
            wanted = PlannedFor(assignment, errand.found, boxes, work.arm.body.tool_pose())
            found = work.plans.take(wanted)
        if found is None:
            found = yield from plan_amid(errand, work.arm.body, table, boxes)
        _judge_way(found.way, work)
        if isinstance(found, Plan):
            return found
        bar = yield from _bar(found, errand, boxes, work)
    except UngraspableError as error:
        findings.refusal = str(error)
        return None
    reason = found.reason
    if isinstance(reason, Crowding):
        findings.refusal = str(reason)
    else:
        carrying = "" if part is None else f"with {part.name} "
        findings.refusal = f"{carrying}the arm {reason.reason}"
    findings.obstruction = findings.obstruction or bar
    return None


def _bar(
    barred: Barred, errand: Errand, boxes: Sequence[SeenBox], work: Work
) -> Routine[Obstruction | None]:
    """What could be taken away so that there is a path. Raises `UngraspableError`."""
    image, reason = work.progress.seen.image or work.perception.head.look(), barred.reason
    if isinstance(reason, Crowding):
        if not reason.at_place:
            return None
        return replace(obstruction_at(reason.by, image), what=str(reason))
    body, table = work.arm.body, work.perception.catalogue.table
    bar = yield from bar_of(
        barred,
        boxes,
        lambda fewer: plan_amid(errand, body, table, fewer),
        lambda box: carries(box, errand, table.height),
    )
    if bar is None:
        return None
    what = f"{bar.name or 'something unknown'} is in the arm's way"
    return replace(obstruction_at(bar, image), what=what)


def carries(box: SeenBox, errand: Errand, table_z: float) -> bool:
    """Whether the object of an errand stands on a box, or is to."""
    if errand.part is None:
        return False
    radius_m = math.hypot(*errand.part.size[:2]) / 2
    ends = [each for each in (errand.found, errand.target) if each is not None]
    spots = [(each.x, each.y, table_z if each.z is None else each.z) for each in ends]
    return any(bears(box, spot, radius_m) for spot in spots)


def _judge_way(way: Sequence[ToolPose], work: Work) -> None:
    """Note what is seen on the way, on the object, or at the place where that is to go."""
    perception, findings = work.perception, work.progress.seen
    findings.way = way
    findings.obstruction = None
    image, part, target = findings.image, work.assignment.part, work.assignment.target
    if image is not None:
        findings.obstruction = perception.head.obstruction(image, way, part)
    if findings.obstruction is None and part is not None:
        image = image or perception.head.look()
        findings.obstruction = perception.head.occupant(image, part, findings.sighting, target)
