"""What `missed` and `dropped` share: the fingers do not hold the object."""

from typing import ClassVar

from mend.documents.strict_model import StrictModel
from mend.robots.arm.grip import GripState
from mend.robots.arm.monitors.monitor import ArmMonitor, ArmView
from mend.robots.execution.monitor import NoParameters, Reaction
from mend.robots.link.messages import Detection


class GripMonitor(ArmMonitor[NoParameters]):
    """Raises its issue once opening, effort and picture together say that the grip is `state`."""

    state: ClassVar[GripState]
    reaction: ClassVar[Reaction] = Reaction.GO_TO_NEUTRAL
    camera: ClassVar[str | None] = "forearm"
    parameters: ClassVar[type[StrictModel]] = NoParameters

    def check(self, view: ArmView) -> Detection | None:
        grip = view.grip
        if grip is None or grip.state is not self.state:
            return None
        sure = 1.0 - grip.probability
        return Detection(
            camera="forearm",
            center=None if grip.blob is None else grip.blob.center,
            expected=grip.expected,
            tolerance_px=grip.tolerance_px,
            area_px=0 if grip.blob is None else grip.blob.area_px,
            probability=sure,
            explanation=f"{grip.reason} ({_percent(sure)} % sure)",
            measured={"opening_m": grip.opening_m, "width_m": grip.width_m},
        )


def _percent(probability: float) -> int:
    """Never 100: nothing is quite sure."""
    return min(99, round(100 * probability))
