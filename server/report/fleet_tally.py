"""What became of what people of a building asked, counted from the events of one site."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from mend.fleet.requests import STATUS, RequestStatus
from mend.server.journal import events as ev


@dataclass(frozen=True, slots=True)
class Table:
    """One table of a report; `note` says what its figures were counted over."""

    name: str
    title: str
    note: str
    columns: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]


@dataclass(slots=True)
class _Legs:
    """The legs of one robot; times in seconds of the site's clock."""

    ended: int = 0
    done: int = 0
    busy_s: float = 0.0
    open: ev.LegBegun | None = None


@dataclass(slots=True)
class FleetTally:
    """A fleet's requests, legs and changes of plan, up to `until_s` of the site's clock."""

    requests: dict[str, ev.RequestChanged] = field(default_factory=dict)
    floors: dict[str, set[str]] = field(default_factory=dict)
    robots: dict[str, _Legs] = field(default_factory=dict)
    changes: list[ev.PlanChanged] = field(default_factory=list)
    until_s: float = 0.0

    @classmethod
    def of(cls, events: Iterable[ev.FleetEvent]) -> "FleetTally":
        """What the events of a site's fleet, in order, tell."""
        tally = cls()
        for event in events:
            tally._take(event)
        return tally

    def _take(self, event: ev.FleetEvent) -> None:
        self.until_s = max(self.until_s, event.at_s)
        match event:
            case ev.RequestChanged():
                self.requests[event.request] = event
            case ev.PlanChanged():
                self.changes.append(event)
            case ev.LegBegun():
                self.robots.setdefault(event.robot, _Legs()).open = event
                floors = self.floors.setdefault(event.booking, set())
                floors |= {_floor(event.start), _floor(event.place)}
            case ev.LegEnded():
                self._end(event)

    def _end(self, event: ev.LegEnded) -> None:
        legs = self.robots.setdefault(event.robot, _Legs())
        legs.ended += 1
        legs.done += event.outcome == "done"
        if legs.open is not None and legs.open.number == event.number:
            legs.busy_s += event.at_s - legs.open.at_s
            legs.open = None

    def tables(self) -> list[Table]:
        """Requests by kind and floors, legs by robot, and why plans changed."""
        return [self._by_kind(), self._by_robot(), self._why()]

    def _by_kind(self) -> Table:
        rows = []
        for kind in sorted({each.what["kind"] for each in self.requests.values()}):
            mine = [each for each in self.requests.values() if each.what["kind"] == kind]
            floors = [len(self.floors.get(each.request, ())) for each in mine]
            states = [RequestStatus(each.status) for each in mine]
            counts = (
                len(mine),
                sum(each == 1 for each in floors),
                sum(each > 1 for each in floors),
                states.count(RequestStatus.DONE),
                sum(STATUS.is_last(each) and each is not RequestStatus.DONE for each in states),
                sum(not STATUS.is_last(each) for each in states),
            )
            rows.append((kind.replace("_", " "), *map(str, counts)))
        note = (
            "Floors are those where legs began and led to; a request without a leg in the journal "
            "is on none."
        )
        heads = ("kind", "asked", "one floor", "several floors", "done", "not done", "open")
        return Table("requests", "Requests", note, heads, rows)

    def _by_robot(self) -> Table:
        rows = []
        for robot, legs in sorted(self.robots.items()):
            busy_s = legs.busy_s + (self.until_s - legs.open.at_s if legs.open else 0.0)
            share = f"{100 * busy_s / self.until_s:.0f} %" if self.until_s else "-"
            rows.append((robot, str(legs.ended), str(legs.done), f"{busy_s / 60:.1f}", share))
        note = (
            f"Of {self.until_s / 60:.1f} min of the site's clock, up to the last event of its "
            "fleet. Busy is from a leg's begin to its end, waiting at its place too."
        )
        heads = ("robot", "legs ended", "legs done", "busy, min", "busy, share")
        return Table("robots", "Robots", note, heads, rows)

    def _why(self) -> Table:
        rows = [
            (f"{each.at_s:.1f}", each.reason, ", ".join(each.requests), ", ".join(each.robots))
            for each in self.changes
        ]
        heads = ("at, s", "why", "requests", "robots")
        return Table("plans", "Why plans changed", "Each change of the plan.", heads, rows)


def _floor(place: str) -> str:
    return place.split("/", 1)[0]
