"""Blobs: connected patches of one object's colours in a picture."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

Mask = NDArray[np.uint8]

_KERNEL = np.ones((3, 3), np.uint8)


@dataclass(frozen=True, slots=True, eq=False)
class Blob:
    """A patch of an object's colours: pixels (u, v), `box` as (left, top, width, height)."""

    center: tuple[float, float]
    area_px: int
    box: tuple[int, int, int, int]
    mask: Mask


def find_blob(mask: Mask, min_area_px: int = 20, whole: bool = False) -> Blob | None:
    """Clean a mask by opening and closing, and take its largest component.

    `whole` takes all components of `min_area_px` together: a finger in front of an object may cut
    its picture in two, and which half is larger changes from picture to picture.
    """
    left, top, width, height = cv2.boundingRect(mask)
    if width == 0:
        return None
    # Work on the patch that has colour at all; the margin keeps the closing as it would be.
    margin = 3
    left, top = max(left - margin, 0), max(top - margin, 0)
    patch = mask[top : top + height + 2 * margin, left : left + width + 2 * margin]
    clean = cv2.morphologyEx(patch, cv2.MORPH_OPEN, _KERNEL)
    clean = cv2.morphologyEx(clean, cv2.MORPH_CLOSE, _KERNEL, iterations=2)
    count, labels, stats, centers = cv2.connectedComponentsWithStats(clean)
    areas = stats[1:count, cv2.CC_STAT_AREA]
    if areas.size == 0 or areas.max() < min_area_px:
        return None
    chosen = 1 + (np.flatnonzero(areas >= min_area_px) if whole else np.array([areas.argmax()]))
    return _blob_of(
        mask.shape,
        (left, top),
        np.asarray(labels, np.int32),
        np.asarray(stats, np.int32),
        np.asarray(centers, np.float64),
        chosen,
    )


def _blob_of(
    shape: tuple[int, ...],
    origin: tuple[int, int],
    labels: NDArray[np.int32],
    stats: NDArray[np.int32],
    centers: NDArray[np.float64],
    chosen: NDArray[np.intp],
) -> Blob:
    left, top = origin
    areas = stats[chosen, cv2.CC_STAT_AREA]
    center = (centers[chosen] * areas[:, None]).sum(axis=0) / areas.sum()
    starts = stats[chosen][:, [cv2.CC_STAT_LEFT, cv2.CC_STAT_TOP]]
    ends = starts + stats[chosen][:, [cv2.CC_STAT_WIDTH, cv2.CC_STAT_HEIGHT]]
    corner, far = starts.min(axis=0), ends.max(axis=0)
    mask = np.zeros(shape, np.uint8)
    rows, columns = labels.shape
    is_chosen = np.zeros(len(stats), np.uint8)
    is_chosen[chosen] = 255
    mask[top : top + rows, left : left + columns] = is_chosen[labels]
    return Blob(
        center=(float(center[0] + left), float(center[1] + top)),
        area_px=int(areas.sum()),
        box=(
            int(corner[0] + left),
            int(corner[1] + top),
            int(far[0] - corner[0]),
            int(far[1] - corner[1]),
        ),
        mask=mask,
    )
