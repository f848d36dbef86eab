"""A naive watch beside the robot's own, which looks at the same forearm pictures."""

from collections.abc import Callable

import numpy as np

from mend.robots.arm.body import ArmBody
from mend.robots.arm.grip import GripReading, GripState
from mend.robots.arm.grip.watch import GripWatch
from mend.robots.arm.perception import Perception
from mend.robots.catalogue import Catalogue
from mend.robots.vision.color_model import ColorModel


class PlainWatch:
    """The naive way: the blob's centre stays within a fixed range of the image."""

    RANGE_PX = 8.0

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        self._center: np.ndarray | None = None
        self._outside = 0
        self.alarm_s: float | None = None

    def update(self, reading: GripReading) -> None:
        if reading.state is GripState.UNDECIDED:
            return
        seen = None if reading.blob is None else np.array(reading.blob.center)
        if self._center is None:
            self._center = seen
        inside = (
            seen is not None
            and self._center is not None
            and bool(np.abs(seen - self._center).max() <= self.RANGE_PX)
        )
        self._outside = 0 if inside else self._outside + 1
        if self._outside >= 2 and self.alarm_s is None:
            self.alarm_s = reading.image.time


class SharedSenses(Perception):
    """The robot's perception, whose forearm pictures the plain watch sees too.

    `on_reading` is told every reading of the hand.
    """

    plain: PlainWatch

    def __init__(self, body: ArmBody, model: ColorModel, catalogue: Catalogue) -> None:
        super().__init__(body, model, catalogue)
        self.on_reading: Callable[[GripReading], None] | None = None

    def read_grip(self) -> GripReading | None:
        reading = super().read_grip()
        if reading is not None:
            self.plain.update(reading)
            self._tell(reading)
        return reading

    def measure_grip(self, watch: GripWatch) -> GripReading:
        reading = super().measure_grip(watch)
        self._tell(reading)
        return reading

    def _tell(self, reading: GripReading) -> None:
        if self.on_reading is not None:
            self.on_reading(reading)
