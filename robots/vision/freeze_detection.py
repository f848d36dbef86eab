"""Telling a camera that freezes: it gives an old picture under new time stamps."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mend.robots.body import CameraImage
from mend.robots.vision.projection import Points, in_optical_frame, is_measured, project
from mend.robots.vision.scene_change import is_same

_SPARSE = 4
"""Noise is looked for in each fourth row and column."""
_NOISY_SHARE = 0.9
"""Noise changes nearly every pixel otherwise than its neighbour; what moves fills less."""
_FEWEST_PAIRS = 100
_MOVED_M = 0.05
_HIDDEN_M = 0.02
"""What is so much nearer than the fingers hides them."""


@dataclass(frozen=True, slots=True, eq=False)
class _Taken:
    """A picture, and where the robot's fingers were then: points (n, 3) in the base frame."""

    image: CameraImage
    fingers: Points

    def may_show_fingers(self) -> bool:
        """Whether nothing that is measured hides where most of the fingers are in the picture."""
        depth_m = self.image.depth_m
        if depth_m is None or not len(self.fingers):
            return False
        away_m = in_optical_frame(self.image, self.fingers)[:, 2]
        columns, rows = np.rint(project(self.image, self.fingers)).astype(np.intp).T
        height, width = depth_m.shape
        inside = (away_m > 0.0) & (rows >= 0) & (rows < height) & (columns >= 0) & (columns < width)
        seen_m = depth_m[rows[inside], columns[inside]]
        free = is_measured(seen_m) & (seen_m > away_m[inside] - _HIDDEN_M)
        return bool(2 * np.count_nonzero(free) > len(self.fingers))


class FreezeDetector:
    """Follows the pictures of a camera that stands still, each once, as they are taken.

    No picture of a camera with noise comes twice. One without any may well give the same again,
    unless the fingers have moved in its view.
    """

    def __init__(self) -> None:
        self.frozen = False
        """Whether the newest picture shows what was before, whatever time it says."""
        self._last: _Taken | None = None
        self._noisy_color = self._noisy_depth = False

    @property
    def knows_noise(self) -> bool:
        """Whether pictures tell by their noise alone that they are new."""
        return self._noisy_color or self._noisy_depth

    def note(self, image: CameraImage, fingers: Points) -> None:
        """A picture was taken while the fingers were at these points (n, 3) of the base frame."""
        last, now = self._last, _Taken(image, fingers)
        if last is not None and image.time <= last.image.time:
            return
        self._last = now
        self.frozen = last is not None and self._repeats(last, now)
        if last is not None and not self.frozen:
            self._learn_noise(last.image, image)

    def _repeats(self, last: _Taken, now: _Taken) -> bool:
        before, after = last.image, now.image
        if self._noisy_depth and _equal(before.depth_m, after.depth_m):
            return True
        if self._noisy_color and _equal(before.bgr, after.bgr):
            return True
        if not is_same(before, after):
            return False
        if _are_apart(last.fingers, now.fingers):
            return self.frozen or last.may_show_fingers() or now.may_show_fingers()
        return self.frozen

    def _learn_noise(self, before: CameraImage, after: CameraImage) -> None:
        if not np.array_equal(before.pose, after.pose):
            return
        self._noisy_color |= _differ_as_noise_does(before.bgr, after.bgr)
        if before.depth_m is not None and after.depth_m is not None:
            self._noisy_depth |= _differ_as_noise_does(
                before.depth_m[..., None], after.depth_m[..., None]
            )


def _equal(before: NDArray[Any] | None, after: NDArray[Any] | None) -> bool:
    if before is None or after is None:
        return False
    floats = np.issubdtype(before.dtype, np.floating)
    return bool(np.array_equal(before, after, equal_nan=floats))


def _are_apart(one: Points, other: Points) -> bool:
    """Whether the fingers are elsewhere in the meantime."""
    if not len(one) or not len(other):
        return False
    return float(np.linalg.norm(one.mean(axis=0) - other.mean(axis=0))) > _MOVED_M


def _differ_as_noise_does(before: NDArray[Any], after: NDArray[Any]) -> bool:
    """Whether nearly every pixel (h, w, channels) has changed otherwise than its neighbour.

    Light changes surfaces as a whole, and what moves some of the picture.
    """
    if before.shape != after.shape or before.shape[1] < 2:
        return False
    width = before.shape[1] // 2 * 2
    pairs = [
        each[::_SPARSE, start:width:_SPARSE].astype(np.float64)
        for start in (0, 1)
        for each in (before, after)
    ]
    first, second = (pairs[at + 1] - pairs[at] for at in (0, 2))
    columns = min(first.shape[1], second.shape[1])
    off = first[:, :columns] - second[:, :columns]
    measured = np.isfinite(off).all(axis=2)
    if np.count_nonzero(measured) < _FEWEST_PAIRS:
        return False
    return float((off[measured] != 0.0).any(axis=1).mean()) > _NOISY_SHARE
