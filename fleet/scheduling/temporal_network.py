"""A simple temporal network (Dechter, Meiri and Pearl 1991): events and bounds between them.

Every constraint says that one event is at least so long after another. Earliest and latest times
are kept while constraints come; a trial can be undone; a conflict names the constraints that
cannot hold together.
"""

from collections import deque
from collections.abc import Hashable
from dataclasses import dataclass
from math import inf
from typing import Generic, TypeVar

from mend.fleet.scheduling.tolerance import TIMING_S

Reason = TypeVar("Reason", bound=Hashable)
"""What a constraint is called in explanations."""

ORIGIN = 0
"""The event at time 0 from which all times count."""


@dataclass(frozen=True)
class Conflict(Generic[Reason]):
    """Constraints that together ask for more time than there is, by `excess_s`."""

    reasons: tuple[Reason, ...]
    excess_s: float


@dataclass(frozen=True, slots=True)
class _Edge(Generic[Reason]):
    """Event `later` is at least `gap_s` after `earlier`."""

    earlier: int
    later: int
    gap_s: float
    reason: Reason


class TemporalNetwork(Generic[Reason]):
    """Events, numbered from 1, with their earliest and latest times in seconds."""

    def __init__(self) -> None:
        self._earliest = [0.0]
        self._latest = [0.0]
        self._out: list[list[_Edge[Reason]]] = [[]]
        self._in: list[list[_Edge[Reason]]] = [[]]
        self._trail: list[tuple[list[float], int, float] | _Edge[Reason] | None] = []

    def __len__(self) -> int:
        return len(self._earliest)

    def add_event(self) -> int:
        """A new event, not before the origin; returns its number."""
        self._trail.append(None)
        self._earliest.append(0.0)
        self._latest.append(inf)
        self._out.append([])
        self._in.append([])
        return len(self._earliest) - 1

    def earliest_s(self, event: int) -> float:
        """The earliest time at which an event can be."""
        return self._earliest[event]

    def latest_s(self, event: int) -> float:
        """The latest time at which an event can be, if all else gives way."""
        return self._latest[event]

    def slack_s(self, event: int) -> float:
        """By how much an event may be late before a constraint breaks."""
        return self._latest[event] - self._earliest[event]

    # --- constraints --------------------------------------------------------------------------

    def after(
        self, later: int, earlier: int, gap_s: float, reason: Reason
    ) -> Conflict[Reason] | None:
        """`later` is at least `gap_s` after `earlier` (negative: may be that much before).

        Returns the conflict when that cannot be; the network is then as it was.
        """
        if gap_s == -inf:
            return None
        if gap_s == inf:
            return Conflict((reason,), inf)
        mark = self.mark()
        edge = _Edge(earlier, later, gap_s, reason)
        self._out[earlier].append(edge)
        self._in[later].append(edge)
        self._trail.append(edge)
        blocked = self._push_earliest(edge)
        if blocked is None:
            self._push_latest(edge)
            return None
        self.undo(mark)
        return self._explain(blocked, edge)

    def not_before(self, event: int, time_s: float, reason: Reason) -> Conflict[Reason] | None:
        """`event` is at `time_s` or later."""
        return self.after(event, ORIGIN, time_s, reason)

    # --- trials -------------------------------------------------------------------------------

    def mark(self) -> int:
        """Where the network stands now, to come back to with `undo`."""
        return len(self._trail)

    def undo(self, mark: int) -> None:
        """Take back every constraint and every event that was added since `mark`."""
        while len(self._trail) > mark:
            entry = self._trail.pop()
            if entry is None:
                for each in (self._earliest, self._latest, self._out, self._in):
                    each.pop()
            elif isinstance(entry, _Edge):
                self._out[entry.earlier].pop()
                self._in[entry.later].pop()
            else:
                times, event, before = entry
                times[event] = before

    def moved_since(self, mark: int) -> dict[int, float]:
        """The events that are later now than at `mark`, with their earliest times then."""
        before: dict[int, float] = {}
        for entry in self._trail[mark:]:
            if isinstance(entry, tuple) and entry[0] is self._earliest:
                before.setdefault(entry[1], entry[2])
        return before

    # --- propagation --------------------------------------------------------------------------

    def _push_earliest(self, edge: _Edge[Reason]) -> list[_Edge[Reason]] | None:
        """Move what must be later now; a way back to where the edge begins is a conflict.

        Returns that way, its last constraint first and `edge` at its end.
        """
        earliest = self._earliest
        if earliest[edge.earlier] + edge.gap_s <= earliest[edge.later] + TIMING_S:
            return None
        cause: dict[int, _Edge[Reason]] = {}
        waiting = deque((edge,))
        while waiting:
            pushing = waiting.popleft()
            time_s = earliest[pushing.earlier] + pushing.gap_s
            if time_s <= earliest[pushing.later] + TIMING_S:
                continue
            if pushing.later in (edge.earlier, ORIGIN):
                way = [pushing]
                while way[-1] is not edge:
                    way.append(cause[way[-1].earlier])
                return way
            cause[pushing.later] = pushing
            self._set(earliest, pushing.later, time_s)
            waiting.extend(self._out[pushing.later])
        return None

    def _push_latest(self, edge: _Edge[Reason]) -> None:
        latest = self._latest
        waiting = deque((edge,))
        while waiting:
            pulling = waiting.popleft()
            time_s = latest[pulling.later] - pulling.gap_s
            if time_s >= latest[pulling.earlier] - TIMING_S or pulling.earlier == ORIGIN:
                continue
            self._set(latest, pulling.earlier, time_s)
            waiting.extend(self._in[pulling.earlier])

    def _set(self, times: list[float], event: int, time_s: float) -> None:
        self._trail.append((times, event, times[event]))
        times[event] = time_s

    def _explain(self, way: list[_Edge[Reason]], added: _Edge[Reason]) -> Conflict[Reason]:
        """Name the constraints of a way that leads from `added` to what cannot move.

        When that is the origin, what holds the begin of `added` belongs to the conflict too.
        """
        if way[0].later == ORIGIN and added.earlier != ORIGIN:
            way = way + self._tight_way_to(added.earlier)
        reasons = dict.fromkeys(edge.reason for edge in reversed(way))
        return Conflict(tuple(reasons), sum(edge.gap_s for edge in way))

    def _tight_way_to(self, event: int) -> list[_Edge[Reason]]:
        """The chain of constraints that makes an event as early as it can be, latest first.

        It ends at the origin, or at an event that nothing but the origin holds at time 0.
        """
        next_edge: dict[int, _Edge[Reason] | None] = {event: None}
        waiting = deque((event,))
        while waiting and ORIGIN not in next_edge:
            here = waiting.popleft()
            for edge in self._in[here]:
                gap_s = self._earliest[here] - self._earliest[edge.earlier]
                if edge.earlier not in next_edge and abs(gap_s - edge.gap_s) <= 10 * TIMING_S:
                    next_edge[edge.earlier] = edge
                    waiting.append(edge.earlier)
        if ORIGIN in next_edge:
            return self._follow(next_edge, ORIGIN)
        return self._follow(next_edge, next(each for each in next_edge if not self._earliest[each]))

    @staticmethod
    def _follow(next_edge: dict[int, _Edge[Reason] | None], event: int) -> list[_Edge[Reason]]:
        way: list[_Edge[Reason]] = []
        edge = next_edge[event]
        while edge is not None:
            way.append(edge)
            edge = next_edge[edge.later]
        return way[::-1]
