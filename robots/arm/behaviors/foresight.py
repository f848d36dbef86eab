"""Planning ahead: what an arm that waits would do if it were to begin again now."""

from mend.robots.arm.behaviors.errand import errand_of
from mend.robots.arm.behaviors.findings import Findings
from mend.robots.arm.behaviors.grasp_choice import others
from mend.robots.arm.behaviors.plan_memory import PlannedFor
from mend.robots.arm.behaviors.planning import Plan, plan_amid
from mend.robots.arm.behaviors.work import Work
from mend.robots.arm.grasp import UngraspableError


def plan_ahead(work: Work) -> None:
    """Plan for empty hands by what is seen, unless that is planned, or takes more than one try."""
    part, perception = work.assignment.part, work.perception
    if part is None or perception.hand.holds() or not work.arm.at_rest:
        return
    image = perception.head.look()
    if perception.head.why_blind(image) is not None:
        return
    sighting = perception.head.sight(part, image)
    if sighting is None or not sighting.complete:
        return
    boxes = others(part, perception.head.seen_boxes(image))
    errand = errand_of(work.assignment, perception, Findings(image=image, sighting=sighting))
    wanted = PlannedFor(work.assignment, errand.found, boxes, work.arm.body.tool_pose())
    if work.plans.knows(wanted):
        return
    try:
        next(plan_amid(errand, work.arm.body, perception.catalogue.table, boxes))
    except StopIteration as end:
        if isinstance(end.value, Plan):
            work.plans.keep(wanted, end.value)
            # What is on its way is looked for once while nothing changes.
            perception.head.obstruction(image, end.value.way, part)
            perception.head.occupant(image, part, sighting, work.assignment.target)
    except UngraspableError:
        return
