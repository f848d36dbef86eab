"""The transcript of a run: each event as the lines that a person reads."""

from functools import singledispatchmethod

from mend.dialogue.evidence import Change
from mend.dialogue.script import CloseReason, Help
from mend.server.journal import events as ev
from mend.server.steering_words import because, told_level, told_wait, told_word
from mend.server.transcript_line import Line, Tone
from mend.server.transcript_words import (
    as_said,
    by,
    finished_text,
    told_deed,
    told_missing,
    told_start,
    why_aborted,
)
from mend.tasks.resolution import Resolution

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
        | ev.ModelKept
        | ev.ModelDeleted
        | ev.SignedIn
        | ev.SignInFailed
        | ev.SignedOut
        | ev.AccessChanged
        | ev.PushSubscribed
        | ev.PushEnded
        | ev.SiteOpened
        | ev.SiteGivenBack
        | ev.SiteIntervention
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
        text = f"has taken {event.name}, to do it"
        if event.said_done:
            text = f"says that {event.name} is done by hand{because(event.reason)}"
        return [_line(event, event.helper, text, Tone.CHOICE)]

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
        text = f"{event.name} is left out, {as_said(event.helper)}{because(event.reason)}"
        return [_line(event, "", text, Tone.SETBACK)]

    @lines.register
    def _(self, event: ev.NodeReturned) -> list[Line]:
        text = f"sees {event.name}, which was left out, at its place"
        return [_line(event, self._robot(event.robot), text, Tone.DONE)]

    @lines.register
    def _(self, event: ev.NodeAbandoned) -> list[Line]:
        text = f"the alternative {event.name} is abandoned: {event.reason}"
        return [_line(event, "", text, Tone.SETBACK)]

    # --- Steering -----------------------------------------------------------------------------

    @lines.register(ev.BreakpointSet)
    @lines.register(ev.BreakpointRemoved)
    @lines.register(ev.LeafLetGo)
    @lines.register(ev.LeafPreferred)
    @lines.register(ev.LeafNotPreferred)
    @lines.register(ev.LeafTriedAgain)
    def _(self, event: ev.SteeringEvent) -> list[Line]:
        return [_line(event, event.by, told_word(event), Tone.DEED)]

    @lines.register
    def _(self, event: ev.AutonomySet) -> list[Line]:
        return [_line(event, event.by, told_level(event), Tone.DEED)]

    @lines.register
    def _(self, event: ev.LeafHeld) -> list[Line]:
        return [_line(event, self._robot(event.robot), told_wait(event), Tone.WATCHED)]

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
    def _(self, _event: ev.ClipRecorded | ev.CamerasRecorded) -> list[Line]:
        return []

    @lines.register
    def _(self, event: ev.RecordingBegun) -> list[Line]:
        text = f"has the cameras recorded for {event.seconds:g} s"
        return [_line(event, event.by, text, Tone.DEED)]

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
    def _(self, event: ev.HandedOn) -> list[Line]:
        text = f"{event.helper} is busy: the question goes to {event.to}"
        return [_line(event, "", text, Tone.WATCHED)]

    @lines.register
    def _(self, event: ev.HelpAwaited) -> list[Line]:
        how = "waits to feel" if event.help in _FELT else "looks for"
        text = f"{how} {_promised(event)} until {event.until:.1f} s"
        return [_line(event, self._robot(event.robot), text, Tone.WATCHED)]

    @lines.register
    def _(self, event: ev.HelpReported) -> list[Line]:
        return [_line(event, f"helper ({event.helper})", "says that it is done", Tone.ANSWERED)]

    @lines.register
    def _(self, event: ev.PromiseTakenBack) -> list[Line]:
        text = "cannot help after all"
        return [_line(event, f"helper ({event.helper})", text, Tone.ANSWERED)]

    @lines.register
    def _(self, event: ev.HelpVerified) -> list[Line]:
        how = "feels" if event.help in _FELT else "sees"
        text = f"{how} {_promised(event)}{CHANGES[event.change]}"
        if event.change is Change.LED_ROUND:
            text = "sees that another way leads round"
        return [_line(event, self._robot(event.robot), text, Tone.WATCHED)]

    @lines.register(ev.HelpNotSeen)
    @lines.register(ev.HelpNotSeenYet)
    def _(self, event: ev.UnseenHelp) -> list[Line]:
        how = "feel" if event.help in _FELT else "see"
        yet = " yet" if isinstance(event, ev.HelpNotSeenYet) else ""
        why = f": {event.blind}" if event.blind else ""
        text = f"does not {how} {_promised(event)}{yet}{why}"
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
        return [_line(event, f"person ({event.by})", told_deed(event), Tone.DEED)]

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


def _line(event: ev.Event, speaker: str, text: str, tone: Tone) -> Line:
    return Line(event.time, speaker, text, tone)


def _comparison(event: ev.NodeStarted) -> str:
    """The potential of the chosen leaf against the best of the others; nothing without a choice."""
    chosen = next((each for each in event.candidates if each.node == event.node), None)
    others = [each for each in event.candidates if each.node != event.node]
    if chosen is not None and chosen.asked_for_by is not None:
        return f" (asked for by {chosen.asked_for_by})"
    if chosen is None or not others:
        return ""
    rivals = ", ".join(_rival(each) for each in others[:3])
    more = f" and {len(others) - 3} more" if len(others) > 3 else ""
    return f" (potential {chosen.potential:.2f}, before {rivals}{more})"


def _rival(candidate: ev.Candidate) -> str:
    failed = f" after {candidate.attempts} failed" if candidate.attempts else ""
    return f"{candidate.name} {candidate.potential:.2f}{failed}"


def _promised(event: ev.HelpAwaited | ev.HelpVerified | ev.UnseenHelp) -> str:
    return PROMISES[event.help].format(object=event.object or event.name)
