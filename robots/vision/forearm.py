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

    A blob is in place if no more than `stray_share` of it lies farther than `overhang_px` outside
    the part's expected outline. (What is in front of a part moves the centre of the rest of it,
    but never out of its outline.) Before a grasp is confirmed its centre may also be just within
    `first_px` of the outline's: the grasp is uneven then, and the outline is moved by that much
    from there on. The blob's area must be at least `first_share` of the outline's, later
    `held_share` of what it was at first, and never more than `most_share` of the outline's. A
    verdict takes `frames` pictures in a row, fewer where that would take longer than `confirm_s`.
    """

    overhang_px: float = 3.0
    stray_share: float = 0.1
    first_px: float = 14.0
    first_share: float = 0.12
    held_share: float = 0.4
    most_share: float = 1.8
    open_share: float = 0.5
    """The fingers hold something if they are at least this share of its width apart."""
    spread_m: float = 0.008
    """They have let go if they are so much farther apart than when the grasp was confirmed."""
    frames: int = 2
    confirm_s: float = 0.07


@dataclass(frozen=True, slots=True, eq=False)
class GripReading:
    """One forearm picture's evidence, and the verdict with it.

    `expected` is the centre of the outline in which the blob must be (pixels), `tolerance_px` how
    far it may hang over it. `overhang_px` says how far it does, for a picture 160 pixels wide;
    None where there is no blob. `offset` is from the centre of the part's outline, as its size
    gives it, to the blob's, in pixels of such a picture; `share` is the visible part of its area.
    """

    name: str
    state: GripState
    in_place: bool
    blob: Blob | None
    expected: tuple[float, float]
    tolerance_px: float
    overhang_px: float | None
    offset: tuple[float, float]
    share: float
    image: CameraImage


class GripWatch:
    """Follows one object between the fingers from picture to picture.

    The part's outline is projected into each picture from where the tool point is. How much of it
    the first good pictures show, and how uneven the grasp is, is learned and then expected.
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
        self.grasp = grasp
        self._model = model
        self._tolerances = tolerances or GripTolerances()
        self._corners = corners_in_tool(part, grasp)
        in_time = max(1, int(self._tolerances.confirm_s / period_s))
        self._needed = min(self._tolerances.frames, in_time)
        self._state = GripState.UNDECIDED
        self._in_row = 0
        self._row_in_place = True
        self._taken = 0
        self._shift = np.zeros(2)
        self._shares: list[float] = []
        self._opening_m: float | None = None

    @property
    def state(self) -> GripState:
        return self._state

    @property
    def in_doubt(self) -> bool:
        """Whether the next picture may change the verdict."""
        wavering = self._state is GripState.HELD and not self._row_in_place
        return self._state is GripState.UNDECIDED or wavering

    def update(self, image: CameraImage, tool: Matrix4, opening_m: float) -> GripReading:
        """Take a picture into account; `tool` and `opening_m` are those at its time."""
        reading = self.measure(image, tool, opening_m)
        if reading.in_place and self._state is GripState.UNDECIDED:
            self._learn(reading, opening_m)
        self._count(reading.in_place)
        return replace(reading, state=self._state)

    def measure(self, image: CameraImage, tool: Matrix4, opening_m: float) -> GripReading:
        """Judge a picture by what is known, without learning from it or coming to a verdict."""
        scale = image.bgr.shape[1] / _REFERENCE_WIDTH_PX
        outline = self._outline(image, tool, self._shift * scale)
        center, area_px = _moments(outline, project(image, tool[None, :3, 3])[0])
        blob = find_blob(
            self._model.segment(image.bgr).mask(self.part.name),
            min_area_px=max(6, round(12 * scale * scale)),
            whole=True,
        )
        seen = center if blob is None else np.array(blob.center)
        overhang_px = None if blob is None else self._overhang_px(blob, outline) / scale
        offset = (seen - center) / scale + self._shift
        share = 0.0 if blob is None else blob.area_px / area_px
        in_place = (
            overhang_px is not None
            and self._is_near(overhang_px, offset)
            and self._area_fits(share)
            and self._fingers_fit(opening_m)
        )
        return GripReading(
            name=self.part.name,
            state=self._state,
            in_place=in_place,
            blob=blob,
            expected=(float(center[0]), float(center[1])),
            tolerance_px=self._tolerances.overhang_px * scale,
            overhang_px=overhang_px,
            offset=(float(offset[0]), float(offset[1])),
            share=share,
            image=image,
        )

    def _learn(self, reading: GripReading, opening_m: float) -> None:
        self._shares.append(reading.share)
        self._opening_m = opening_m
        if reading.overhang_px is None or reading.overhang_px > self._tolerances.overhang_px:
            self._shift = np.array(reading.offset)

    def _outline(self, image: CameraImage, tool: Matrix4, shift_px: NDArray[np.float64]) -> Mask:
        """Where the part would be seen with nothing in front of it."""
        canvas = np.zeros(image.bgr.shape[:2], np.uint8)
        for corners in self._corners:
            pixels = project(image, corners @ tool[:3, :3].T + tool[:3, 3]) + shift_px
            hull = cv2.convexHull(np.rint(pixels).astype(np.int32))
            cv2.fillConvexPoly(canvas, hull, 1)
        return canvas

    def _overhang_px(self, blob: Blob, outline: Mask) -> float:
        """How far the blob lies outside, but for the `stray_share` that is farthest out."""
        if not outline.any():
            return float("inf")
        outside = np.asarray(cv2.distanceTransform(1 - outline, cv2.DIST_L2, 3))
        return float(np.quantile(outside[blob.mask > 0], 1.0 - self._tolerances.stray_share))

    def _is_near(self, overhang_px: float, offset: NDArray[np.float64]) -> bool:
        if overhang_px <= self._tolerances.overhang_px:
            return True
        first = self._state is GripState.UNDECIDED
        return first and float(np.linalg.norm(offset)) <= self._tolerances.first_px

    def _area_fits(self, share: float) -> bool:
        least = self._tolerances.first_share
        if self._shares:
            least = max(least, self._tolerances.held_share * min(float(np.mean(self._shares)), 1.0))
        return least <= share <= self._tolerances.most_share

    def _fingers_fit(self, opening_m: float) -> bool:
        if opening_m < self._tolerances.open_share * self.grasp.width_m:
            return False
        return self._opening_m is None or opening_m <= self._opening_m + self._tolerances.spread_m

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
