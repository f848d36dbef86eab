"""`slipping`: the object drifts between the fingers, but is still where `dropped` lets it be."""

from typing import ClassVar

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from robots.link.messages import Detection
from robots.monitors import Meanwhile, Monitor, MonitorView
from robots.vision.forearm import GripReading, GripState
from tasks.scene import StrictModel


class SlippingParameters(StrictModel):
    """A drift of `limit_share` of the window's half width in `pictures` on end is slipping."""

    limit_share: float = Field(default=0.5, gt=0.0, lt=1.0)
    pictures: int = Field(default=3, ge=1)


class Slipping(Monitor[SlippingParameters]):
    """Raises `slipping` in steps 5 and 6; the robot goes on slowly."""

    issue: ClassVar[str] = "slipping"
    start_step: ClassVar[int] = 5
    stop_step: ClassVar[int] = 6
    meanwhile: ClassVar[Meanwhile] = Meanwhile.SLOW_DOWN
    camera: ClassVar[str | None] = "forearm"
    parameters: ClassVar[type[StrictModel]] = SlippingParameters

    def __init__(self, settings: SlippingParameters) -> None:
        super().__init__(settings)
        self._first: NDArray[np.float64] | None = None
        self._drifted = 0

    def check(self, view: MonitorView) -> Detection | None:
        grip = view.grip
        if grip is None or grip.state is not GripState.HELD or grip.blob is None:
            return None
        drift_px = self._drift_px(grip)
        limit_px = self.settings.limit_share * grip.tolerance_px
        self._drifted = self._drifted + 1 if drift_px > limit_px else 0
        if self._drifted < self.settings.pictures:
            return None
        return Detection(
            camera="forearm",
            center=grip.blob.center,
            expected=grip.expected,
            tolerance_px=grip.tolerance_px,
            area_px=grip.blob.area_px,
            explanation=f"{grip.name} has slipped by {drift_px:.1f} pixels between the fingers",
        )

    def _drift_px(self, grip: GripReading) -> float:
        """How far the object is from where it was between the fingers at first."""
        if grip.blob is None:
            return 0.0
        offset = np.array(grip.blob.center) - np.array(grip.expected)
        if self._first is None:
            self._first = offset
        return float(np.linalg.norm(offset - self._first))
