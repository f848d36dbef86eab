"""How the time of a leg was spent: each of its seconds in one class, by what was journaled.

The first five classes are those of Veloso et al. (2015), Figure 7.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import groupby

from mend.fleet.requests import LegAction
from mend.robots.execution.phase import Phase
from mend.server.fleets.leg_task import LegStage
from mend.server.journal import events as ev
from mend.server.report.fleet_history import LegRecord


class TimeUse(StrEnum):
    """What a robot was about, and how a report calls it."""

    START = "help at the start"
    ELEVATOR = "elevator"
    NAVIGATION = "navigation"
    BLOCKED = "blocked"
    END = "help at the end"
    TRANSFER = "changing robots"
    HELP = "other help"
    WAITING = "staying or waiting"
    OTHER = "other"
    UNKNOWN = "not journaled"


@dataclass(frozen=True, slots=True)
class Stretch:
    """Seconds that were spent on one thing."""

    begin_s: float
    end_s: float
    use: TimeUse


ON_THE_WAY = {
    "blocked": TimeUse.BLOCKED,
    "door_closed": TimeUse.BLOCKED,
    "elevator_help": TimeUse.ELEVATOR,
    "wrong_floor": TimeUse.ELEVATOR,
    "lost": TimeUse.HELP,
    "low_battery": TimeUse.HELP,
}
"""What asking people about an issue of a way counts as. All others come with the step they
interrupt."""

_AT_PLACE: Mapping[str, TimeUse] = {
    LegAction.COLLECT: TimeUse.START,
    LegAction.MEET: TimeUse.START,
    LegAction.GIVE: TimeUse.TRANSFER,
    LegAction.TAKE: TimeUse.TRANSFER,
    LegAction.HAND_OVER: TimeUse.END,
    LegAction.BRING_BACK: TimeUse.END,
    LegAction.DELIVER_MESSAGE: TimeUse.END,
    LegAction.ESCORT: TimeUse.END,
}
_MOVES: Mapping[str, TimeUse] = {
    Phase.TRAVEL: TimeUse.NAVIGATION,
    Phase.CARRY: TimeUse.NAVIGATION,
    Phase.RIDE: TimeUse.ELEVATOR,
}
_STANDS = (Phase.LOAD, Phase.UNLOAD, Phase.TELL)
_HANDING = ("item_not_given", "item_not_taken", "nobody_answers")


def time_split(leg: LegRecord) -> dict[TimeUse, float]:
    """Seconds by class of a leg that has ended; they add up to how long it took.

    What the robot itself counted of standing before something, without asking anybody, is taken
    from its navigation.
    """
    split = dict.fromkeys(TimeUse, 0.0)
    for each in stretches_of(leg):
        split[each.use] += each.end_s - each.begin_s
    counted_s = None if leg.ended is None else leg.ended.barred_s
    barred_s = min(counted_s or 0.0, split[TimeUse.NAVIGATION])
    split[TimeUse.NAVIGATION] -= barred_s
    split[TimeUse.BLOCKED] += barred_s
    return split


def stretches_of(leg: LegRecord, until_s: float = 0.0) -> list[Stretch]:
    """A leg by the site's clock, without gaps, from its begin to its end.

    A leg that has not ended lasts `until_s`. A run has a clock of its own, which goes as the site's
    does: the first run began with the leg, and a second one ended with it.
    """
    begin_s = leg.begun.at_s
    end_s = max(begin_s, until_s if leg.ended is None else leg.ended.at_s)
    runs = [(stage, leg.runs[stage]) for stage in LegStage if stage in leg.runs]
    at_s, parts = begin_s, list[Stretch]()
    for _, events in runs:
        run = list(_run_stretches(events, leg.begun.action))
        shift_s = end_s - run[-1].end_s if parts else begin_s - run[0].begin_s
        for each in run:
            since_s = min(max(each.begin_s + shift_s, at_s), end_s)
            at_s = min(max(each.end_s + shift_s, since_s), end_s)
            parts.append(Stretch(since_s, at_s, each.use))
    whole = list(_without_gaps(parts, begin_s, end_s, _between_runs(runs)))
    return [
        Stretch(same[0].begin_s, same[-1].end_s, use)
        for use, same in ((use, list(each)) for use, each in groupby(whole, lambda e: e.use))
    ]


def metres_of(legs: Iterable[LegRecord]) -> float | None:
    """How far robots drove in those legs of which that is known; None where it is of none."""
    known = [each.ended.driven_m for each in legs if each.ended is not None]
    metres = [each for each in known if each is not None]
    return sum(metres) if metres else None


def whole_metres_of(legs: Iterable[LegRecord]) -> float | None:
    """How far robots drove in those legs that have ended; None unless that is known of each."""
    ended = [each for each in legs if each.ended is not None]
    return metres_of(ended) if all(metres_of([each]) is not None for each in ended) else None


def _between_runs(runs: Sequence[tuple[LegStage, Sequence[ev.Event]]]) -> TimeUse:
    """What a robot does while no run has it: it is there and waits, or nothing is known."""
    if not runs:
        return TimeUse.UNKNOWN
    if any(isinstance(each, ev.RunAborted) for _, events in runs for each in events):
        # What a robot does whose run was broken off is no run's to journal.
        return TimeUse.UNKNOWN
    stage, events = runs[0]
    came = stage is LegStage.GO and any(isinstance(each, ev.RunFinished) for each in events)
    return TimeUse.WAITING if came else TimeUse.OTHER


def _without_gaps(
    parts: Sequence[Stretch], begin_s: float, end_s: float, between: TimeUse
) -> Iterator[Stretch]:
    at_s = begin_s
    for each in [*parts, Stretch(end_s, end_s, between)]:
        if each.begin_s > at_s:
            yield Stretch(at_s, each.begin_s, between)
        if each.end_s > each.begin_s:
            yield each
        at_s = max(at_s, each.end_s)


def _run_stretches(events: Sequence[ev.Event], action: str) -> Iterator[Stretch]:
    """By the run's clock, from its first event to its last."""
    reader, at_s = _RunReader(action), events[0].time
    for event in events:
        # A clock that was set back tells no time.
        yield Stretch(at_s, max(at_s, event.time), reader.use)
        at_s = max(at_s, event.time)
        reader.take(event)


