"""Prioritized planning on a navigation graph: cooperative A* in space and time with reservations.

Silver, "Cooperative Pathfinding", AIIDE 2005, for tasks that never end: whoever has arrived plans
at once, as in the token passing of Ma et al., "Lifelong Multi-Agent Path Finding for Online Pickup
and Delivery Tasks", AAMAS 2017. Robots are points that keep to their plans to the second. Lanes
are cut into steps of about a metre, a second each; an elevator takes one robot at a time and is
always at the floor where it is called.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from heapq import heappop, heappush
from itertools import count, pairwise
from math import ceil, inf

from mend.maps.building.building import Building
from mend.maps.navigation import WayKind

Node = tuple[str, ...]
"""A place by its name; or on a lane, its ends and which step from the first one it is."""

STEP_M = 1.0
_LONGER_S = 60
"""A path that takes so much longer than the shortest is none."""


@dataclass(frozen=True, slots=True)
class Move:
    """To a neighbour, in so many seconds; `ride`: the elevator."""

    to: Node
    takes_s: int
    ride: str | None = None


def steps_of(building: Building) -> Mapping[Node, list[Move]]:
    """Where one may go from each node."""
    moves: dict[Node, list[Move]] = {(each.name,): [] for each in building.graph.places}
    at = {each.name: each for each in building.graph.places}
    elevators = {
        f"{floor}/{stop}": name
        for name, each in building.document.elevators.items()
        for floor, stop in each.stops.items()
    }
    for way in building.graph.ways:
        a, b = at[way.a], at[way.b]
        if way.kind is WayKind.ELEVATOR:
            takes_s = ceil(way.delay_s)
            moves[way.a,].append(Move((way.b,), takes_s, elevators[way.a]))
            moves[way.b,].append(Move((way.a,), takes_s, elevators[way.a]))
            continue
        length_m = ((a.x_m - b.x_m) ** 2 + (a.y_m - b.y_m) ** 2) ** 0.5
        parts = max(1, round(length_m / STEP_M))
        inner: list[Node] = [(way.a, way.b, str(number)) for number in range(1, parts)]
        chain: list[Node] = [(way.a,), *inner, (way.b,)]
        for one, other in pairwise(chain):
            moves.setdefault(one, []).append(Move(other, 1))
            if not way.one_way:
                moves.setdefault(other, []).append(Move(one, 1))
    return moves


@dataclass(slots=True)
class Reservations:
    """Who is at which node at which second, and who stays there for good from when on."""

    at: dict[tuple[Node, int], str] = field(default_factory=dict)
    stays: dict[Node, tuple[str, int]] = field(default_factory=dict)
    rides: dict[str, list[tuple[int, int, str]]] = field(default_factory=dict)

    def is_free(self, node: Node, time_s: int, robot: str) -> bool:
        """Whether nobody else is at a node at a second."""
        other, since_s = self.stays.get(node, (robot, 0))
        if other != robot and time_s >= since_s:
            return False
        return self.at.get((node, time_s), robot) == robot

    def swaps(self, a: Node, b: Node, time_s: int, robot: str) -> bool:
        """Whether somebody comes the other way in the second from `time_s` on."""
        other = self.at.get((b, time_s))
        return other is not None and other != robot and self.at.get((a, time_s + 1)) == other

    def may_ride(self, elevator: str, begin_s: int, end_s: int) -> bool:
        """Whether an elevator is nobody's for a time."""
        return all(b >= end_s or e <= begin_s for b, e, _ in self.rides.get(elevator, ()))

    def last_s(self, node: Node, robot: str) -> int:
        """The last second at which somebody else passes a node."""
        passed = (t for (n, t), who in self.at.items() if n == node and who != robot)
        return max(passed, default=-1)


