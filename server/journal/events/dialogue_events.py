"""Events of a dialogue: what was asked and answered, and what became of the help."""

from datetime import datetime
from typing import Literal
from uuid import UUID

from mend.dialogue.evidence import Change, LookOutcome
from mend.dialogue.script import CloseReason, Expectation, Felt, Help, Sight
from mend.robots.link.messages import Detection
from mend.server.journal.events.event import Author, EventModel, NodeEvent
from mend.tasks.resolution import Resolution


class AnswerOption(EventModel):
    """One way to answer a prompt, and what it will do.

    `final`: it cannot be taken back otherwise, as the robot starts to move or the dialogue closes.
    """

    value: Literal["yes", "no"]
    effect: str
    final: bool = False


class WayOption(EventModel):
    """One way to answer a prompt and what follows a no to it, all at once.

    `deed` is what the helper then does, and `label` the same below the prompt's headline.
    `answers` are those that it stands for; without any yes nobody helps. `effect` and `final` as
    of an answer.
    """

    way: str
    deed: str
    label: str
    effect: str
    answers: list[Literal["yes", "no"]]
    final: bool = False


class WordedSentence(EventModel):
    """A sentence, or a part of one: `key` is its English text with fields, `args` fills them.

    What fills a field is a text that stays as it is in every language, or sentences in turn.
    """

    key: str
    args: dict[str, "str | list[WordedSentence]"] = {}


class Wording(EventModel):
    """What an English text of a prompt is made of, so that others may read it in their language."""

    text: str
    sentences: list[WordedSentence]


class DialogueEvent(NodeEvent):
    """An event of one dialogue."""

    dialogue: UUID
    robot: str
    issue: str
    object: str | None


class DialogueOpened(DialogueEvent):
    """A dialogue began; `scripted`: the run's script answers, and people are not asked."""

    type: Literal["dialogue_opened"] = "dialogue_opened"
    scripted: bool = False


class Prompt(DialogueEvent):
    """The robot says something, or asks a yes/no question.

    `prompt` stays the same when a question is repeated; `version` counts up. `to` is the helper
    that it is meant for first, None for everyone. `deadline` is in the run's clock, and
    `timeout_effect` says what follows if nobody answers until then. `headline` is what is asked of
    the helper in few words, and `ways` are all that may be chosen; both are empty where a question
    takes a yes or a no alone. `wordings` are of all these texts that have one.
    """

    type: Literal["prompt"] = "prompt"
    prompt: UUID
    version: int
    kind: Literal["say", "ask"]
    text: str
    answers: list[AnswerOption] = []
    deadline: float | None = None
    timeout_effect: str = ""
    to: str | None = None
    headline: str = ""
    ways: list[WayOption] = []
    wordings: list[Wording] = []


class FirstLook(DialogueEvent):
    """What the robot saw first after it had put its question: later looks are compared with it.

    `fulfilled`: what was so already. `position`: where the object was seen (base frame, metres),
    None if it was not. `blind`: the camera showed nothing of the table, so that nothing was seen.
    `brought`: whether the object was seen, before that, not to be where it is now.
    """

    type: Literal["first_look"] = "first_look"
    fulfilled: list[Expectation]
    position: tuple[float, float, float] | None
    blind: bool = False
    brought: bool | None = None

    @property
    def outcome(self) -> LookOutcome:
        """What the look saw, as the rules of evidence take it."""
        return LookOutcome(
            frozenset(self.fulfilled), self.position, blind=self.blind, brought=self.brought
        )


class LookedAnew(DialogueEvent):
    """What was right is so no more, or the camera sees again: later looks are compared with this.

    Its fields are those of the `FirstLook`.
    """

    type: Literal["looked_anew"] = "looked_anew"
    fulfilled: list[Expectation]
    position: tuple[float, float, float] | None


class Claimed(DialogueEvent):
    """A helper is on it; others see so until the lease ends (wall time)."""

    type: Literal["claimed"] = "claimed"
    helper: str
    lease_until: datetime
    author: Author | None = None


class Released(DialogueEvent):
    """A claim ended: by the helper, or because its lease ran out."""

    type: Literal["released"] = "released"
    helper: str
    expired: bool = False
    author: Author | None = None


class Answered(DialogueEvent):
    """The first answer to a prompt; it won. A scripted one has no `author`."""

    type: Literal["answered"] = "answered"
    prompt: UUID
    version: int
    answer: Literal["yes", "no"]
    helper: str
    author: Author | None = None


class DeadlineExtended(DialogueEvent):
    """A helper asked for more time: the open question now waits until `deadline` (run's clock)."""

    type: Literal["deadline_extended"] = "deadline_extended"
    prompt: UUID
    version: int
    deadline: float
    extensions_left: int
    helper: str
    author: Author | None = None


class Escalated(DialogueEvent):
    """Nobody answered in time: the question goes to somebody else."""

    type: Literal["escalated"] = "escalated"
    channel: Literal["helper", "mail"]
    to: str


class HandedOn(DialogueEvent):
    """`helper`, who was asked, is busy with another question: it goes to `to`, who is idle."""

    type: Literal["handed_on"] = "handed_on"
    helper: str
    to: str


class HelpAwaited(DialogueEvent):
    """A helper promised physical help; the robot watches for it until `until` (run's clock).

    `guess`: where the helper has said that the robot is.
    """

    type: Literal["help_awaited"] = "help_awaited"
    help: Help
    guess: str | None = None
    helper: str
    until: float


class HelpVerified(DialogueEvent):
    """The robot saw what was promised. `change`: what it saw to change since it asked.

    `at_place`: it saw the object at the very place where that is to go.
    """

    type: Literal["help_verified"] = "help_verified"
    help: Help
    change: Change = Change.UNKNOWN
    at_place: bool = False


class HelpReported(DialogueEvent):
    """Somebody says that the promised help is done: the robot looks at once.

    `helper` says so, who need not have promised it.
    """

    type: Literal["help_reported"] = "help_reported"
    help: Help
    helper: str
    author: Author | None = None


class PromiseTakenBack(DialogueEvent):
    """Who promised help cannot give it after all: the dialogue goes on as after a no to it."""

    type: Literal["promise_taken_back"] = "promise_taken_back"
    help: Help
    helper: str
    author: Author | None = None


class UnseenHelp(DialogueEvent):
    """A look that did not see the promised help.

    `felt`: what its basket felt instead. `blind`: why it could see nothing; None if it saw that
    there was none. `picture`: what its camera showed then, and `detection` where in it the object
    was seen, and where it was to be.
    """

    help: Help
    felt: Felt | None = None
    blind: str | None = None
    picture: UUID | None = None
    detection: Detection | None = None


class HelpNotSeen(UnseenHelp):
    """The robot did not see the promised help in time."""

    type: Literal["help_not_seen"] = "help_not_seen"


class HelpNotSeenYet(UnseenHelp):
    """The robot was told that the help is done, does not see it, and goes on watching for it.

    `sight`: what it saw of the object instead.
    """

    type: Literal["help_not_seen_yet"] = "help_not_seen_yet"
    sight: Sight | None = None


class Resolved(DialogueEvent):
    """The issue is resolved, and so what becomes of the leaf.

    `helped`: a person was seen to help, or heard to where both work at once.
    """

    type: Literal["resolved"] = "resolved"
    resolution: Resolution
    helped: bool


class DialogueClosed(DialogueEvent):
    """The dialogue is over."""

    type: Literal["dialogue_closed"] = "dialogue_closed"
    reason: CloseReason
