"""The ways of a building while some of them are blocked and doors are closed for a while."""

from collections.abc import Iterable, Mapping
from copy import copy
from dataclasses import replace
from math import inf

from mend.fleet.scheduling.building_travel import travel_in
from mend.fleet.scheduling.replanning.events import EventError
from mend.fleet.scheduling.travel import Travel, TravelError
from mend.maps.navigation import NavigationGraph, Way


class OpenWays:
    """A navigation graph whose ways are closed and opened while robots drive."""

    def __init__(self, graph: NavigationGraph, speed_m_s: float, starts_s: float = 0.0) -> None:
        """`starts_s` comes on top of each trip."""
        self._whole = graph
        self._speed_m_s, self._starts_s = speed_m_s, starts_s
        self._closed_until_s: dict[frozenset[str], float] = {}
        self._graph = graph

    def copy(self) -> "OpenWays":
        """The same ways by themselves: what is closed there stays open here."""
        ways = copy(self)
        ways._closed_until_s = dict(self._closed_until_s)
        return ways

    def travel(self) -> Travel:
        """Travel between all places as the ways are now."""
        return travel_in(self._graph, self._speed_m_s, starts_s=self._starts_s)

    @property
    def closed_until_s(self) -> Mapping[frozenset[str], float]:
        """What is closed, by its two places, and until when."""
        return self._closed_until_s

    def close(self, between: Iterable[str], until_s: float) -> Travel:
        """Close what is between two neighbouring places, an elevator altogether; travel from then.

        Raises `EventError`, also where ways change at more times than can be planned with.
        """
        before = dict(self._closed_until_s)
        self._closed_until_s |= dict.fromkeys(self._ways(between), until_s)
        self._renew()
        try:
            return self.travel()
        except TravelError as error:
            self._closed_until_s = before
            self._renew()
            raise EventError(str(error)) from error

    def open(self, between: Iterable[str]) -> Travel:
        """Open it again; travel from then on. Raises `EventError`."""
        for way in self._ways(between):
            self._closed_until_s.pop(way, None)
        self._renew()
        return self.travel()

    def forget_reopened(self, now_s: float) -> bool:
        """Forget what counts as open again by now; whether there was any."""
        kept = {way: until for way, until in self._closed_until_s.items() if until > now_s}
        changed = len(kept) < len(self._closed_until_s)
        if changed:
            self._closed_until_s = kept
            self._renew()
        return changed

    def path(
        self, trip: tuple[int, int], arrival_s: float, leaves_s: float, speed: float
    ) -> tuple[tuple[int, float], ...]:
        """The places of a trip by number, each with the time when the robot is there."""
        way = self._graph.quickest_path(*trip, self._speed_m_s, from_s=leaves_s, until_s=arrival_s)
        lasts_s = way[-1][1] / speed if way else 0.0
        begins_s = max(leaves_s, arrival_s - lasts_s)
        return tuple((place, begins_s + after_s / speed) for place, after_s in way)

    def numbers(self, between: Iterable[str]) -> frozenset[int]:
        """The numbers of two neighbouring places, of an elevator all its stops.

        Raises `EventError`.
        """
        places = frozenset[str]().union(*self._ways(between))
        return frozenset(self._whole.index(name) for name in places)

    def _ways(self, between: Iterable[str]) -> frozenset[frozenset[str]]:
        ends = frozenset(between)
        ways = self._whole.together(ends)
        if not ways:
            raise EventError(f"there is no way between {' and '.join(sorted(ends))}")
        return ways

    def _renew(self) -> None:
        ways = (self._now(way) for way in self._whole.ways)
        self._graph = NavigationGraph(self._whole.places, ways)

    def _now(self, way: Way) -> Way:
        until_s = self._closed_until_s.get(frozenset((way.a, way.b)))
        if until_s is None:
            return way
        if until_s == inf:
            return replace(way, closed=True)
        spans = way.open_s or ((0.0, inf),)
        later = tuple((max(a, until_s), b) for a, b in spans if b > until_s)
        return replace(way, open_s=later) if later else replace(way, closed=True)
