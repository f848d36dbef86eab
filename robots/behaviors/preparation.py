"""Before a plan is made: whether the object is held, and where it is."""

from robots.arm import Arm, Routine
from robots.behaviors.assignment import Assignment, Findings
from robots.behaviors.errand import errand_of
from robots.behaviors.grasp_choice import ways_to_grasp
from robots.catalogue import Part
from robots.senses import Senses

LOOKS = 3
"""So often a part that is not wholly seen is looked for before that is believed."""
LOOK_AGAIN_S = 0.1


def check_carrying(part: Part | None, arm: Arm, senses: Senses) -> Routine[bool]:
    """Whether the object is in the gripper now, by fresh forearm pictures."""
    if part is None or not senses.holds(part.name):
        return False
    for _ in range(LOOKS):
        senses.read_grip()
        yield from arm.wait(senses.forearm_period_s)
    return senses.holds(part.name)


def find(part: Part | None, arm: Arm, senses: Senses, findings: Findings) -> Routine[None]:
    """Look for the object, again if it, or the table, is not wholly seen.

    What something hides is taken to be where it was last seen whole: the fingers will tell.
    """
    for attempt in range(LOOKS):
        if attempt:
            yield from arm.wait(LOOK_AGAIN_S)
            if findings.sighting is None:
                senses.doubt()
        findings.image = senses.look()
        findings.blind = senses.why_blind(findings.image)
        if findings.blind is not None:
            continue
        if part is None:
            return
        findings.sighting = senses.sight(part, findings.image)
        if findings.sighting is not None and findings.sighting.complete:
            return
    unseen = part is not None and findings.sighting is None and findings.blind is None
    if part is not None and unseen and findings.image is not None:
        findings.sighting = senses.recall(part, findings.image)


def check_sight(arm: Arm, senses: Senses, findings: Findings) -> Routine[None]:
    """Whether the head camera shows the table past the arm; again while it does not."""
    for attempt in range(LOOKS):
        if attempt:
            yield from arm.wait(LOOK_AGAIN_S)
        findings.blind = senses.why_blind(senses.look())
        if findings.blind is None:
            return


def goes_on_carrying(assignment: Assignment, arm: Arm, senses: Senses) -> bool:
    """Whether the behavior has a step at which to go on with its object in the gripper."""
    errand = errand_of(assignment, senses, Findings(carrying=True))
    (situation, *_) = ways_to_grasp(errand, arm.body.gripper, senses.catalogue.table.height, ())
    steps = assignment.behavior.steps(assignment.parameters, situation)
    return assignment.behavior.first_carrying(steps) is not None