class Planned:
    """Robots that go from goal to goal by plans in space and time, without ever touching."""

    def __init__(self, building: Building, starts: Mapping[str, str]) -> None:
        self._moves = steps_of(building)
        self._taken = Reservations()
        self.paths: dict[str, list[tuple[Node, int]]] = {}
        for robot, start in starts.items():
            self.paths[robot] = [((start,), 0)]
            self._taken.stays[(start,)] = robot, 0
        self._far: dict[Node, Mapping[Node, float]] = {}
        self._back = _reversed(self._moves)

    def arrives_s(self, robot: str) -> int:
        """When a robot is at the end of its path."""
        return self.paths[robot][-1][1]

    def plan(self, robot: str, goal: str, now_s: int) -> bool:
        """A path from where a robot stands to a goal, kept from all others; whether there is one.

        Who has none stays where it is.
        """
        here = self.paths[robot][-1][0]
        found = self._search(robot, here, (goal,), now_s)
        if found is None:
            return False
        del self._taken.stays[here]
        for (node, time_s), (_, until_s) in pairwise(found):
            for second in range(time_s, until_s):
                self._taken.at[node, second] = robot
        for (a, begin_s), (b, end_s) in pairwise(found):
            if ride := next((m.ride for m in self._moves[a] if m.to == b and m.ride), None):
                self._taken.rides.setdefault(ride, []).append((begin_s, end_s, robot))
        self._taken.at[found[-1]] = robot
        self._taken.stays[(goal,)] = robot, found[-1][1]
        self.paths[robot] = found
        return True

    def forget_before(self, now_s: int) -> None:
        """What is over is in nobody's way."""
        self._taken.at = {key: who for key, who in self._taken.at.items() if key[1] >= now_s}
        for elevator, rides in self._taken.rides.items():
            self._taken.rides[elevator] = [each for each in rides if each[1] > now_s]

    def _search(
        self, robot: str, here: Node, goal: Node, now_s: int
    ) -> list[tuple[Node, int]] | None:
        if goal in self._taken.stays and self._taken.stays[goal][0] != robot:
            return None
        left_s = self._to(goal)
        latest_s = now_s + left_s.get(here, inf) + _LONGER_S
        free_from_s = self._taken.last_s(goal, robot)
        order, numbers = [(now_s + left_s.get(here, inf), 0, here, now_s)], count(1)
        before: dict[tuple[Node, int], tuple[Node, int] | None] = {(here, now_s): None}
        while order:
            _, _, node, time_s = heappop(order)
            if node == goal and time_s > free_from_s:
                return _path_to((node, time_s), before)
            if time_s > latest_s:
                continue
            for to, at_s in self._next(robot, node, time_s):
                if (to, at_s) not in before and to in left_s:
                    before[to, at_s] = node, time_s
                    heappush(order, (at_s + left_s[to], next(numbers), to, at_s))
        return None

    def _next(self, robot: str, node: Node, time_s: int) -> Iterator[tuple[Node, int]]:
        taken = self._taken
        if taken.is_free(node, time_s + 1, robot):
            yield node, time_s + 1
        for move in self._moves[node]:
            there_s = time_s + move.takes_s
            if not taken.is_free(move.to, there_s, robot):
                continue
            if move.ride is not None:
                stays = all(taken.is_free(node, s, robot) for s in range(time_s, there_s))
                if stays and taken.may_ride(move.ride, time_s, there_s):
                    yield move.to, there_s
            elif not taken.swaps(node, move.to, time_s, robot):
                yield move.to, there_s

    def _to(self, goal: Node) -> Mapping[Node, float]:
        """How far it is to a goal from everywhere, if nobody else were there (s)."""
        if goal not in self._far:
            far: dict[Node, float] = {}
            order = [(0.0, goal)]
            while order:
                left_s, node = heappop(order)
                if node not in far:
                    far[node] = left_s
                    for each in self._back.get(node, ()):
                        heappush(order, (left_s + each.takes_s, each.to))
            self._far[goal] = far
        return self._far[goal]


def _reversed(moves: Mapping[Node, list[Move]]) -> Mapping[Node, list[Move]]:
    back: dict[Node, list[Move]] = {}
    for node, there in moves.items():
        for each in there:
            back.setdefault(each.to, []).append(Move(node, each.takes_s))
    return back


def _path_to(
    last: tuple[Node, int], before: Mapping[tuple[Node, int], tuple[Node, int] | None]
) -> list[tuple[Node, int]]:
    path, at = [last], before[last]
    while at is not None:
        path.append(at)
        at = before[at]
    return path[::-1]
