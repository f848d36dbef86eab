"""Furniture: it stands about, is on no map, and is put elsewhere now and then."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from mend.maps.building.building import Floor
from mend.maps.building.clearance import distances_m
from mend.maps.building.crossing import crossed_by
from mend.maps.ray_cast import cast_from_each

Matrix = NDArray[np.float64]
Point = tuple[float, float]
Row = tuple[float, float, float, float, float]
"""x, y, yaw, length and width of a piece."""
Way = tuple[float, float, float, float]

_SIZES_M = ((0.5, 0.5), (0.4, 0.3), (1.0, 0.45), (1.4, 0.7), (1.8, 0.8), (0.8, 0.4))
"""Chairs, boxes, cupboards, tables, sofas, shelves."""
_AT_WALL = 0.7
"""So many of the pieces are put along a wall."""
_OFF_WALL_M = 0.08
_SAMPLE_M = 0.1
_APART_M = 0.15
_TRIES = 600
"""So many places in vain, and there is no room left."""
_LOOKS_EVERY_M = 1.5
_MOST_LOOKS = 40
_BEAMS = np.linspace(-math.pi, math.pi, 72, endpoint=False)
_REACH_M = 10.0


@dataclass(frozen=True, slots=True)
class Piece:
    """A box on the floor, around its middle (metres, radians)."""

    x: float
    y: float
    yaw: float
    length_m: float
    width_m: float

    @property
    def row(self) -> Row:
        return self.x, self.y, self.yaw, self.length_m, self.width_m

    @property
    def segments(self) -> Matrix:
        """Its four sides (4, 4)."""
        half = np.array([self.length_m, self.width_m]) / 2.0
        corners = self._placed(np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * half)
        return np.hstack([corners, np.roll(corners, -1, axis=0)])

    @property
    def samples(self) -> Matrix:
        """Points (n, 2) all over it, its edges too."""
        along, across = (
            np.linspace(-size / 2.0, size / 2.0, max(2, math.ceil(size / _SAMPLE_M) + 1))
            for size in (self.length_m, self.width_m)
        )
        return self._placed(np.stack(np.meshgrid(along, across), axis=-1).reshape(-1, 2))

    def _placed(self, points: Matrix) -> Matrix:
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        return np.asarray(points @ np.array([[cos, sin], [-sin, cos]]) + (self.x, self.y))


def sides_of(pieces: Iterable[Piece]) -> Matrix:
    """The sides of some pieces (n, 4)."""
    return np.vstack([np.zeros((0, 4)), *(each.segments for each in pieces)])


class Room:
    """Where on one floor furniture may stand: off its walls and doors, and clear of its lanes."""

    def __init__(self, floor: Floor, keep_clear: Matrix, clear_m: float) -> None:
        """`keep_clear`: ways (n, 4) from whose middle it is `clear_m` away at least."""
        self._walls = floor.vector_map.segments
        self._clear = keep_clear
        self._clear_m = clear_m
        self._looks = np.array(_looks_from(keep_clear)).reshape(-1, 2)

    @cached_property
    def _bare_m(self) -> Matrix:
        """How far each beam of each look goes where nothing stands."""
        return self._ranges_m(self._walls)

    def _ranges_m(self, segments: Matrix) -> Matrix:
        """How far each beam of each look goes to segments."""
        return cast_from_each(segments, self._looks, _BEAMS, _REACH_M)

    def hidden_by(self, pieces: Iterable[Piece]) -> NDArray[np.bool_]:
        """Which beams of all looks end at some pieces, in front of the walls."""
        ranges_m = self._ranges_m(sides_of(pieces))
        return np.asarray(ranges_m < self._bare_m - 1e-6)

    @property
    def returns(self) -> int:
        """How many beams of all looks come back."""
        return int((self._bare_m < _REACH_M).sum())

    def fits(self, piece: Piece, others: Iterable[Piece]) -> bool:
        """Whether a piece may stand there among others."""
        samples = piece.samples
        if not _is_off(self._walls, samples, _OFF_WALL_M - 1e-3):
            return False
        if not _is_off(self._clear, samples, self._clear_m + _SAMPLE_M / 2.0):
            return False
        sides = sides_of(each for each in others if _near(each, piece))
        return bool(distances_m(samples, sides).min() > _APART_M)

    def draw(self, rng: np.random.Generator) -> Piece:
        """Some piece somewhere, fitting or not."""
        length_m, width_m = _SIZES_M[int(rng.integers(len(_SIZES_M)))]
        if rng.random() < _AT_WALL and len(self._walls):
            return self._at_wall(length_m, width_m, rng)
        low, high = self._clear.reshape(-1, 2).min(axis=0), self._clear.reshape(-1, 2).max(axis=0)
        x, y = rng.uniform(low - 4.0, high + 4.0).tolist()
        return Piece(x, y, float(rng.uniform(0.0, math.pi)), length_m, width_m)

    def _at_wall(self, length_m: float, width_m: float, rng: np.random.Generator) -> Piece:
        x0, y0, x1, y1 = self._walls[int(rng.integers(len(self._walls)))].tolist()
        share, side = float(rng.random()), 1.0 if rng.random() < 0.5 else -1.0
        yaw = math.atan2(y1 - y0, x1 - x0)
        off_m = side * (width_m / 2.0 + _OFF_WALL_M)
        x, y = x0 + share * (x1 - x0), y0 + share * (y1 - y0)
        return Piece(x - off_m * math.sin(yaw), y + off_m * math.cos(yaw), yaw, length_m, width_m)


class Furniture:
    """The furniture of a building, floor by floor; all draws come from one generator."""

    def __init__(self, rooms: Mapping[str, Room], share: float, rng: np.random.Generator) -> None:
        """Put so much into each floor that of what lasers see from its lanes this `share` is on it.

        Where no more fits it stays with less.
        """
        self._rooms = rooms
        self._rng = rng
        self._sides: dict[str, Matrix] = {}
        self._pieces = {floor: self._fill(room, share) for floor, room in rooms.items()}

    def on(self, floor: str) -> Sequence[Piece]:
        """What stands on a floor."""
        return self._pieces.get(floor, [])

    def segments(self, floor: str) -> Matrix:
        """The sides of all that stands on a floor (n, 4)."""
        if floor not in self._sides:
            self._sides[floor] = sides_of(self.on(floor))
        return self._sides[floor]

    def share(self, floor: str) -> float:
        """How much of what lasers see from a floor's lanes is furniture."""
        room = self._rooms[floor]
        return float(room.hidden_by(self.on(floor)).sum()) / max(room.returns, 1)

    def move_one(self, floor: str, away_from: Iterable[Point], away_m: float) -> None:
        """Put one piece of a floor elsewhere, where nobody of `away_from` is nearer to it."""
        pieces = self._pieces.get(floor, [])
        if not pieces:
            return
        moved = pieces.pop(int(self._rng.integers(len(pieces))))
        stand = np.array(list(away_from)).reshape(-1, 2)
        found = self._find(self._rooms[floor], pieces)
        if found is not None and len(stand):
            near_m = distances_m(stand, found.segments).min()
            found = found if near_m > away_m else None
        pieces.append(found or moved)
        self._sides.pop(floor, None)

    def rows(self) -> dict[str, list[Row]]:
        """All of it, for `restore`."""
        return {floor: [each.row for each in pieces] for floor, pieces in self._pieces.items()}

    def restore(self, rows: Mapping[str, Sequence[Row]]) -> None:
        """Raises `ValueError` where the floors are others."""
        if rows.keys() != self._pieces.keys():
            raise ValueError("the snapshot has furniture on other floors than the building")
        self._pieces = {floor: [Piece(*row) for row in each] for floor, each in rows.items()}
        self._sides.clear()

    def _fill(self, room: Room, share: float) -> list[Piece]:
        pieces: list[Piece] = []
        if share <= 0.0:
            return pieces
        hidden = room.hidden_by(pieces)
        while hidden.sum() < share * room.returns:
            piece = self._find(room, pieces)
            if piece is None:
                break
            pieces.append(piece)
            hidden |= room.hidden_by([piece])
        return pieces

    def _find(self, room: Room, others: Sequence[Piece]) -> Piece | None:
        """A piece that fits, and that somebody on a lane sees."""
        for _ in range(_TRIES):
            piece = room.draw(self._rng)
            if room.fits(piece, others) and room.hidden_by([piece]).any():
                return piece
        return None


