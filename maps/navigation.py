"""Navigation graphs of buildings: places on floors, ways between them, doors that open and close.

Distances are metres, times seconds from an origin that whoever uses the graph chooses.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from math import hypot, inf

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from mend.errors import WrongInputError

Matrix = NDArray[np.float64]


class WayKind(StrEnum):
    """What leads from place to place."""

    CORRIDOR = "corridor"
    DOOR = "door"
    ELEVATOR = "elevator"


class NavigationError(WrongInputError):
    """A graph that makes no sense; raised with one sentence per mistake."""

    def __init__(self, mistakes: list[str]) -> None:
        super().__init__("; ".join(mistakes))
        self.mistakes = mistakes


@dataclass(frozen=True, slots=True)
class Place:
    """A named point on a floor (metres in the floor's frame)."""

    name: str
    x_m: float
    y_m: float
    floor: int = 0


@dataclass(frozen=True, slots=True)
class Way:
    """A way between two places, in both directions unless it is `one_way` from `a` to `b`.

    `length_m` None: the straight line. `delay_s` comes on top of driving it (an elevator's ride, a
    door's opening). `open_s`: when it may be passed, as pairs of times; always when empty.
    `speed_m_s`: nobody drives faster there.
    """

    a: str
    b: str
    kind: WayKind = WayKind.CORRIDOR
    length_m: float | None = None
    delay_s: float = 0.0
    open_s: tuple[tuple[float, float], ...] = ()
    closed: bool = False
    one_way: bool = False
    speed_m_s: float | None = None

    def passable(self, from_s: float, until_s: float) -> bool:
        """Whether it may be passed at every moment of a span of time."""
        if self.closed:
            return False
        return not self.open_s or any(a <= from_s and until_s <= b for a, b in self.open_s)


class NavigationGraph:
    """Places and the ways between them. Raises `NavigationError` where they contradict."""

    def __init__(self, places: Sequence[Place], ways: Iterable[Way]) -> None:
        self.places = tuple(places)
        self.ways = tuple(ways)
        self._ends = frozenset(frozenset((way.a, way.b)) for way in self.ways)
        self._index = {place.name: number for number, place in enumerate(self.places)}
        mistakes = self._mistakes()
        if mistakes:
            raise NavigationError(mistakes)

    def index(self, name: str) -> int:
        """The number of a place. Raises `KeyError`."""
        return self._index[name]

    def place(self, name: str) -> Place:
        """A place by its name. Raises `KeyError`."""
        return self.places[self._index[name]]

    def together(self, between: Iterable[str]) -> frozenset[frozenset[str]]:
        """The ways that are closed with one: of an elevator all its rides, else that one alone.

        Ways are named by their ends; none for places that are no neighbours.
        """
        rides = {frozenset((e.a, e.b)) for e in self.ways if e.kind is WayKind.ELEVATOR}
        found, stops = set[frozenset[str]](), frozenset(between)
        if stops not in rides:
            return frozenset(each for each in self._ends if each == stops)
        while more := {each for each in rides - found if each & stops}:
            found |= more
            stops = stops.union(*more)
        return frozenset(found)

    def shortest(
        self, speed_m_s: float, *, from_s: float = 0.0, until_s: float = inf
    ) -> tuple[Matrix, Matrix]:
        """Distance (metres) and time (seconds) between all places, along the quickest ways.

        Only ways that are passable from `from_s` until `until_s` count; infinite where there is
        none.
        """
        count = len(self.places)
        rows, columns, seconds, metres = self._edges(speed_m_s, from_s, until_s)
        times = csr_matrix((seconds, (rows, columns)), shape=(count, count))
        time_s, before = dijkstra(times, return_predecessors=True)
        lengths = {
            (row, column): metre for row, column, metre in zip(rows, columns, metres, strict=True)
        }
        distance_m = np.full((count, count), inf)
        for origin in range(count):
            distance_m[origin, origin] = 0.0
            for place in np.argsort(time_s[origin]):
                previous = before[origin, place]
                if previous >= 0:
                    leg_m = lengths[previous, place]
                    distance_m[origin, place] = distance_m[origin, previous] + leg_m
        return distance_m, np.asarray(time_s, dtype=np.float64)

    def quickest_path(
        self,
        origin: int,
        destination: int,
        speed_m_s: float,
        *,
        from_s: float = 0.0,
        until_s: float = inf,
    ) -> tuple[tuple[int, float], ...]:
        """The places on the quickest way, by number, each with the seconds from the origin to it.

        Only ways that are passable from `from_s` until `until_s` count; empty where there is none.
        """
        count = len(self.places)
        rows, columns, seconds, _ = self._edges(speed_m_s, from_s, until_s)
        times = csr_matrix((seconds, (rows, columns)), shape=(count, count))
        time_s, before = dijkstra(times, indices=origin, return_predecessors=True)
        if time_s[destination] == inf:
            return ()
        path = [destination]
        while path[-1] != origin:
            path.append(int(before[path[-1]]))
        return tuple((place, float(time_s[place])) for place in reversed(path))

    def changes_s(self) -> list[float]:
        """The times at which a way opens or closes, in order."""
        return sorted({time_s for way in self.ways for span in way.open_s for time_s in span})

    def _edges(
        self, speed_m_s: float, from_s: float, until_s: float
    ) -> tuple[list[int], list[int], list[float], list[float]]:
        """The quickest passable way from each place to each other that has one."""
        best: dict[tuple[int, int], tuple[float, float]] = {}
        for way in self.ways:
            if not way.passable(from_s, until_s):
                continue
            ends = self._index[way.a], self._index[way.b]
            metres = self._length_m(way)
            speed = min(speed_m_s, way.speed_m_s or speed_m_s)
            # A way that takes no time would be no edge at all to scipy.
            seconds = max(metres / speed + way.delay_s, 1e-9)
            for edge in (ends,) if way.one_way else (ends, ends[::-1]):
                if edge not in best or seconds < best[edge][0]:
                    best[edge] = (seconds, metres)
        rows, columns = [a for a, _ in best], [b for _, b in best]
        return rows, columns, [s for s, _ in best.values()], [m for _, m in best.values()]

    def _length_m(self, way: Way) -> float:
        if way.length_m is not None:
            return way.length_m
        a, b = self.places[self._index[way.a]], self.places[self._index[way.b]]
        return hypot(a.x_m - b.x_m, a.y_m - b.y_m)

    def _mistakes(self) -> list[str]:
        mistakes = []
        if len(self._index) < len(self.places):
            names = [place.name for place in self.places]
            double = sorted({name for name in names if names.count(name) > 1})
            mistakes.append(f"places share a name: {', '.join(double)}")
        for way in self.ways:
            what = f"the way between '{way.a}' and '{way.b}'"
            missing = [name for name in (way.a, way.b) if name not in self._index]
            if missing:
                mistakes.append(f"{what}: there is no place '{missing[0]}'")
                continue
            if way.a == way.b:
                mistakes.append(f"{what} leads nowhere")
            if not 0 <= way.delay_s < inf or not 0 <= (way.length_m or 0.0) < inf:
                mistakes.append(f"{what}: length and delay must be at least 0")
            if way.speed_m_s is not None and not way.speed_m_s > 0.0:
                mistakes.append(f"{what}: its speed must be above 0")
            if any(not a <= b for a, b in way.open_s):
                mistakes.append(f"{what} closes before it opens")
            floors = {self.places[self._index[name]].floor for name in (way.a, way.b)}
            if len(floors) > 1 and way.kind is not WayKind.ELEVATOR:
                mistakes.append(f"{what} joins two floors, but is no elevator")
        return mistakes
