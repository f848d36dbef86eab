"""The expectation that an execution that waits can go on."""

from mend.robots.arm.behaviors.contact import hindering_n
from mend.robots.arm.body import ToolPose
from mend.robots.arm.looks.looker import Looker
from mend.robots.arm.looks.shown import detection_of
from mend.robots.body import CameraImage
from mend.robots.link.messages import Detection

_CLEAR_FORCE_N = 20.0
"""What holds an arm up at its first try pushes harder; its own load and noise make at most 8 N."""


class WayClear:
    """Nothing hinders the arm or is where it has to go, object and place are free."""

    def __init__(self, looker: Looker) -> None:
        self._looker = looker

    def is_fulfilled(self) -> bool:
        arm, held = self._looker.arm, self._looker.held
        way, here = [] if held is None else held.way, arm.tool_pose()
        if self._pressed_n(here, way) > _CLEAR_FORCE_N:
            return False
        if here is not None and not arm.at_rest:
            way = [here, *way]
        image = self._looker.look_at_table()
        return image is not None and self._is_seen_clear(image, way)

    def detection(self, image: CameraImage) -> Detection:
        return detection_of(self._looker.perception, image, None, None, None)

    def _pressed_n(self, here: ToolPose | None, way: list[ToolPose]) -> float:
        """How hard something pushes against going on."""
        body = self._looker.arm.body
        pressed_n = body.contact_force_n()
        if here is not None and way:
            pressed_n = hindering_n(body.contact_force(), here, way[0])
        return pressed_n

    def _is_seen_clear(self, image: CameraImage, way: list[ToolPose]) -> bool:
        perception, held = self._looker.perception, self._looker.held
        before = None if held is None else held.obstruction
        part, target = (None if held is None else held.destination) or (None, None)
        if before is not None and perception.head.shows_anything(image, before.position, but=part):
            return False
        if perception.head.obstruction(image, way, part) is not None:
            return False
        if part is None:
            return True
        sighting = None if perception.hand.holds(part.name) else perception.head.sight(part, image)
        return perception.head.occupant(image, part, sighting, target) is None
