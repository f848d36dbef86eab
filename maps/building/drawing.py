"""A picture of one floor: walls, doors, lanes, and the places by their names."""

from mend.maps.building.building import Building, Floor, PlaceKind
from mend.maps.svg import Svg

Point = tuple[float, float]

_LONGER_PX = 1200.0
_MARGIN_PX = 40.0
_NAMES_PX = 160.0
"""For the names of places at the right."""
_RADII_PX = {PlaceKind.WAYPOINT: 2.0}
_COLORS = {
    PlaceKind.WAYPOINT: "#69727c",
    PlaceKind.ROOM: "#4269d0",
    PlaceKind.CHARGER: "#3ca951",
    PlaceKind.PARKING: "#8d5ad6",
    PlaceKind.ELEVATOR: "#e0851b",
}


def floor_picture(building: Building, name: str) -> str:
    """A floor as SVG. Raises `KeyError` where there is none of this name."""
    return _FloorPicture(building.floors[name]).document(f"{building.name}, {name}")


class _FloorPicture:
    def __init__(self, floor: Floor) -> None:
        self._floor = floor
        xs, ys = zip(*_points(floor), strict=True)
        self._left, self._top = min(xs), max(ys)
        width, height = max(xs) - self._left, self._top - min(ys)
        self._scale = (_LONGER_PX - 2 * _MARGIN_PX) / (max(width, height) or 1.0)
        self._width_px = width * self._scale + 2 * _MARGIN_PX + _NAMES_PX
        self._height_px = height * self._scale + 2 * _MARGIN_PX
        self._svg = Svg()

    def document(self, title: str) -> str:
        for x0, y0, x1, y1 in self._floor.walls:
            self._line((x0, y0), (x1, y1), "var(--ink)", 1.5)
        for lane in self._floor.lanes:
            a, b = (self._floor.places[each] for each in lane.between)
            dashes = "6 3" if lane.one_way else "none"
            self._line((a.x, a.y), (b.x, b.y), "#1a9fae", 1.0, dashes)
        for door in self._floor.doors.values():
            self._line(*door.posts, "#d6483b", 3.0)
        for name, place in self._floor.places.items():
            x, y = self._at((place.x, place.y))
            radius = _RADII_PX.get(place.kind, 5.0)
            self._svg.add("circle", cx=x, cy=y, r=radius, fill=_COLORS[place.kind])
            if place.kind is not PlaceKind.WAYPOINT:
                self._svg.text(x + 7, y + 4, name, "halo")
        self._svg.text(16, 24, title, "title")
        return self._svg.document(self._width_px, self._height_px, title)

    def _at(self, point: Point) -> Point:
        x, y = point
        return (x - self._left) * self._scale + _MARGIN_PX, (
            self._top - y
        ) * self._scale + _MARGIN_PX

    def _line(self, a: Point, b: Point, color: str, width_px: float, dashes: str = "none") -> None:
        (x1, y1), (x2, y2) = self._at(a), self._at(b)
        self._svg.add(
            "line", x1=x1, y1=y1, x2=x2, y2=y2, stroke=color, stroke_width=width_px,
            stroke_dasharray=dashes,
        )  # fmt: skip


def _points(floor: Floor) -> list[Point]:
    ends = [point for x0, y0, x1, y1 in floor.walls for point in ((x0, y0), (x1, y1))]
    return [*ends, *((each.x, each.y) for each in floor.places.values())] or [(0.0, 0.0)]
