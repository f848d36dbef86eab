"""Whether a part is still where it was put, as far as a picture can tell."""

import math
from collections.abc import Set as AbstractSet
from enum import StrEnum

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.spatial.distance import cdist

from mend.robots.body import CameraImage
from mend.robots.catalogue import Part
from mend.robots.link.messages import Location
from mend.robots.vision.head import HeadSighting
from mend.robots.vision.height_map import HeightMap
from mend.robots.vision.level_rectangle import Rectangle
from mend.robots.vision.projection import is_measured, project
from mend.robots.vision.seen_box import SeenBox
from mend.robots.vision.table_view import TableView

Indices = NDArray[np.intp]

AT_PLACE_M = 0.02
"""A part is at its place if no corner of it is farther off,"""
AT_PLACE_HEIGHT_M = 0.015
AT_PLACE_RAD = math.radians(30)
"""and if it is not turned by more: corners of small parts are near each other's places."""
_TURN_SHOWS_M = 0.01
"""A tiny square part may seem turned that is not: no corner of it seems farther off."""
_SQUARE_M = 0.005
"""Of sides that differ by less the camera may take one for the other."""
_SAMPLES = 9
_SEEN_THROUGH = 0.6
"""A part is gone if more than this share of where its top would be lets the camera see behind."""
_LEAST_MEASURED = 0.5
"""Of less of that a picture tells nothing."""
_INNER = 0.8
"""The share of its top that is asked about: at the rim depth says little."""


class Presence(StrEnum):
    """What a picture says of a part at a place."""

    THERE = "there"
    """It is seen at its place."""
    GONE = "gone"
    """Its place is seen, and it is not there."""
    HIDDEN = "hidden"
    """Something in front of its place, or depth that is missing, keeps the camera from telling."""


def is_at(sighting: HeadSighting, part: Part, target: Location, target_z: float) -> bool:
    """Whether a part rests where it is to be, with its bottom at `target_z`."""
    near = is_near(sighting, part, target) and not sighting.toppled
    return near and abs(sighting.z - target_z) <= AT_PLACE_HEIGHT_M


def off_place_m(seen: HeadSighting | SeenBox, part: Part, target: Location) -> float:
    """How far a part is from its place from above: the Hausdorff distance of its corners.

    That of its middle where so little of it is seen that its direction may be wrong.
    """
    if not seen.complete:
        return math.hypot(seen.x - target.x, seen.y - target.y)
    corners = (Rectangle(at.x, at.y, at.yaw, part.size[:2]).corners() for at in (seen, target))
    apart_m = cdist(*corners)
    return float(max(apart_m.min(axis=0).max(), apart_m.min(axis=1).max()))


def turned_rad(seen: HeadSighting | SeenBox, part: Part, target: Location) -> float:
    """By how much a part is turned from how it is to stand, 0 to pi/2, as far as that shows.

    After half a turn it looks the same, a square one after a quarter of a turn, too.
    """
    alike = math.pi / 2 if part.off_square_m < _SQUARE_M else math.pi
    return abs(math.remainder(seen.yaw - target.yaw, alike))


def judge_presence(
    view: TableView, part: Part, equals: AbstractSet[str], target: Location, bottom_z: float
) -> Presence:
    """Whether `part`, or one of its `equals` by name, stands with its bottom at `bottom_z`."""
    room = room_of(part, target, bottom_z)
    for box in view.boxes:
        if box.name in equals and _stands_at(box, part, target, bottom_z):
            return Presence.THERE
    if equals <= {box.name for box in view.boxes if box.complete}:
        # Whatever may be hidden here, it is none of them: all are seen elsewhere.
        return Presence.GONE
    if any(_keeps_out(box, room) for box in view.boxes):
        return Presence.GONE
    return Presence.GONE if is_seen_through(view.heights, room) else Presence.HIDDEN


def room_of(part: Part, target: Location, bottom_z: float) -> SeenBox:
    """The room that a part takes whose bottom is at `bottom_z`."""
    size = (*part.size[:2], part.height)
    return SeenBox(target.x, target.y, target.yaw, size, bottom_z, None, complete=True)


def is_seen_through(heights: HeightMap, room: SeenBox) -> bool:
    """Whether the camera sees what is behind where the part's top would be, so that it is gone."""
    return _share_seen_through(heights, room) >= _SEEN_THROUGH


