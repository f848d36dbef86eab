"""What happens in a shift, as lines on a terminal."""

from collections.abc import Collection
from math import inf
from uuid import UUID

import typer

from mend.fleet.requests import STATUS, RequestStatus
from mend.server.journal import events as ev
from mend.server.transcript import Transcript
from mend.server.transcript_line import Tone
from mend.server.transcript_words import told_deed

_TOLD = (Tone.FAULT, Tone.SAID, Tone.ASKED, Tone.ANSWERED, Tone.DEED, Tone.SETBACK)
"""Of what robots do in their legs only what is said, and why, is told."""
_WRONG_FLOOR = "wrong_floor"


class ShiftTranscript:
    """Prints what is journaled, by the site's clock, and keeps what became of each request."""

    def __init__(self, asked: Collection[str]) -> None:
        """`asked`: the names of the requests that whoever follows the shift makes."""
        self._asked = frozenset(asked)
        self.open: set[str] = set()
        self.ended: dict[str, str] = {}
        self._transcripts: dict[UUID, tuple[Transcript, float]] = {}
        self._now_s = 0.0
        self._wrong_floors: list[tuple[float, str]] = []
        self._legs: list[ev.LegBegun] = []
        self._ended_s: dict[tuple[str, int], float] = {}

    def booked(self, request: str) -> None:
        """A request has been made, and is not over."""
        if request not in self.ended:
            self.open.add(request)

    def refused(self, request: str, reason: str, at_s: float) -> None:
        """A request cannot be met, it is found at a moment of the site's clock."""
        self.say(f"refused: {reason}", at_s)
        self.open.discard(request)
        self.ended[request] = RequestStatus.REFUSED

    def tell(self, event: ev.Event) -> None:
        """Print what an event says to whoever follows the shift."""
        match event:
            case ev.RequestChanged():
                self._tell_of_request(event)
            case ev.PlanChanged():
                others = f" ({', '.join(event.requests)})" if event.requests else ""
                self.say(f"plan {event.number}: {event.reason}{others}", event.at_s)
            case ev.FleetTold():
                self.say(f"{event.finder or 'operator'} {event.told}", event.at_s)
            case ev.SiteIntervention():
                self.say(f"  person ({event.by}): {told_deed(event)}", event.at_s)
            case ev.LegBegun():
                self._legs.append(event)
            case ev.LegEnded():
                self._ended_s[event.robot, event.number] = event.at_s
            case ev.RunStarted():
                since_s = self._now_s if event.at_s is None else event.at_s
                self._transcripts[event.run] = Transcript(), since_s
                does = event.tree_name.replace("_", " ")
                self.say(f"{event.robots[0]} begins to {does}", since_s)
            case _ if event.run in self._transcripts:
                self._tell_of_run(event, *self._transcripts[event.run])

    def was_at_wrong_floor(self, elevator: str, since_s: float) -> bool:
        """Whether a robot has said since then that an elevator had taken it to a wrong floor."""
        return any(
            at_s >= since_s and told.startswith(f"{elevator} ") for at_s, told in self._wrong_floors
        )

    def why_nobody_was_silent(self, from_s: float, until_s: float) -> str | None:
        """Why nobody left a question unanswered who was to until then: no leg began, as robots were
        at others, or had nothing to do. None where one began."""
        if any(from_s <= leg.at_s <= until_s for leg in self._legs):
            return None
        at_work = [
            f"{leg.robot} was at '{leg.booking}' at {leg.place} since {leg.at_s:.0f} s"
            for leg in self._legs
            if leg.at_s < from_s and self._ended_s.get((leg.robot, leg.number), inf) >= from_s
        ]
        span = f"from {from_s:g} to {until_s:g} s" if until_s < inf else f"from {from_s:g} s on"
        why = ", ".join(at_work) or "no robot was at anything"
        return f"nobody left a question unanswered {span}, as no leg began then: {why}"

    def sum_up(self) -> bool:
        """Say what the shift came to; whether everything was done, or not wanted any more."""
        counts = {
            status: sum(each == status for each in self.ended.values())
            for status in (
                RequestStatus.DONE,
                RequestStatus.CANCELLED,
                RequestStatus.REFUSED,
                RequestStatus.FAILED,
            )
        }
        told = [f"{n} {status}" for status, n in counts.items() if n]
        self.say(f"of {len(self.ended)} requests: {', '.join(told)}")
        return not counts[RequestStatus.REFUSED] and not counts[RequestStatus.FAILED]

    def say(self, text: str, at_s: float = 0.0) -> None:
        """Print a line, with the site's clock before it: `at_s`, or of the last line if later."""
        self._now_s = max(self._now_s, at_s)
        typer.echo(f"{self._now_s:8.1f}  {text}")

    # --- Within -------------------------------------------------------------------------------

    def _tell_of_request(self, event: ev.RequestChanged) -> None:
        if event.status == RequestStatus.REFUSED and event.request in self._asked:
            # Whoever asked is answered with more than that.
            return
        by = f" by {event.robot}" if event.robot else ""
        due = f", expected at {event.done_s:.0f} s" if event.done_s is not None else ""
        why = f": {event.reason}" if event.reason else ""
        status = event.status.replace("_", " ")
        self.say(f"'{event.request}' is {status}{by}{due}{why}", event.at_s)
        if STATUS.is_last(RequestStatus(event.status)):
            self.open.discard(event.request)
            self.ended[event.request] = event.status
        else:
            # One that recurs is asked for again by itself.
            self.open.add(event.request)

    def _tell_of_run(self, event: ev.Event, transcript: Transcript, since_s: float) -> None:
        if isinstance(event, ev.IssueRaised) and event.issue == _WRONG_FLOOR and event.detection:
            self._wrong_floors.append((since_s + event.time, event.detection.explanation))
        for line in transcript.lines(event):
            if line.tone in _TOLD:
                by = f"{line.speaker}: " if line.speaker else ""
                self.say(f"  {by}{line.text}", since_s + line.time_s)
