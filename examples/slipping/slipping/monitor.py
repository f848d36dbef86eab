"""`slipping`: the object drifts between the fingers, but not yet as far as `dropped` means."""

from typing import ClassVar

from pydantic import Field

from mend.documents.strict_model import StrictModel
from mend.robots.arm.grip import GripState
from mend.robots.arm.monitors import ArmMonitor, ArmView
from mend.robots.execution.monitor import Reaction
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import Detection


class SlippingParameters(StrictModel):
    """Hanging over by `limit_share` of what is tolerated, in `pictures` on end, is slipping."""

    limit_share: float = Field(default=0.5, gt=0.0, lt=1.0)
    pictures: int = Field(default=3, ge=1)


class Slipping(ArmMonitor[SlippingParameters]):
    """Raises `slipping` while it is carried and placed; the robot goes on slowly."""

    issue: ClassVar[str] = "slipping"
    behaviors: ClassVar[frozenset[str]] = frozenset({"pick_and_place"})
    phases: ClassVar[frozenset[Phase]] = frozenset({Phase.CARRY, Phase.PLACE})
    reaction: ClassVar[Reaction] = Reaction.SLOW_DOWN
    camera: ClassVar[str | None] = "forearm"
    parameters: ClassVar[type[StrictModel]] = SlippingParameters

    def __init__(self, settings: SlippingParameters) -> None:
        super().__init__(settings)
        self._drifted = 0

    def check(self, view: ArmView) -> Detection | None:
        grip = view.grip
        if grip is None or grip.state is not GripState.HELD or grip.overhang_px is None:
            return None
        scale = grip.image.bgr.shape[1] / 160
        drift_px = grip.overhang_px * scale
        drifts = drift_px > self.settings.limit_share * grip.tolerance_px
        self._drifted = self._drifted + 1 if drifts else 0
        if self._drifted < self.settings.pictures:
            return None
        return Detection(
            camera="forearm",
            center=None if grip.blob is None else grip.blob.center,
            expected=grip.expected,
            tolerance_px=grip.tolerance_px,
            area_px=0 if grip.blob is None else grip.blob.area_px,
            explanation=f"{grip.name} has slipped by {drift_px:.1f} pixels between the fingers",
        )
