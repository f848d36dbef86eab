"""Whether a place is free: what the head's picture shows in the room that a part needs."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely

from mend.robots.catalogue import Part
from mend.robots.link.messages import Location
from mend.robots.vision.carriers import below, unseen_carriers
from mend.robots.vision.head import HeadSighting
from mend.robots.vision.obstruction import Obstruction, obstruction_at, obstruction_of
from mend.robots.vision.projection import Points, pixels_covered
from mend.robots.vision.seen_box import SeenBox
from mend.robots.vision.table_view import TableView

_COVERED_SHARE = 0.7
"""Something covers a part of whose top less than this is seen."""

_HALF = 0.5
"""Something small is in a room if so much of it is."""


@dataclass(frozen=True, slots=True)
class Room:
    """The room that `part` takes at a place: upright, with its bottom at `bottom_z`.

    `meaning` says what it is when something else is there. `around_m` is looked at beside it.
    `over_part`: the room is over the part itself, so that what stands lower is beside it.
    """

    part: Part
    at: Location
    bottom_z: float
    meaning: str
    around_m: float = 0.0
    over_part: bool = False


def room_at_place(part: Part, target: Location, bottom_z: float) -> Room:
    """Where a part is to go."""
    return Room(part, target, bottom_z, f"is where {part.name} belongs")


def room_above(part: Part, sighting: HeadSighting) -> Room:
    """What has to be free over a part for the fingers to take it."""
    at = Location(x=sighting.x, y=sighting.y, z=sighting.top_z, yaw=sighting.yaw)
    # Of a part that is half covered the other half was measured: what covers it is beside that.
    around_m = 0.0 if sighting.shown >= _COVERED_SHARE else min(part.size[:2]) / 2
    return Room(part, at, sighting.top_z, f"lies on {part.name}", around_m, over_part=True)


@dataclass(frozen=True, slots=True)
class Fit:
    """How exactly a room has to be free. Lengths in metres.

    What reaches less than `margin_m` into it from the side or `tolerance_m` from below is its
    neighbour or what carries it. Something is in it that covers `share` of its floor and at least
    `fewest_px` pixels. Up to `approach_m` over it nothing may be either.
    """

    margin_m: float = 0.008
    tolerance_m: float = 0.010
    approach_m: float = 0.06
    share: float = 0.08
    fewest_px: int = 12


def find_occupant(view: TableView, room: Room, fit: Fit) -> Obstruction | None:
    """What is in `room` that is not its part."""
    return (
        _seen_occupant(view, room, fit)
        or _hidden_occupant(view, room, fit)
        or _known_occupant(view, room, fit)
    )


def _seen_occupant(view: TableView, room: Room, fit: Fit) -> Obstruction | None:
    us, vs, points = view.standing_out(room.bottom_z + fit.tolerance_m)
    volume = _volume(room, fit)
    column = replace(volume, size=(*volume.size[:2], np.inf)).holds(points, margin_m=0.0)
    us, vs, points = us[column], vs[column], points[column]
    inside = volume.holds(points, margin_m=0.0)
    free = np.zeros(len(points), np.bool_)
    for box in view.boxes:
        beside = room.over_part and box.name is not None and _is_lower(box, room, fit)
        if box.name == room.part.name or beside:
            free |= box.holds(points)
        elif box.bottom_z < volume.top_z:
            # Of what is taller than the room only a top above it may be seen.
            inside |= box.holds(points)
    inside &= ~free
    at = (room.at.x, room.at.y, room.bottom_z)
    floor_px = pixels_covered(view.heights.image, at, room.part.size[:2])
    found = obstruction_of(us, vs, points, inside, max(fit.fewest_px, fit.share * floor_px))
    if found is None:
        return None
    what = _most_of(points[inside], view.boxes) or "something unknown"
    return replace(found, what=f"{what} {room.meaning}")


def _hidden_occupant(view: TableView, room: Room, fit: Fit) -> Obstruction | None:
    """What the room's own part stands on there, too high, where nothing seen holds it up."""
    of_part = [each for each in view.boxes if each.name == room.part.name]
    if room.over_part or not of_part:
        return None
    box = min(of_part, key=lambda each: each.bottom_z)
    carrier = below(box, view.heights.table_z)
    if box.bottom_z <= room.bottom_z + fit.tolerance_m or carrier not in unseen_carriers(
        [*view.boxes, *view.recalled], view.heights.table_z
    ):
        return None
    # What carries a part alone is below its middle, wherever else it reaches.
    if not _volume(room, fit).outline.holds(np.array([[box.x, box.y]]), 0.0).any():
        return None
    found = obstruction_at(carrier, view.heights.image)
    return replace(found, part=None, what=f"{carrier.name} {room.meaning}")


def _known_occupant(view: TableView, room: Room, fit: Fit) -> Obstruction | None:
    """A part in the room of which the picture shows too little, or now nothing.

    What was seen there and was not seen to leave, since something hides it, is there. What lies on
    a part would hide that as well.
    """
    if room.over_part:
        return None
    volume = _volume(room, fit)
    inner = shapely.Polygon(volume.corners())
    for box in view.known:
        outline = shapely.Polygon(box.corners())
        much_m2 = min(fit.share * inner.area, _HALF * outline.area)
        as_high = box.bottom_z < volume.top_z and box.top_z > room.bottom_z + fit.tolerance_m
        if box.name == room.part.name or not as_high:
            continue
        if inner.intersection(outline).area >= much_m2 > 0.0:
            found = obstruction_at(box, view.heights.image)
            hidden = ", as I saw before something hid it" if box in view.recalled else ""
            return replace(found, part=None, what=f"{box.name} {room.meaning}{hidden}")
    return None


def _is_lower(box: SeenBox, room: Room, fit: Fit) -> bool:
    """Whether a known part stands on something lower than the room's floor."""
    return box.bottom_z < room.bottom_z - fit.tolerance_m


def _volume(room: Room, fit: Fit) -> SeenBox:
    length, width = (
        2 * (max(extent / 2 - fit.margin_m, 0.0) + room.around_m) for extent in room.part.size[:2]
    )
    height_m = room.part.height + fit.approach_m
    size = (length, width, height_m)
    return SeenBox(room.at.x, room.at.y, room.at.yaw, size, room.bottom_z, None, complete=True)


def _most_of(points: Points, boxes: Sequence[SeenBox]) -> str | None:
    """The known part that at least half of some points belong to."""
    for box in boxes:
        if box.name is not None and np.count_nonzero(box.holds(points)) * 2 >= len(points):
            return box.name
    return None
