"""What a camera sees of the top of a box past other boxes."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mend.robots.vision.seen_box import SeenBox

_ACROSS = 12
"""So many points along each side of the top are looked at."""


@dataclass(frozen=True, slots=True)
class Visibility:
    """The share of a box's top that is seen, and what hides most of it."""

    share: float
    hider: SeenBox | None


def sight_of(eye: NDArray[np.float64], box: SeenBox, others: Sequence[SeenBox]) -> Visibility:
    """What is seen of a box's top from `eye` (3, base frame) past other boxes."""
    points = _top(box)
    hidden = [_is_beyond(eye, points, other) for other in others]
    if not hidden:
        return Visibility(1.0, None)
    shares = [float(each.mean()) for each in hidden]
    most = int(np.argmax(shares))
    share = 1.0 - float(np.any(hidden, axis=0).mean())
    return Visibility(share, others[most] if shares[most] > 0.0 else None)


def _top(box: SeenBox) -> NDArray[np.float64]:
    """Points (n, 3) of its top face."""
    along = (np.arange(_ACROSS) + 0.5) / _ACROSS - 0.5
    local = np.stack(np.meshgrid(along * box.size[0], along * box.size[1]), axis=-1).reshape(-1, 2)
    points = np.full((len(local), 3), box.top_z)
    points[:, :2] = local @ _turn(box)[:2, :2].T + (box.x, box.y)
    return points


def _is_beyond(
    eye: NDArray[np.float64], points: NDArray[np.float64], box: SeenBox
) -> NDArray[np.bool_]:
    """Whether the straight way from `eye` to each point leads through a box (by its slabs)."""
    half, turn = np.array(box.size) / 2, _turn(box)
    middle = np.array([box.x, box.y, box.bottom_z + half[2]])
    start = (eye - middle) @ turn
    way = (points - middle) @ turn - start
    way = np.where(way == 0.0, np.finfo(np.float64).tiny, way)
    sides = np.stack([(-half - start) / way, (half - start) / way])
    enters, leaves = sides.min(axis=0).max(axis=1), sides.max(axis=0).min(axis=1)
    return np.asarray((enters < leaves) & (leaves > 0.0) & (enters < 1.0))


def _turn(box: SeenBox) -> NDArray[np.float64]:
    cos, sin = np.cos(box.yaw), np.sin(box.yaw)
    return np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