def kept_clear(floor: Floor, points: Iterable[Point]) -> Matrix:
    """The ways (n, 4) that nothing may stand on: all lanes, and from each point to the lanes."""
    ends = [[floor.places[name] for name in each.between] for each in floor.lanes]
    ways = [(a.x, a.y, b.x, b.y) for a, b in ends]
    return np.array([*ways, *(_to_lanes(floor, each) for each in points)]).reshape(-1, 4)


def _to_lanes(floor: Floor, point: Point) -> Way:
    """Straight to the nearest place that no wall is before."""
    by_distance = sorted(
        floor.places.values(), key=lambda each: math.hypot(each.x - point[0], each.y - point[1])
    )
    ways = ((*point, each.x, each.y) for each in by_distance)
    free = (each for each in ways if not len(crossed_by(np.array(each), floor.wall_segments)))
    return next(free, (*point, *point))


def _looks_from(ways: Matrix) -> list[Point]:
    """Points along ways from which one looks around, not too many."""
    points = []
    for x0, y0, x1, y1 in ways.tolist():
        count = max(1, round(math.hypot(x1 - x0, y1 - y0) / _LOOKS_EVERY_M))
        shares = (np.arange(count) + 0.5) / count
        points += [(x0 + share * (x1 - x0), y0 + share * (y1 - y0)) for share in shares.tolist()]
    step = max(1, math.ceil(len(points) / _MOST_LOOKS))
    return points[::step]


def _is_off(segments: Matrix, points: Matrix, by_m: float) -> bool:
    """Whether none of the points is nearer to any of the segments."""
    low, high = points.min(axis=0) - by_m, points.max(axis=0) + by_m
    ends = segments.reshape(-1, 2, 2)
    beside = (ends.max(axis=1) < low).any(axis=1) | (ends.min(axis=1) > high).any(axis=1)
    return bool(distances_m(points, segments[~beside]).min() >= by_m)


def _near(a: Piece, b: Piece) -> bool:
    reach_m = (a.length_m + a.width_m + b.length_m + b.width_m) / 2.0 + _APART_M
    return math.hypot(a.x - b.x, a.y - b.y) < reach_m
