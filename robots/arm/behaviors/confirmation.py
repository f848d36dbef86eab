"""After the last step: whether the object is seen where the behavior was to bring it."""

from itertools import count

from mend.robots.arm.arm import Arm
from mend.robots.arm.behaviors.findings import Outcome
from mend.robots.arm.behaviors.search import LOOK_AGAIN_S, LOOKS
from mend.robots.arm.perception import Perception
from mend.robots.catalogue import Part
from mend.robots.execution.routine import Routine
from mend.robots.link.messages import Location
from mend.robots.vision.behind_others import BehindOthers
from mend.robots.vision.presence import Presence


def look_at_outcome(
    part: Part, target: Location, arm: Arm, perception: Perception
) -> Routine[Outcome]:
    """Leave the head camera's view and look, again while the part is not seen at its place.

    Where robots that pass hide that, until they have passed.
    """
    yield from arm.go_to_neutral()
    behind = BehindOthers()
    for look in count(1):
        outcome = _look(part, target, perception)
        passing = perception.head.others_pass(behind, outcome.image, (part, target))
        waits = outcome.presence is Presence.HIDDEN and passing
        if outcome.presence is Presence.THERE or (look >= LOOKS and not waits):
            break
        yield from arm.wait(LOOK_AGAIN_S)
        perception.head.doubt()
    return outcome


def _look(part: Part, target: Location, perception: Perception) -> Outcome:
    image = perception.head.look()
    blind = perception.head.why_blind(image, (part, target))
    if blind is not None:
        return Outcome(image, None, Presence.HIDDEN, blind)
    return Outcome(
        image, perception.head.sight(part, image), perception.head.presence(image, part, target)
    )
