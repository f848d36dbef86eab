"""Everything that one head picture shows on the table: the parts by name, and unknown things."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import cv2
import numpy as np
import shapely
from numpy.typing import NDArray

from mend.robots.arm.grasp import half_turn
from mend.robots.body import CameraImage
from mend.robots.catalogue import Part
from mend.robots.link.messages import Location
from mend.robots.vision.blob import Blob
from mend.robots.vision.color_model import ColorModel
from mend.robots.vision.evidence import gather, may_tell_of
from mend.robots.vision.head import HeadSighting
from mend.robots.vision.height_map import IN_FRONT_M, HeightMap, measure_heights
from mend.robots.vision.level_rectangle import Rectangle
from mend.robots.vision.level_surfaces import Pixels, Surface, Surfaces, find_surfaces
from mend.robots.vision.match_fit import carried_by, fit_match
from mend.robots.vision.naming import Match, Namer, Top
from mend.robots.vision.projection import Points, unproject
from mend.robots.vision.rectangle import Fitted, fit_any
from mend.robots.vision.seen_box import SeenBox
from mend.robots.vision.tracking import LastSeen
from mend.tasks.scene import Table

_COMPLETE_SHARE = 0.8
_HALF = 0.5
_SHARED = 0.4
_MUCH_OF_TOP = 0.2
"""A surface of a smaller share of a top is surely less than half of it, however it was cut."""
_BESIDE_KNOB = 0.1
"""At least so much of a plate's top is to be seen beside its knob."""
_APART_M = 0.005
"""Where badly seen boxes share less of their outline, or of their height, each may be right."""
_OWN_M = 0.004
_OF_KNOWN = 0.5
"""What is within parts' outlines, so much wider, and not above them is the parts themselves; of a
surface at least this share."""


@dataclass(frozen=True, slots=True, eq=False)
class TableView:
    """What a head picture shows; `sightings` by name, `boxes` of the known and the unknown.

    `recalled` are boxes of what is hidden where it was last seen.
    """

    heights: HeightMap
    sightings: Mapping[str, HeadSighting]
    boxes: Sequence[SeenBox]
    recalled: Sequence[SeenBox] = ()

    @property
    def known(self) -> list[SeenBox]:
        """The boxes of parts, seen or recalled."""
        return [*(each for each in self.boxes if each.name is not None), *self.recalled]

    def standing_out(self, over_z: float) -> tuple[Pixels, Pixels, Points]:
        """The pixels (us, vs) that show something higher than `over_z`, and their points."""
        height_m = self.heights.height_m
        with np.errstate(invalid="ignore"):
            vs, us = np.nonzero((height_m > over_z) & (height_m < IN_FRONT_M))
        points = unproject(self.heights.image, us, vs)
        points[:, 2] = height_m[vs, us]
        return us, vs, points


def view_table(
    image: CameraImage,
    table: Table,
    parts: Mapping[str, Part],
    model: ColorModel,
    last_seen: LastSeen,
    own_arm: Callable[[NDArray[np.float64]], NDArray[np.bool_]] | None = None,
    wanted: str | None = None,
) -> TableView | None:
    """Understand a head picture; None for one without depth.

    `parts` are those that can be on the table, by name; `last_seen` is what earlier pictures say
    of them; `own_arm` says of points (n, 3) which belong to the robot. `wanted` is the part that
    the robot is about to handle, or asked for.
    """
    heights = measure_heights(image, table, own_arm)
    if heights is None:
        return None
    known = {name: part for name, part in parts.items() if name in model.names}
    namer, segmentation = Namer(known, model), model.segment(image.bgr)
    name = partial(namer.name, segmentation=segmentation, last_seen=last_seen.spots, wanted=wanted)
    seen = _understand(find_surfaces(heights), name, last_seen, image, known={})
    may_be_parts = partial(_may_be_parts, heights=heights, parts=list(known.values()))
    for joined in [each for each in seen.surfaces.all if any(map(may_be_parts, each.pieces))]:
        if len(seen.named) == len(known):
            break
        # It may be several, as high and of one colour, with something before them.
        surfaces = seen.surfaces.with_pieces_apart([joined])
        apart = _understand(surfaces, name, last_seen, image, seen.tops_away_from(joined))
        seen = apart if apart.half_seen > seen.half_seen else seen
    sightings = {match.part.name: sighting for match, sighting in seen.named}
    boxes = [box for match, sighting in seen.named for box in _boxes(match, sighting)]
    strange = [
        _unknown_box(top, table.height)
        for top in seen.unknown
        if not _is_of(top, boxes, seen.surfaces.tolerance_m)
    ]
    return TableView(heights, sightings, [*boxes, *strange])


