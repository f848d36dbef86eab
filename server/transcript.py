"""The transcript of a run: each event as the lines that a person reads."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from functools import singledispatchmethod
from typing import Literal, Protocol
from uuid import UUID

from mend.dialogue.evidence import Change
from mend.dialogue.script import CloseReason, Help
from mend.server.access.principal import RESERVED
from mend.server.journal import events as ev
from mend.tasks.intervention import Act, Intervention
from mend.tasks.resolution import Resolution


class Tone(StrEnum):
    """What kind of news a line brings; a terminal or a page gives each its own look."""

    RUN = "run"
    CHOICE = "choice"
    STEP = "step"
    FAULT = "fault"
    SAID = "said"
    ASKED = "asked"
    ANSWERED = "answered"
    WATCHED = "watched"
    DEED = "deed"
    RESOLVED = "resolved"
    DONE = "done"
    SETBACK = "setback"
    FINISHED = "finished"
    FAILED = "failed"


SPOKEN = frozenset({Tone.SAID, Tone.ASKED, Tone.ANSWERED, Tone.STEP})
"""The tones of lines that quote their speaker; a behavior speaks through its steps."""


@dataclass(frozen=True, slots=True)
class Line:
    """One line: when (seconds of the run's clock), who acts or speaks (if anybody), what.

    Lines that follow each other with the same `thread` may be joined to one; None is never joined.
    """

    time_s: float
    speaker: str
    text: str
    tone: Tone
    thread: str | None = None

    @property
    def opening(self) -> str:
        """What stands before the text: `robot: ` before what is said, `robot ` before deeds."""
        if not self.speaker:
            return ""
        return f"{self.speaker}: " if self.tone in SPOKEN else f"{self.speaker} "


DEEDS: dict[Act, str] = {
    Act.STEAL: "takes {object} away",
    Act.PUT_BACK: "puts {object} back",
    Act.PLACE: "puts {object} to its place",
    Act.HAND_OVER: "hands {object} over",
    Act.MOVE: "moves {object}",
    Act.BLOCK: "stands in the robot's way",
    Act.RELEASE: "clears the robot's way",
    Act.COVER: "covers the head camera",
    Act.UNCOVER: "clears the head camera's view",
    Act.PUT_IN: "puts {object} into the robot's basket",
    Act.TAKE_OUT: "takes {object} out of the robot's basket",
    Act.CHARGE: "plugs the robot in",
    Act.BAR: "bars the way between {between}",
    Act.CLEAR: "clears the way between {between}",
    Act.SEND_PERSON: "tells who is to follow a robot to come",
    Act.MISDIRECT: "presses a wrong button in {elevator}",
}

PROMISES: dict[Help, str] = {
    Help.PLACE: "{object} at its place",
    Help.PUT_BACK: "{object} back within reach",
    Help.HAND_OVER: "{object} between the fingers",
    Help.CLEAR_WAY: "the way clear",
    Help.CLEAR_VIEW: "the table again",
    Help.TELL_PLACE: "that it is where it was told",
    Help.PUT_IN: "something put into its basket",
    Help.TAKE_OUT: "something taken out of its basket",
    Help.CHARGE: "current",
    Help.SEND_PERSON: "who is to follow it beside it",
}

_FELT = (Help.PUT_IN, Help.TAKE_OUT, Help.CHARGE)
"""Help that no camera sees."""

RESOLUTIONS: dict[Resolution, str] = {
    Resolution.HUMAN_FINISH: "the human finished {name}",
    Resolution.ROBOT_FINISH: "the robot goes on with {name}",
    Resolution.COLLAB_FINISH: "both finish {name} together",
    Resolution.ROBOT_RETRY: "the robot tries {name} again, if an attempt is left",
}

CLOSINGS: dict[CloseReason, str] = {
    CloseReason.WITHDRAWN: "the question is withdrawn: by what the robot sees it is put right",
    CloseReason.GAVE_UP: "the question is given up: no help was seen",
    CloseReason.ABORTED: "the question lapses: it no longer matters",
}

DOERS: dict[ev.DoneBy, str] = {
    "robot": " by the robot",
    "human": " by the human",
    "both": " by robot and human together",
    "found": ": the robot found it in place",
}

CHANGES: dict[Change, str] = {
    Change.UNKNOWN: "",
    Change.NONE: ", as it was before",
    Change.APPEARED: ": it has come back",
    Change.MOVED: ": it has been moved",
    Change.HANDED_OVER: "",
    Change.CLEARED: "",
    Change.LOADED: "",
    Change.UNLOADED: "",
    Change.CHARGED: "",
    Change.TOLD: "",
    Change.LED_ROUND: "",
    Change.CAME: "",
}


def grouped(lines: Iterable[Line]) -> Iterator[list[Line]]:
    """The lines in the groups in which they may be joined, most of them of one line."""
    group: list[Line] = []
    for line in lines:
        if group and (line.thread is None or line.thread != group[-1].thread):
            yield group
            group = []
        group.append(line)
    if group:
        yield group


def by(author: ev.Author | None) -> str:
    """Who did something, after what they did; nothing where they have no name."""
    return "" if author is None or author.principal in RESERVED else f" by {author.principal}"


def why_aborted(event: ev.RunAborted) -> str:
    """Why a run was aborted, or by whom."""
    return event.reason or by(event.author).strip() or "by a person"


class Transcript:
    """Turns the events of one run, in order, into lines.

    It remembers one thing: whether the run has several robots, which are then called by their ids;
    the first event says so, or whoever begins later.
    """

    def __init__(self, *, several_robots: bool = False) -> None:
        self._several_robots = several_robots

    @singledispatchmethod
    def lines(self, event: ev.Event) -> list[Line]:
        """The lines of an event; none for those that others already tell."""
        raise TypeError(f"expected an event of the journal, got {type(event).__name__}")

    def _robot(self, robot: str | None) -> str:
        return robot if robot is not None and self._several_robots else "robot"

    # --- The run ------------------------------------------------------------------------------

    @lines.register
    def _(self, event: ev.RunStarted) -> list[Line]:
        self._several_robots = len(event.robots) > 1
        return [_line(event, "", told_start(event.run, event.tree_name, event), Tone.RUN)]

    @lines.register
    def _(self, event: ev.RunPaused) -> list[Line]:
        return [_line(event, "", f"the run is paused{by(event.author)}", Tone.RUN)]

    @lines.register
    def _(self, event: ev.RunResumed) -> list[Line]:
        return [_line(event, "", f"the run goes on{by(event.author)}", Tone.RUN)]

    @lines.register
    def _(self, event: ev.RunFinished) -> list[Line]:
        lines = [_line(event, "", told_missing(each), Tone.SETBACK) for each in event.missing]
        text = f"the run has finished: {finished_text(event.missing, event.unseen)}"
        return [*lines, _line(event, "", text, Tone.FINISHED)]

    @lines.register
    def _(self, event: ev.RunFailed) -> list[Line]:
        return [_line(event, "", f"the run has failed: {event.reason}", Tone.FAILED)]

    @lines.register
    def _(self, event: ev.RunAborted) -> list[Line]:
        return [_line(event, "", f"the run was aborted: {why_aborted(event)}", Tone.FAILED)]

    @lines.register
    def _(
        self,
        _event: ev.DocumentKept
        | ev.DocumentDeleted
        | ev.SignedIn
        | ev.SignInFailed
        | ev.SignedOut
        | ev.AccessChanged
        | ev.SiteOpened
        | ev.SiteGivenBack
        | ev.SiteRestarted
        | ev.SiteClosed
        | ev.RequestChanged
        | ev.PlanChanged
        | ev.FleetTold
        | ev.LegBegun
        | ev.LegEnded
        | ev.ErrandBegun
        | ev.ErrandEnded,
    ) -> list[Line]:
        return []  # It belongs to no run.

    # --- The leaves ---------------------------------------------------------------------------

    @lines.register
    def _(self, event: ev.NodeStarted) -> list[Line]:
        attempt = f", attempt {event.attempt}" if event.attempt > 1 else ""
        text = f"starts {event.name}{attempt}{_comparison(event)}"
        return [_line(event, self._robot(event.robot), text, Tone.CHOICE)]

    @lines.register
    def _(self, event: ev.NodeTaken) -> list[Line]:
        return [_line(event, event.helper, f"has taken {event.name}, to do it", Tone.CHOICE)]

    @lines.register
    def _(self, event: ev.StepStarted) -> list[Line]:
        text = f"{event.step} {event.step_name.replace('_', ' ')}"
        return [Line(event.time, event.name, text, Tone.STEP, thread=str(event.execution))]

    @lines.register
    def _(self, event: ev.NodeDone) -> list[Line]:
        return [_line(event, "", f"{event.name} is done{DOERS[event.by]}", Tone.DONE)]

    @lines.register
    def _(self, event: ev.NodeReset) -> list[Line]:
        failed = ", a failed attempt" if event.failed_attempt else ""
        text = f"{event.name} is put back{failed}: {event.reason}"
        return [_line(event, "", text, Tone.SETBACK)]

    @lines.register
    def _(self, event: ev.NodeUndone) -> list[Line]:
        return [_line(event, "", f"{event.name} is done no longer: {event.reason}", Tone.SETBACK)]

    @lines.register
    def _(self, event: ev.NodeLeftOut) -> list[Line]:
        text = f"{event.name} is left out, as {event.helper} said"
        return [_line(event, "", text, Tone.SETBACK)]

    @lines.register
    def _(self, event: ev.NodeReturned) -> list[Line]:
        text = f"sees {event.name}, which was left out, at its place"
        return [_line(event, self._robot(event.robot), text, Tone.DONE)]

    @lines.register
    def _(self, event: ev.NodeAbandoned) -> list[Line]:
        text = f"the alternative {event.name} is abandoned: {event.reason}"
        return [_line(event, "", text, Tone.SETBACK)]

    # --- Issues and dialogues -----------------------------------------------------------------

    @lines.register
    def _(self, event: ev.IssueRaised) -> list[Line]:
        where = f"in step {event.step}" if event.step else "while it looks and plans"
        subject = event.object or event.name
        explanation = event.detection.explanation if event.detection else ""
        because = f" ({explanation})" if explanation else ""
        text = f"issue: {event.issue} {subject} {where}{because}"
        return [_line(event, "", text, Tone.FAULT)]

    @lines.register
    def _(self, event: ev.SuspectedFalseAlarm) -> list[Line]:
        subject = event.object or event.name
        told = f"; a mail goes to {', '.join(event.told)}" if event.told else ""
        text = (
            f"the robot may be wrong: {event.issue} {subject} {event.times} times on end, and "
            f"nothing was seen to change{told}"
        )
        return [_line(event, "", text, Tone.SETBACK)]

    @lines.register
    def _(self, _event: ev.FirstLook) -> list[Line]:
        return []

    @lines.register
    def _(self, _event: ev.LookedAnew) -> list[Line]:
        return []

    @lines.register
    def _(self, _event: ev.ClipRecorded) -> list[Line]:
        return []

    @lines.register
    def _(self, _event: ev.DialogueOpened) -> list[Line]:
        return []

    @lines.register
    def _(self, event: ev.Prompt) -> list[Line]:
        again = " (asked again)" if event.version > 1 else ""
        to = f" (to {event.to})" if event.to else ""
        tone = Tone.ASKED if event.kind == "ask" else Tone.SAID
        return [_line(event, self._robot(event.robot), f"{event.text}{again}{to}", tone)]

    @lines.register
    def _(self, event: ev.Claimed) -> list[Line]:
        return [_line(event, f"helper ({event.helper})", "is on it", Tone.WATCHED)]

    @lines.register
    def _(self, event: ev.Released) -> list[Line]:
        text = "has been silent too long, anybody may answer" if event.expired else "lets it go"
        return [_line(event, f"helper ({event.helper})", text, Tone.WATCHED)]

    @lines.register
    def _(self, event: ev.Answered) -> list[Line]:
        return [_line(event, f"helper ({event.helper})", event.answer, Tone.ANSWERED)]

    @lines.register
    def _(self, event: ev.DeadlineExtended) -> list[Line]:
        text = f"asks for more time, until {event.deadline:.1f} s"
        return [_line(event, f"helper ({event.helper})", text, Tone.WATCHED)]

    @lines.register
    def _(self, event: ev.Escalated) -> list[Line]:
        how = "a mail goes to" if event.channel == "mail" else "the question goes to"
        return [_line(event, "", f"nobody answered: {how} {event.to}", Tone.SETBACK)]

    @lines.register
    def _(self, event: ev.HelpAwaited) -> list[Line]:
        how = "waits to feel" if event.help in _FELT else "looks for"
        text = f"{how} {_promised(event)} until {event.until:.1f} s"
        return [_line(event, self._robot(event.robot), text, Tone.WATCHED)]

    @lines.register
    def _(self, event: ev.HelpVerified) -> list[Line]:
        how = "feels" if event.help in _FELT else "sees"
        text = f"{how} {_promised(event)}{CHANGES[event.change]}"
        if event.change is Change.LED_ROUND:
            text = "sees that another way leads round"
        return [_line(event, self._robot(event.robot), text, Tone.WATCHED)]

    @lines.register
    def _(self, event: ev.HelpNotSeen) -> list[Line]:
        how = "feel" if event.help in _FELT else "see"
        why = f": {event.blind}" if event.blind else ""
        text = f"does not {how} {_promised(event)}{why}"
        return [_line(event, self._robot(event.robot), text, Tone.SETBACK)]

    @lines.register
    def _(self, event: ev.Resolved) -> list[Line]:
        meaning = RESOLUTIONS[event.resolution].format(name=event.name)
        text = f"resolved by {event.resolution}: {meaning}"
        return [_line(event, "", text, Tone.RESOLVED)]

    @lines.register
    def _(self, event: ev.DialogueClosed) -> list[Line]:
        if event.reason not in CLOSINGS:
            return []
        return [_line(event, "", CLOSINGS[event.reason], Tone.SETBACK)]

    @lines.register
    def _(self, _event: ev.InterventionAccepted) -> list[Line]:
        return []

    @lines.register
    def _(self, event: ev.InterventionDone) -> list[Line]:
        text = deed_text(event.intervention)
        if not event.ok:
            text = f"{text}: in vain, {event.detail}"
        return [_line(event, f"person ({event.by})", text, Tone.DEED)]

    # --- Robots -------------------------------------------------------------------------------

    @lines.register
    def _(self, event: ev.RobotLost) -> list[Line]:
        return [_line(event, self._robot(event.robot), f"is lost: {event.reason}", Tone.SETBACK)]

    @lines.register
    def _(self, event: ev.RobotBack) -> list[Line]:
        how = "goes on where it was" if event.continues else "begins anew"
        return [_line(event, self._robot(event.robot), f"is back and {how}", Tone.RUN)]

    @lines.register
    def _(self, event: ev.RobotHolding) -> list[Line]:
        where = {"in_place": "where it is", "hand_over": "where a person can reach it"}
        text = f"stops and holds {where.get(event.at, f'at {event.at}')}"
        return [_line(event, self._robot(event.robot), text, Tone.WATCHED)]

    @lines.register
    def _(self, event: ev.RobotResumed) -> list[Line]:
        text = f"moves again, at step {event.step}"
        return [_line(event, self._robot(event.robot), text, Tone.WATCHED)]

    @lines.register
    def _(self, event: ev.WayFound) -> list[Line]:
        finding, way = event.finding.replace("_", " "), " and ".join(event.between)
        then = "" if event.finding == "open" else "; it goes round"
        text = f"found the way between {way}: {finding}{then}"
        return [_line(event, self._robot(event.robot), text, Tone.WATCHED)]


class StartedRun(Protocol):
    """How a run was begun."""

    @property
    def world(self) -> str: ...

    @property
    def seed(self) -> int: ...

    @property
    def speed(self) -> float | Literal["max"]: ...

    @property
    def scenario(self) -> str | None: ...


def told_start(run: UUID, tree: str, started: StartedRun) -> str:
    """That a run begins, of which tree, and how."""
    scenario = f", scenario {started.scenario}" if started.scenario else ""
    speed = started.speed if started.speed == "max" else f"{started.speed:g}"
    return (
        f"run {run} of {tree} begins in {started.world} "
        f"(seed {started.seed}, speed {speed}{scenario})"
    )


def deed_text(intervention: Intervention) -> str:
    """What a person does, as the end of a sentence that begins with who it is."""
    text = DEEDS[intervention.act].format(
        object=intervention.object or "something",
        between=" and ".join(intervention.between or ()),
        elevator=intervention.elevator,
    )
    if intervention.act is Act.STEAL and intervention.manner == "pull":
        text = f"pulls {intervention.object} out of the gripper"
    if intervention.act is Act.RELEASE and intervention.object and intervention.place is None:
        text = f"puts {intervention.object} aside"
    return text


def finished_text(missing: Sequence[ev.MissingPart], unseen: Sequence[ev.UnseenPart] = ()) -> str:
    """What a finished run came to: what was left out, and what nobody can see now."""
    hidden = joined([each.object for each in unseen])
    return _without(missing) + (
        f"; the last look could not tell whether {hidden} stayed there" if hidden else ""
    )


def _without(missing: Sequence[ev.MissingPart]) -> str:
    if not missing:
        return "the task is done"
    said: dict[str | None, list[str]] = {}
    for each in missing:
        said.setdefault(each.left_out_by, []).append(each.object)
    parts = (
        f"without {joined(list(dict.fromkeys(objects)))}{_as_said(by)}"
        for by, objects in said.items()
    )
    return f"the task is done {joined(list(parts))}"


def told_missing(part: ev.MissingPart) -> str:
    """That a part is not at its place at the end, and who said to go on without it."""
    if part.nowhere:
        return f"{part.name} was left out{_as_said(part.left_out_by)}"
    return f"{part.object} is not at {part.place}{_as_said(part.left_out_by)}"


def _as_said(by: str | None) -> str:
    return "" if by is None else f", as {by} said"


def joined(words: Sequence[str]) -> str:
    """The words as an enumeration: `a, b and c`."""
    return " and ".join(filter(None, (", ".join(words[:-1]), *words[-1:])))


def _line(event: ev.Event, speaker: str, text: str, tone: Tone) -> Line:
    return Line(event.time, speaker, text, tone)


def _comparison(event: ev.NodeStarted) -> str:
    """The potential of the chosen leaf against the best of the others; nothing without a choice."""
    chosen = next((each for each in event.candidates if each.node == event.node), None)
    others = [each for each in event.candidates if each.node != event.node]
    if chosen is None or not others:
        return ""
    rivals = ", ".join(_rival(each) for each in others[:3])
    more = f" and {len(others) - 3} more" if len(others) > 3 else ""
    return f" (potential {chosen.potential:.2f}, before {rivals}{more})"


def _rival(candidate: ev.Candidate) -> str:
    failed = f" after {candidate.attempts} failed" if candidate.attempts else ""
    return f"{candidate.name} {candidate.potential:.2f}{failed}"


def _promised(event: ev.HelpAwaited | ev.HelpVerified | ev.HelpNotSeen) -> str:
    return PROMISES[event.help].format(object=event.object or event.name)