class _RunReader:
    """What a robot is about, event after event."""

    def __init__(self, action: str) -> None:
        self._at_place = _AT_PLACE.get(action, TimeUse.WAITING)
        self._step: ev.StepStarted | None = None
        self._issue: str | None = None
        self._sets_out = False
        self._gone = False

    @property
    def use(self) -> TimeUse:
        if self._gone:
            return TimeUse.OTHER
        if not self._sets_out:
            # It is told to as soon as nobody else has the place where it is to go.
            return TimeUse.WAITING
        if self._issue in ON_THE_WAY:
            return ON_THE_WAY[self._issue]
        phase = None if self._step is None else self._step.phase
        if phase in _STANDS or self._issue in _HANDING:
            return self._at_place
        if self._issue is not None:
            return TimeUse.HELP
        if self._step is None:
            return TimeUse.OTHER
        return TimeUse.UNKNOWN if phase is None else _MOVES.get(phase, TimeUse.OTHER)

    def take(self, event: ev.Event) -> None:
        """Something has happened."""
        match event:
            case ev.StepStarted():
                self._step, self._issue, self._sets_out = event, None, True
            case ev.IssueRaised(interrupts=True, issue=issue):
                self._issue = issue
            case ev.RobotResumed():
                self._issue = None
            case ev.NodeStarted():
                self._step, self._issue, self._sets_out = None, None, True
            case ev.NodeDone() | ev.NodeReset() | ev.NodeLeftOut():
                self._step = self._issue = None
            case ev.RobotLost():
                self._gone = True
            case ev.RobotBack():
                self._gone = False
