"""After the last step: whether the object is seen where the behavior was to bring it."""

import math
from dataclasses import dataclass

from robots.arm import Arm, Routine
from robots.behaviors.preparation import LOOK_AGAIN_S, LOOKS
from robots.body import CameraImage
from robots.catalogue import Part
from robots.link.messages import Location
from robots.senses import Senses
from robots.vision.head import HeadSighting
from robots.vision.presence import AT_PLACE_M, Presence

_EXACT_M = 0.006
"""The arm places a part less than 3 mm off, and the camera sees it less than 2 mm off."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """What the head camera showed once the arm was out of its view."""

    image: CameraImage
    sighting: HeadSighting | None
    presence: Presence
    blind: str | None = None
    """Why the picture shows nothing of the table."""

    def is_inexact(self, target: Location) -> bool:
        """Whether it is wholly seen at its place, but farther off than arm and camera err."""
        seen = self.sighting
        if self.presence is not Presence.THERE or seen is None or not seen.complete:
            return False
        off_m = math.hypot(seen.x - target.x, seen.y - target.y)
        return _EXACT_M < off_m <= AT_PLACE_M


def look_at_outcome(part: Part, target: Location, arm: Arm, senses: Senses) -> Routine[Outcome]:
    """Leave the head camera's view and look, again while the part is not seen at its place."""
    yield from arm.go_to_neutral()
    outcome = _look(part, target, senses)
    for _ in range(LOOKS - 1):
        if outcome.presence is Presence.THERE:
            break
        yield from arm.wait(LOOK_AGAIN_S)
        senses.doubt()
        outcome = _look(part, target, senses)
    return outcome


def _look(part: Part, target: Location, senses: Senses) -> Outcome:
    image = senses.look()
    blind = senses.why_blind(image)
    if blind is not None:
        return Outcome(image, None, Presence.HIDDEN, blind)
    return Outcome(image, senses.sight(part, image), senses.presence(image, part, target))
