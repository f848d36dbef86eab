"""The state of a dialogue: a fold over its own events, and the issue that it is about."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from functools import singledispatchmethod
from typing import Self
from uuid import UUID

from mend.dialogue.conversation import Conversation
from mend.dialogue.evidence import Change, PutRight
from mend.dialogue.outlook import Outlook
from mend.dialogue.script import CloseReason, Expectation, Felt, Script, Sight, Turn
from mend.robots.link.messages import BASKET, LASER, Detection
from mend.server.journal import events as ev
from mend.tasks.issue import Issue, Sensed

SAID_DONE = "said_done"
TAKE_BACK = "take_back"
"""Calls to a conversation, by their names."""

_BLIND = "blind:"
_NOT_YET_BLIND = "not_yet_blind:"
MOST_EXTENSIONS = 10
"""So often the deadline of one question may be moved."""


@dataclass(slots=True)
class Lease:
    """A helper says that they are on it; wall time."""

    helper: str
    until: datetime


@dataclass(slots=True)
class DialogueState:
    """One dialogue: its conversation, its latest prompt and what it waits for."""

    opened: ev.DialogueOpened
    raised: ev.IssueRaised
    conversation: Conversation
    calls: list[str] = field(default_factory=list)
    prompt: ev.Prompt | None = None
    asked: ev.Prompt | None = None
    prompts: dict[UUID, ev.Prompt] = field(default_factory=dict)
    answers: dict[UUID, ev.Answered] = field(default_factory=dict)
    awaiting: ev.HelpAwaited | None = None
    reported: ev.HelpReported | None = None
    """Who says that the awaited help is done, until the look that follows has told."""
    last_unseen: ev.UnseenHelp | None = None
    """The latest look that did not see promised help."""
    claim: Lease | None = None
    claims: int = 0
    """How often it was claimed so far, renewals included."""
    resolved: ev.Resolved | None = None
    closed: CloseReason | None = None
    helps: int = 0
    put_at: dict[int, float] = field(default_factory=dict)
    """When (run's clock) the latest question was put, and each time again, by the ask's number."""
    asked_for_s: float | None = None
    """How long the open question waited for an answer when it was put."""
    first_look: ev.FirstLook | None = None
    promised_first: bool = False
    """Whether the help that is awaited was promised before the first look."""
    looked_anew: ev.LookedAnew | None = None
    """The latest look that later ones are compared with besides the first."""
    extensions: dict[UUID, int] = field(default_factory=dict)
    """How often each question's deadline may still be moved, where it was before."""
    clip: list[ev.ClipPicture] = field(default_factory=list)
    asked_of: list[str | None] = field(default_factory=list)
    """Whom each prompt of the latest question was for."""
    mailed: bool = False
    """Whether the operators were written to about it."""

    @property
    def id(self) -> UUID:
        return self.opened.dialogue

    @property
    def extensions_left(self) -> int:
        """How often the latest question's deadline may still be moved."""
        if self.asked is None:
            return 0
        return self.extensions.get(self.asked.prompt, MOST_EXTENSIONS)

    @property
    def open_ask(self) -> ev.Prompt | None:
        """The question that waits for an answer."""
        if self.closed or self.awaiting or self.asked is None:
            return None
        return None if self.asked.prompt in self.answers else self.asked

    @property
    def helper(self) -> str:
        """Who answered last; empty if nobody has."""
        last = next(reversed(self.answers.values()), None)
        return "" if last is None else last.helper

    def turns_after(self, calls: Sequence[str], script: Script, outlook: Outlook) -> list[Turn]:
        """What the conversation would say to the last of more calls, without making them."""
        return rehearse(script, self.raised, [*self.calls, *calls], outlook)

    def advance(self, call: str) -> None:
        """Make a call to the conversation."""
        converse(self.conversation, call)
        self.calls.append(call)

    @classmethod
    def begun(
        cls, opened: ev.DialogueOpened, raised: ev.IssueRaised, scripts: Mapping[str, Script]
    ) -> Self:
        """The state of a dialogue that has just opened, right after its issue was raised."""
        issue, outlook = issue_of(raised), raised.outlook or Outlook()
        dialogue = cls(opened, raised, Conversation(scripts[opened.issue], issue, outlook))
        dialogue.advance("open")
        return dialogue

    def fold(self, event: ev.DialogueEvent | ev.ClipRecorded) -> None:
        """Apply one event of the dialogue; they come in order of `seq`."""
        self._apply(event)

    @singledispatchmethod
    def _apply(self, event: ev.Event) -> None:
        """Events that leave no trace in the state."""

    @_apply.register
    def _(self, event: ev.Prompt) -> None:
        self.prompt = self.prompts[event.prompt] = event
        if event.kind == "ask":
            if self.asked is None or self.asked.prompt != event.prompt:
                self.asked_of, self.mailed = [], False
            self.asked_of.append(event.to)
            self.asked = event
            self.asked_for_s = None if event.deadline is None else event.deadline - event.time
            self.awaiting = self.reported = None

    @_apply.register
    def _(self, event: ev.DeadlineExtended) -> None:
        assert self.asked is not None, "only a question has a deadline"
        moved = self.asked.model_copy(update={"deadline": event.deadline})
        self.prompt = self.asked = self.prompts[event.prompt] = moved
        self.extensions[event.prompt] = event.extensions_left

    @_apply.register
    def _(self, event: ev.Escalated) -> None:
        self.mailed = self.mailed or event.channel == "mail"

    @_apply.register
    def _(self, event: ev.ClipRecorded) -> None:
        self.clip = event.pictures

    @_apply.register
    def _(self, event: ev.Claimed) -> None:
        self.claim = Lease(event.helper, event.lease_until)
        self.claims += 1

    @_apply.register
    def _(self, _event: ev.Released) -> None:
        self.claim = None

    @_apply.register
    def _(self, event: ev.Answered) -> None:
        self.answers[event.prompt] = event
        self.claim = None
        self.advance(event.answer)

    @_apply.register
    def _(self, event: ev.FirstLook) -> None:
        self.first_look = event
        self.promised_first = self.awaiting is not None

    @_apply.register
    def _(self, event: ev.LookedAnew) -> None:
        self.looked_anew = event

    @_apply.register
    def _(self, event: ev.HelpAwaited) -> None:
        self.awaiting = event
        self.helps += 1

    @_apply.register
    def _(self, event: ev.HelpVerified) -> None:
        self.awaiting = self.reported = None
        self.advance(seen_call(event))

    @_apply.register
    def _(self, event: ev.HelpReported) -> None:
        self.reported = event
        self.advance(SAID_DONE)

    @_apply.register
    def _(self, event: ev.HelpNotSeenYet) -> None:
        self.reported, self.last_unseen = None, event
        self.advance(call_of(event))

    @_apply.register
    def _(self, _event: ev.PromiseTakenBack) -> None:
        self.awaiting = self.reported = None
        self.advance(TAKE_BACK)

    @_apply.register
    def _(self, event: ev.HelpNotSeen) -> None:
        self.awaiting = self.reported = None
        self.last_unseen = event
        self.advance(call_of(event))

    @_apply.register
    def _(self, event: ev.Resolved) -> None:
        self.resolved = event

    @_apply.register
    def _(self, event: ev.DialogueClosed) -> None:
        self.closed = event.reason
        self.awaiting = self.reported = None
        self.claim = None


def seen_call(event: ev.HelpVerified) -> str:
    """The call that tells a conversation of help that was seen."""
    return f"seen:{event.change}" + (":at_place" if event.at_place else "")


def call_of(event: ev.HelpNotSeen | ev.HelpNotSeenYet) -> str:
    """The call that tells a conversation of help that was not seen, in time or yet."""
    if isinstance(event, ev.HelpNotSeenYet):
        if event.blind is not None:
            return _NOT_YET_BLIND + event.blind
        return f"not_yet:{event.felt or ''}:{event.sight or ''}"
    if event.blind is not None:
        return _BLIND + event.blind
    return "not_seen" if event.felt is None else f"not_seen:{event.felt}"


def converse(conversation: Conversation, call: str) -> list[Turn]:
    """Make a call by its name: `open`, `yes`, `no`, `not_seen`, `said_done`, `silence`, `abort`.

    Some have arguments: `seen:moved` (a change; `seen:moved:at_place`, where it is at its place),
    `put_right:at_place:moved` (what is seen, too),
    `not_seen:lighter` (what a basket felt), `blind:the picture is black` (why nothing was seen),
    `not_yet:lighter:unmoved` (felt, and seen of the object; either may be empty) and
    `not_yet_blind:the picture is black`.
    """
    if call.startswith(_NOT_YET_BLIND):
        return conversation.not_seen_yet(blind=call.removeprefix(_NOT_YET_BLIND))
    if call.startswith(_BLIND):
        return conversation.help_not_seen(blind=call.removeprefix(_BLIND))
    verb, *arguments = call.split(":")
    match verb, arguments:
        case "yes" | "no", []:
            return conversation.answer("yes" if verb == "yes" else "no")
        case "not_seen", [felt]:
            return conversation.help_not_seen(Felt(felt))
        case "not_yet", [felt, sight]:
            return conversation.not_seen_yet(
                Felt(felt) if felt else None, sight=Sight(sight) if sight else None
            )
        case "seen", [change, "at_place"]:
            return conversation.help_seen(Change(change), at_place=True)
        case "seen", [change]:
            return conversation.help_seen(Change(change))
        case "put_right", [seen, change]:
            return conversation.put_right(PutRight(Expectation(seen), Change(change)))
    calls = {
        "open": conversation.open,
        "not_seen": conversation.help_not_seen,
        SAID_DONE: conversation.said_done,
        TAKE_BACK: conversation.take_back,
        "silence": conversation.silence,
        "abort": conversation.abort,
    }
    return calls[verb]()


def rehearse(
    script: Script, raised: ev.IssueRaised, calls: Sequence[str], outlook: Outlook
) -> list[Turn]:
    """What a conversation says to the last of `calls`, made one after the other."""
    conversation = Conversation(script, issue_of(raised), raised.outlook or Outlook(), outlook)
    turns: list[Turn] = []
    for call in calls:
        turns = converse(conversation, call)
    return turns


def issue_of(raised: ev.IssueRaised) -> Issue:
    """The issue as dialogue scripts know it."""
    return Issue(
        kind=raised.issue,
        robot=raised.robot,
        node=raised.node,
        name=raised.name,
        object=raised.object,
        place=raised.place,
        step=raised.step,
        interrupts=raised.interrupts,
        reason="" if raised.detection is None else raised.detection.explanation,
        sensed=_sensed(raised.detection),
        guesses=() if raised.detection is None else tuple(raised.detection.guesses),
        item=raised.item,
        message=raised.message,
        person=raised.person,
        held_by=raised.held_by,
        away_m=raised.away_m,
    )


def _sensed(detection: Detection | None) -> Sensed:
    if detection is None:
        return Sensed.SEEN
    if detection.felt or detection.camera == BASKET:
        return Sensed.FELT
    if detection.camera == LASER:
        return Sensed.BY_LASER
    return Sensed.NOWHERE if detection.center is None else Sensed.SEEN
