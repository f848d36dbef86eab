"""`unreachable`: the object is seen, but not where the arm can grasp it."""

import math
from typing import ClassVar

from pydantic import Field

from mend.documents.strict_model import StrictModel
from mend.robots.arm.monitors.monitor import ArmMonitor, ArmView
from mend.robots.execution.monitor import ANY_BEHAVIOR, Reaction
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import Detection
from mend.robots.vision.head import HeadSighting


class UnreachableParameters(StrictModel):
    """`margin_m`, if any, is kept from both ends of the graspable range, whatever was planned."""

    margin_m: float = Field(default=0.0, ge=0.0, le=0.5)


class Unreachable(ArmMonitor[UnreachableParameters]):
    """Raises `unreachable` before step 1 of any behavior."""

    issue: ClassVar[str] = "unreachable"
    behaviors: ClassVar[frozenset[str]] = ANY_BEHAVIOR
    phases: ClassVar[frozenset[Phase]] = frozenset({Phase.PREPARE})
    reaction: ClassVar[Reaction] = Reaction.STOP_IN_PLACE
    camera: ClassVar[str | None] = "head"
    parameters: ClassVar[type[StrictModel]] = UnreachableParameters

    def check(self, view: ArmView) -> Detection | None:
        reason = self._reason(view)
        if reason is None:
            return None
        blob = None if view.sighting is None else view.sighting.blob
        return Detection(
            camera="head",
            center=None if blob is None else blob.center,
            area_px=0 if blob is None else blob.area_px,
            explanation=reason,
        )

    def _reason(self, view: ArmView) -> str | None:
        name = "the place" if view.part is None else view.part.name
        margin_m = self.settings.margin_m
        # What stands in the way can be cleared, and is told as that.
        refusal = view.refusal if view.obstruction is None else None
        if view.sighting is None:
            return refusal
        if refusal is not None or margin_m > 0.0:
            return why_beyond_reach(name, view.sighting, view, margin_m) or refusal
        return why_lying(name, view.sighting)


def why_beyond_reach(
    name: str, sighting: HeadSighting, view: ArmView, margin_m: float = 0.0
) -> str | None:
    """Why the arm can hardly grasp what is seen there, as far as distance and posture tell.

    Only a plan can tell for sure.
    """
    origin = view.reach.origin
    distance = math.hypot(sighting.x - origin[0], sighting.y - origin[1])
    low, high = view.reach.min_m + margin_m, view.reach.max_m - margin_m
    if not low <= distance <= high:
        return f"{name} is {distance:.2f} m away; the arm grasps {low:.2f} to {high:.2f} m"
    return why_lying(name, sighting)


def why_lying(name: str, sighting: HeadSighting) -> str | None:
    """Why the arm cannot grasp what is seen there as it lies."""
    if sighting.toppled:
        return f"{name} has toppled over; the arm grasps it standing only"
    return None