def is_unmeasured(image: CameraImage, room: SeenBox) -> bool:
    """Whether a picture has no depth of most of where the top of what is in a room would be.

    Though it might: what other robots hide is asked of nobody.
    """
    if image.depth_m is None:
        return True
    rows, columns, pictured = _pixels_of_top(image, room)
    rows, columns = rows[pictured], columns[pictured]
    if image.others is not None:
        free = ~image.others[rows, columns]
        rows, columns = rows[free], columns[free]
    if len(rows) < _LEAST_MEASURED * np.count_nonzero(pictured) or not len(rows):
        return False
    measured = is_measured(image.depth_m[rows, columns])
    return float(measured.mean()) < _LEAST_MEASURED


def top_px(image: CameraImage, room: SeenBox) -> NDArray[np.bool_]:
    """Pixels (h, w) of where the top of what is in a room would be."""
    rows, columns, pictured = _pixels_of_top(image, room)
    found = np.zeros(image.bgr.shape[:2], np.bool_)
    found[rows[pictured], columns[pictured]] = True
    return found


def _stands_at(box: SeenBox, part: Part, target: Location, bottom_z: float) -> bool:
    near = is_near(box, part, target) and not box.toppled
    return near and abs(box.bottom_z - bottom_z) <= AT_PLACE_HEIGHT_M


def is_near(seen: HeadSighting | SeenBox, part: Part, target: Location) -> bool:
    """Whether a part is at its place, seen from above."""
    off_m = off_place_m(seen, part, target)
    turn_shows = seen.complete and (part.off_square_m >= _SQUARE_M or off_m > _TURN_SHOWS_M)
    turned = turn_shows and turned_rad(seen, part, target) > AT_PLACE_RAD
    return off_m <= AT_PLACE_M and not turned


def _keeps_out(box: SeenBox, room: SeenBox) -> bool:
    """Whether what is not at its place fills so much of the room that the part cannot be in it.

    That may be the part itself, or an equal one. Something unknown of the part's own height may be
    the part, badly seen; what is higher may stand on it, as nobody sees what is under something
    unknown.
    """
    if not box.complete:
        return False
    overlap_m = min(box.top_z, room.top_z) - max(box.bottom_z, room.bottom_z)
    if overlap_m < AT_PLACE_HEIGHT_M / 2 or not _fills(box, room):
        return False
    return box.name is not None or box.top_z < room.top_z - AT_PLACE_HEIGHT_M


def _fills(box: SeenBox, room: SeenBox) -> bool:
    """Whether a box has the middle of the room, or reaches farther in than a part may be off."""
    middle = np.array([[room.x, room.y, (box.bottom_z + box.top_z) / 2]])
    if box.holds(middle, margin_m=0.0)[0]:
        return True
    outlines = [shapely.Polygon(each.corners()).buffer(-AT_PLACE_M / 2) for each in (box, room)]
    return bool(outlines[0].intersects(outlines[1]))


def _share_seen_through(seen: HeightMap, room: SeenBox) -> float:
    """The share of where the part's top would be behind which the camera sees something."""
    rows, columns, pictured = _pixels_of_top(seen.image, room)
    heights = np.full(len(rows), np.nan)
    heights[pictured] = seen.height_m[rows[pictured], columns[pictured]]
    # A ray that is still under the top's height has passed through where the top would be.
    slack_m = min(max(0.006, 5 * seen.noise_m), room.size[2] / 2)
    with np.errstate(invalid="ignore"):
        return float((heights < room.top_z - slack_m).mean())


def _pixels_of_top(image: CameraImage, room: SeenBox) -> tuple[Indices, Indices, NDArray[np.bool_]]:
    """The rows and columns of points (n) of the part's top, and which of them are in the picture.

    It is the inner part of the top of which `_INNER` tells.
    """
    spread = np.linspace(-_INNER / 2, _INNER / 2, _SAMPLES)
    x, y = (each.ravel() for each in np.meshgrid(spread * room.size[0], spread * room.size[1]))
    cos, sin = math.cos(room.yaw), math.sin(room.yaw)
    tops = np.stack(
        [room.x + cos * x - sin * y, room.y + sin * x + cos * y, np.full(len(x), room.top_z)],
        axis=1,
    )
    us, vs = np.rint(project(image, tops)).astype(np.intp).T
    height, width = image.bgr.shape[:2]
    return vs, us, (us >= 0) & (us < width) & (vs >= 0) & (vs < height)