def _may_be_parts(surface: Surface, heights: HeightMap, parts: Sequence[Part]) -> bool:
    """Whether a surface may be the greater part of a top, and a part may be so high up.

    Of an arm in the picture hundreds of bits may be seen that are neither.
    """
    highest_m = sum(max(*part.size, part.height) for part in parts)
    if surface.top_z > heights.table_z + highest_m + _APART_M:
        return False
    pixel_m = float(heights.drop_m[surface.vs[0], surface.us[0]])
    least_m2 = _MUCH_OF_TOP * min(map(_least_top_m2, parts), default=0.0)
    return len(surface.us) * pixel_m**2 >= least_m2


def _least_top_m2(part: Part) -> float:
    """The smallest area that a part may show from above, upright or toppled."""
    a, b, _ = sorted(part.size)
    if part.knob is None:
        return a * b
    return min(a * b, math.prod(part.knob[:2]), _BESIDE_KNOB * part.size[0] * part.size[1])


@dataclass(frozen=True, slots=True, eq=False)
class _Understood:
    """What is seen in a picture if it has these surfaces: the parts, and what is no part."""

    surfaces: Surfaces
    tops: Sequence[Top]
    named: Sequence[tuple[Match, HeadSighting]]
    unknown: Sequence[Top]

    def tops_away_from(self, surface: Surface) -> Mapping[Surface, Top]:
        """Those that stay as they are, whatever a surface is taken for."""
        return {each.surface: each for each in self.tops if not may_tell_of(surface, each.surface)}

    @property
    def half_seen(self) -> int:
        """Of how many parts more than half is seen: no two of them are pieces of one top."""
        return sum(sighting.shown > _HALF for _, sighting in self.named)


def _understand(
    surfaces: Surfaces,
    name: Callable[[Sequence[Top], Surfaces], tuple[list[Match], list[Top]]],
    last_seen: LastSeen,
    image: CameraImage,
    known: Mapping[Surface, Top],
) -> _Understood:
    """`known` are the tops of surfaces that were measured already."""
    all_tops = [known.get(each) or _top(each, surfaces) for each in surfaces.all]
    tops = all_tops
    pieces: list[Top] = []
    while True:
        matches, unknown = name(tops, surfaces)
        found = []
        for match in matches:
            carried = carried_by(match, matches, surfaces.tolerance_m)
            stood = last_seen.seen_whole(match.part.name)
            fitted = fit_match(match, surfaces, stood, carried)
            found.append((match, _sighting(match, fitted, image)))
        kept, more = _without_pieces(found, last_seen)
        if not more:
            return _Understood(surfaces, all_tops, kept, [*unknown, *pieces])
        # The names that they took may belong to something else that is seen.
        pieces += more
        taken = {id(each.surface) for each in more}
        tops = [each for each in tops if id(each.surface) not in taken]


def _top(surface: Surface, surfaces: Surfaces) -> Top:
    evidence = gather(surface, surfaces)
    return Top(surface, evidence, fit_any(evidence))


def _sighting(match: Match, fitted: Fitted, image: CameraImage) -> HeadSighting:
    part, top = match.part, match.top.surface
    found = fitted.rectangle
    shown = min(fitted.shown / _visible_share(match, found, image), 1.0)
    ends = fitted.sides_seen
    placed = (ends[0] or ends[1]) and (ends[2] or ends[3])
    bottom_z = top.top_z - match.height_m
    return HeadSighting(
        x=found.x,
        y=found.y,
        z=bottom_z,
        yaw=half_turn(found.yaw),
        top_z=bottom_z + part.size[2] if match.upright else top.top_z,
        complete=placed and shown >= _COMPLETE_SHARE,
        shown=shown,
        blob=_blob(top, image),
        time=image.time,
        toppled=not match.upright,
    )


