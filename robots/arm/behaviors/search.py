"""Before a plan is made: whether the object is held, and where it is."""

from itertools import count

from mend.robots.arm.behaviors.work import Work
from mend.robots.catalogue import Part
from mend.robots.execution.routine import Routine
from mend.robots.vision.behind_others import BehindOthers

LOOKS = 3
"""So often a part that is not wholly seen is looked for before that is believed."""
LOOK_AGAIN_S = 0.1


def feel_for_object(work: Work) -> Routine[bool]:
    """Whether the object is in the gripper now, by fresh forearm pictures."""
    part, perception = work.assignment.part, work.perception
    if part is None or not perception.hand.holds(part.name):
        return False
    for _ in range(LOOKS):
        perception.read_grip()
        yield from work.arm.wait(perception.hand.period_s)
    return perception.hand.holds(part.name)


def find_object(work: Work) -> Routine[None]:
    """Look for the object, again if it, or the table, is not wholly seen.

    What robots hide that pass is waited for. What something hides for longer is taken to be where
    it was last seen: the fingers will tell.
    """
    part, perception, findings = work.assignment.part, work.perception, work.progress.seen
    behind = BehindOthers()
    for look in count(1):
        _look_for(part, work)
        if findings.blind is None and part is None:
            return
        if findings.sighting is not None and findings.sighting.complete:
            return
        passing = findings.image is not None and perception.head.others_pass(behind, findings.image)
        if look >= LOOKS and not passing:
            break
        yield from work.arm.wait(LOOK_AGAIN_S)
        if findings.sighting is None:
            perception.head.doubt()
    unseen = part is not None and findings.sighting is None and findings.blind is None
    if part is not None and unseen and findings.image is not None:
        findings.sighting = perception.head.recall(part, findings.image)


def _look_for(part: Part | None, work: Work) -> None:
    """One look at the table, and at where the object is on it."""
    head, findings = work.perception.head, work.progress.seen
    findings.image = head.look()
    findings.blind = head.why_blind(findings.image, work.unconfirmed)
    if findings.blind is None and part is not None:
        findings.sighting = head.sight(part, findings.image)


def find_table(work: Work) -> Routine[None]:
    """Whether the head camera shows the table past the arm; again while it does not."""
    findings, perception = work.progress.seen, work.perception
    for attempt in range(LOOKS):
        if attempt:
            yield from work.arm.wait(LOOK_AGAIN_S)
        findings.blind = perception.head.why_blind(perception.head.look())
        if findings.blind is None:
            return
