"""The forearm camera: whether the carried object is where it must be between the fingers."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

import cv2
import numpy as np
from numpy.typing import NDArray

from robots.body import CameraImage, Matrix4
from robots.catalogue import Part
from robots.grasp import Grasp, corners_in_tool
from robots.vision.blob import Blob, Mask, find_blob
from robots.vision.color_model import ColorModel
from robots.vision.projection import project

_REFERENCE_WIDTH_PX = 160
"""Tolerances in pixels are for a picture this wide and grow with it."""
_LONGEST_DOUBT = 6
"""After so many pictures that contradict each other the newest one decides."""


class GripState(StrEnum):
    """What the forearm pictures since the gripper closed say."""

    UNDECIDED = "undecided"
    HELD = "held"
    ABSENT = "absent"
    """The object never was where it must be."""
    LOST = "lost"
    """It was, and is not any more."""


_NEXT = {
    GripState.UNDECIDED: {GripState.HELD, GripState.ABSENT},
    GripState.HELD: {GripState.LOST},
    GripState.ABSENT: set[GripState](),
    GripState.LOST: set[GripState](),
}


class GripTransitionError(Exception):
    """A grip changed in a way that cannot be; the message says from what to what."""


@dataclass(frozen=True, slots=True)
class GripTolerances:
    """How far a blob may be from where it must be. Pixels are for a picture 160 pixels wide.

    Before a grasp is confirmed, the expected place comes from the part's size alone
    (`first_px`); afterwards it includes what was learned of this very grasp (`held_px`). A blob
    also is in place if no more than `stray_share` of it is farther than `outline_px` outside the
    part's expected outline: something in front of a part moves the centre of what is left of it,
    but never out of its outline. The blob's area must be at least `first_share` of the outline's,
    later `held_share` of what it was at first, and never more than `most_share` of the outline's.
    A verdict takes `frames` pictures in a row, fewer where that would take longer than
    `confirm_s`.
    """

    first_px: float = 14.0
    held_px: float = 5.0
    outline_px: float = 4.0
    stray_share: float = 0.2
    first_share: float = 0.12
    held_share: float = 0.4
    most_share: float = 1.8
    open_share: float = 0.5
    """The fingers hold something if they are at least this share of its width apart."""
    frames: int = 2
    confirm_s: float = 0.07


@dataclass(frozen=True, slots=True, eq=False)
class GripReading:
    """One forearm picture's evidence, and the verdict with it.

    `expected` is where the blob's centre must be (pixels), `drift_px` how far off it is, scaled
    to a picture 160 pixels wide; None where there is no blob. `outline` and `outline_px` are centre
    and area of the part as it would be seen with nothing in front of it.
    """

    name: str
    state: GripState
    in_place: bool
    blob: Blob | None
    expected: tuple[float, float]
    tolerance_px: float
    drift_px: float | None
    outline: tuple[float, float]
    outline_px: float
    image: CameraImage


class GripWatch:
    """Follows one object between the fingers from picture to picture.

    The part's outline is projected into each picture from where the tool point is; the difference
    that the first good pictures show (fingers in front of the part, an uneven grasp) is learned
    and from then on expected.
    """

    def __init__(
        self,
        part: Part,
        grasp: Grasp,
        model: ColorModel,
        tolerances: GripTolerances | None = None,
        period_s: float = 1 / 30,
    ) -> None:
        self.part = part
        self._grasp = grasp
        self._model = model
        self._tolerances = tolerances or GripTolerances()
        self._corners = corners_in_tool(part, grasp)
        in_time = max(1, int(self._tolerances.confirm_s / period_s))
        self._needed = min(self._tolerances.frames, in_time)
        self._state = GripState.UNDECIDED
        self._in_row = 0
        self._row_in_place = True
        self._taken = 0
        self._offsets: list[NDArray[np.float64]] = []
        self._shares: list[float] = []

    @property
    def state(self) -> GripState:
        return self._state

    def update(self, image: CameraImage, tool: Matrix4, opening_m: float) -> GripReading:
        """Take a picture into account; `tool` and `opening_m` are those at its time."""
        reading = self.measure(image, tool, opening_m)
        if reading.in_place and self._state is GripState.UNDECIDED:
            self._learn(reading)
        self._count(reading.in_place)
        return replace(reading, state=self._state)

    def measure(self, image: CameraImage, tool: Matrix4, opening_m: float) -> GripReading:
        """Judge a picture by what is known, without learning from it or coming to a verdict."""
        scale = image.bgr.shape[1] / _REFERENCE_WIDTH_PX
        canvas = self._outline(image, tool)
        outline, outline_area = _moments(canvas, project(image, tool[None, :3, 3])[0])
        blob = find_blob(
            self._model.segment(image.bgr).mask(self.part.name),
            min_area_px=max(6, round(12 * scale * scale)),
            whole=True,
        )
        learned = self._state is not GripState.UNDECIDED and bool(self._offsets)
        offset = np.mean(self._offsets, axis=0) if learned else np.zeros(2)
        expected = outline + offset * scale
        tolerance = self._tolerances.held_px if learned else self._tolerances.first_px
        drift = None if blob is None else float(np.linalg.norm(blob.center - expected)) / scale
        in_place = (
            blob is not None
            and drift is not None
            and (drift <= tolerance or self._within_outline(blob, canvas, scale))
            and self._area_fits(blob.area_px / outline_area, learned)
            and opening_m >= self._tolerances.open_share * self._grasp.width_m
        )
        return GripReading(
            name=self.part.name,
            state=self._state,
            in_place=in_place,
            blob=blob,
            expected=(float(expected[0]), float(expected[1])),
            tolerance_px=tolerance * scale,
            drift_px=drift,
            outline=(float(outline[0]), float(outline[1])),
            outline_px=outline_area,
            image=image,
        )

    def _learn(self, reading: GripReading) -> None:
        if reading.blob is None:
            return
        scale = reading.image.bgr.shape[1] / _REFERENCE_WIDTH_PX
        self._offsets.append((np.array(reading.blob.center) - np.array(reading.outline)) / scale)
        self._shares.append(reading.blob.area_px / reading.outline_px)

    def _outline(self, image: CameraImage, tool: Matrix4) -> Mask:
        """Where the part would be seen with nothing in front of it."""
        canvas = np.zeros(image.bgr.shape[:2], np.uint8)
        for corners in self._corners:
            pixels = project(image, corners @ tool[:3, :3].T + tool[:3, 3])
            hull = cv2.convexHull(np.rint(pixels).astype(np.int32))
            cv2.fillConvexPoly(canvas, hull, 1)
        return canvas

    def _within_outline(self, blob: Blob, outline: Mask, scale: float) -> bool:
        reach = 2 * round(self._tolerances.outline_px * scale) + 1
        grown = np.asarray(cv2.dilate(outline, np.ones((reach, reach), np.uint8)))
        stray = np.count_nonzero(blob.mask[grown == 0])
        return bool(stray <= self._tolerances.stray_share * blob.area_px)

    def _area_fits(self, share: float, learned: bool) -> bool:
        least = self._tolerances.first_share
        if learned:
            least = self._tolerances.held_share * min(float(np.mean(self._shares)), 1.0)
        return least <= share <= self._tolerances.most_share

    def _count(self, in_place: bool) -> None:
        if in_place != self._row_in_place:
            self._in_row = 0
        self._row_in_place = in_place
        self._in_row += 1
        self._taken += 1
        if self._in_row < self._needed and self._taken < _LONGEST_DOUBT:
            return
        if self._state is GripState.UNDECIDED:
            self._move_to(GripState.HELD if in_place else GripState.ABSENT)
        elif self._state is GripState.HELD and not in_place and self._in_row >= self._needed:
            self._move_to(GripState.LOST)

    def _move_to(self, state: GripState) -> None:
        if state not in _NEXT[self._state]:
            expected = " or ".join(sorted(_NEXT[self._state])) or "nothing more"
            raise GripTransitionError(
                f"a grip that is {self._state} can become {expected}, not {state}"
            )
        self._state = state


def _moments(canvas: Mask, fallback: NDArray[np.float64]) -> tuple[NDArray[np.float64], float]:
    found = cv2.moments(canvas, binaryImage=True)
    if found["m00"] < 1:
        return fallback, 1.0
    center = np.array([found["m10"] / found["m00"], found["m01"] / found["m00"]])
    return center, float(found["m00"])


def steady(readings: Sequence[GripReading], spread_px: float) -> bool:
    """Whether an object stays where it must be in all readings, within `spread_px` pixels."""
    centers = [each.blob.center for each in readings if each.in_place and each.blob is not None]
    if len(centers) < len(readings):
        return False
    spread = np.ptp(np.array(centers), axis=0)
    return bool(spread.max() <= spread_px)