def _visible_share(match: Match, found: Rectangle, image: CameraImage) -> float:
    """The share of a plate that its own knob does not hide, with the knob's top if that is seen."""
    knob = match.part.knob
    if knob is None or not match.upright:
        return 1.0
    base_z = match.top.surface.top_z - match.height_m + match.part.size[2]
    eye = image.pose[:3, 3]
    base = replace(found, extents=knob[:2]).corners()
    stretch = (eye[2] - base_z) / (eye[2] - base_z - knob[2])
    hidden = cv2.convexHull(
        np.concatenate([base, eye[:2] + (base - eye[:2]) * stretch]).astype(np.float32)
    )
    plate = cv2.convexHull(found.corners().astype(np.float32))
    covered, _ = cv2.intersectConvexConvex(hidden, plate)
    on_top_m2 = 0.0 if match.knob is None else knob[0] * knob[1]
    return max(1.0 - (covered - on_top_m2) / math.prod(found.extents), _BESIDE_KNOB)


def _boxes(match: Match, at: HeadSighting) -> list[SeenBox]:
    if match.upright:
        stands = Location(x=at.x, y=at.y, z=at.z, yaw=at.yaw)
        return boxes_of(match.part, stands, at.z, complete=at.complete)
    size = (*match.extents, match.height_m)
    return [SeenBox(at.x, at.y, at.yaw, size, at.z, match.part.name, at.complete, True)]


def boxes_of(part: Part, at: Location, bottom_z: float, *, complete: bool) -> list[SeenBox]:
    """A part's box, and on a plate its knob's: beside that there is room over the plate."""
    return [
        SeenBox(at.x, at.y, at.yaw, size, bottom_z + above_m, part.name, complete)
        for above_m, size in part.boxes
    ]


def _unknown_box(top: Top, table_z: float) -> SeenBox:
    found = top.fitted.rectangle
    size = (*found.extents, top.surface.top_z - table_z)
    complete = all(top.fitted.whole)
    return SeenBox(found.x, found.y, half_turn(found.yaw), size, table_z, None, complete)


def _without_pieces(
    found: Sequence[tuple[Match, HeadSighting]], last_seen: LastSeen
) -> tuple[list[tuple[Match, HeadSighting]], list[Top]]:
    """What was found but for what is in one place with something better seen; and their tops.

    Two pieces of one part, which its own knob divides, can look like two equal parts. The name is
    then the one that was last nearer.
    """
    kept: list[tuple[Match, HeadSighting]] = []
    pieces = []
    for match, sighting in sorted(found, key=lambda each: -each[1].shown):
        boxes = _boxes(match, sighting)
        better = next((n for n, k in enumerate(kept) if _are_in_one_place(boxes, _boxes(*k))), None)
        if better is None:
            kept.append((match, sighting))
            continue
        pieces.append(match.top)
        whole, at = kept[better]
        names = whole.part.name, match.part.name
        if (
            whole.part.equals(match.part)
            and last_seen.nearer(names, (at.x, at.y, at.z)) == names[1]
        ):
            kept[better] = replace(whole, part=match.part), at
    return kept, pieces


def _are_in_one_place(some: Sequence[SeenBox], others: Sequence[SeenBox]) -> bool:
    """Whether a box of some takes up much of the room of a box of others, which nothing can."""
    return any(
        min(one.top_z, other.top_z) - max(one.bottom_z, other.bottom_z) > _APART_M
        and _shared(one, other) > _SHARED
        for one in some
        for other in others
    )


def _shared(one: SeenBox, other: SeenBox) -> float:
    """How much of the smaller outline is in the other one, from above."""
    if math.hypot(one.x - other.x, one.y - other.y) > sum(one.size[:2] + other.size[:2]) / 2:
        return 0.0
    outlines = [shapely.Polygon(each.corners()) for each in (one, other)]
    return outlines[0].intersection(outlines[1]).area / min(each.area for each in outlines)


def _is_of(top: Top, boxes: Sequence[SeenBox], tolerance_m: float) -> bool:
    """Whether most of a surface is pieces of boxes that are known already."""
    points = top.evidence.points[top.evidence.inside > 0.0]
    known = np.zeros(len(points), np.bool_)
    for box in boxes:
        if top.surface.top_z <= box.top_z + tolerance_m:
            known |= box.outline.holds(points, _OWN_M)
    return float(known.mean()) > _OF_KNOWN


def _blob(surface: Surface, image: CameraImage) -> Blob:
    us, vs = surface.us, surface.vs
    mask = np.zeros(image.bgr.shape[:2], np.uint8)
    mask[vs, us] = 255
    left, top = int(us.min()), int(vs.min())
    box = (left, top, int(us.max()) - left + 1, int(vs.max()) - top + 1)
    return Blob((float(us.mean()), float(vs.mean())), len(us), box, mask)
