"""`undone`: what was placed is not at its place, or no longer."""

import math
from typing import ClassVar

from pydantic import Field

from mend.documents.strict_model import StrictModel
from mend.robots.arm.monitors.monitor import ArmMonitor, ArmView
from mend.robots.arm.monitors.unreachable import why_beyond_reach, why_lying
from mend.robots.execution.monitor import ANY_BEHAVIOR, Reaction
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import Detection
from mend.robots.vision.head import HeadSighting
from mend.robots.vision.presence import AT_PLACE_HEIGHT_M, AT_PLACE_M, Presence, is_at, turned_rad

_MM = 1e3


class UndoneParameters(StrictModel):
    """So often (`again`) it places at once again what it has just placed in vain."""

    again: int = Field(default=1, ge=0, le=10)


class Undone(ArmMonitor[UndoneParameters]):
    """Raises `undone` before step 1 of what was done before, and after the last step.

    Where it sees the object stand in reach the robot goes on by itself; else somebody has to help.
    """

    issue: ClassVar[str] = "undone"
    behaviors: ClassVar[frozenset[str]] = ANY_BEHAVIOR
    phases: ClassVar[frozenset[Phase]] = frozenset({Phase.PREPARE, Phase.CONFIRM})
    reaction: ClassVar[Reaction] = Reaction.STOP_IN_PLACE
    camera: ClassVar[str | None] = "head"
    parameters: ClassVar[type[StrictModel]] = UndoneParameters

    def __init__(self, settings: UndoneParameters) -> None:
        super().__init__(settings)
        self._again = settings.again
        self._goes_on = False
        self._asked = False

    @property
    def interrupts(self) -> bool:
        """Whether the robot cannot place it again by itself."""
        return not self._goes_on

    def check(self, view: ArmView) -> Detection | None:
        if view.part is None:
            return None
        if view.phase is Phase.CONFIRM:
            return self._after_the_last_step(view.part.name, view)
        if view.was_done is None or view.grip is not None:
            return None
        return self._before_the_first_step(view.part.name, view)

    def _before_the_first_step(self, name: str, view: ArmView) -> Detection | None:
        if view.sighting is not None and (
            view.refusal is not None or why_lying(name, view.sighting) is not None
        ):
            # Where it is now is what people have to hear of: `unreachable` tells them.
            return None
        if view.sighting is not None and (self._asked or _is_at_place(view.sighting, view)):
            return None
        self._goes_on = _stands_on_the_table(view.sighting, view)
        self._asked = True
        return _detection(f"{name} is no longer at its place", view.sighting, view)

    def _after_the_last_step(self, name: str, view: ArmView) -> Detection | None:
        if view.presence is not Presence.GONE:
            return None
        graspable = view.placed is not None and why_beyond_reach(name, view.placed, view) is None
        free = graspable and _stands_on_the_table(view.placed, view)
        self._goes_on = free and self._again > 0
        self._again -= 1
        return _detection(f"{name} was placed, but is not at its place", view.placed, view)


def _stands_on_the_table(sighting: HeadSighting | None, view: ArmView) -> bool:
    """Whether it stands free: what hangs on others may hide that one of them is gone."""
    return sighting is not None and abs(sighting.z - view.table_z) <= AT_PLACE_HEIGHT_M


def _target_z(view: ArmView) -> float:
    """How high (m) the bottom of the object is at its place."""
    target_z = None if view.target is None else view.target.z
    return view.table_z if target_z is None else target_z


def _is_at_place(sighting: HeadSighting, view: ArmView) -> bool:
    part, target = view.part, view.target
    if part is None or target is None:
        return False
    return is_at(sighting, part, target, _target_z(view))


def _detection(what: str, sighting: HeadSighting | None, view: ArmView) -> Detection:
    if sighting is None:
        return Detection(camera="head", explanation=f"{what} and nowhere in the head picture")
    return Detection(
        camera="head",
        center=sighting.blob.center,
        area_px=sighting.blob.area_px,
        explanation=f"{what}{_what_differs(sighting, view)}",
    )


def _what_differs(sighting: HeadSighting, view: ArmView) -> str:
    """In what it is seen to be otherwise than at its place, as the end of a clause."""
    at = f"at ({sighting.x:.2f}, {sighting.y:.2f})"
    if sighting.toppled:
        return f": it has toppled over, {at}"
    if view.target is None:
        return f": it is {at}"
    off_m = math.hypot(sighting.x - view.target.x, sighting.y - view.target.y)
    if off_m > AT_PLACE_M:
        return f": it is {off_m * _MM:.0f} mm away from it, {at}"
    above_m = sighting.z - _target_z(view)
    if abs(above_m) > AT_PLACE_HEIGHT_M:
        side = "high" if above_m > 0 else "low"
        return f": it stands {abs(above_m) * _MM:.0f} mm too {side} there"
    if view.part is None or _is_at_place(sighting, view):
        return ""
    turned = math.degrees(turned_rad(sighting, view.part, view.target))
    return f": it is turned by {turned:.0f} degrees there"
