"""One spoken conversation about one question, as a pure state machine: no sound, no sockets.

It is half duplex: while the robot speaks, and a moment longer, nothing is listened to.
"""

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

from mend.server.speech.commands import Command
from mend.server.speech.phrases import SORRY
from mend.tasks.transitions import Transitions

PAUSE_S = 0.2
"""Between the end of what the robot says and listening: the room has to fall silent."""

MAX_APOLOGIES = 2


class State(StrEnum):
    """Where a conversation is, and so what may come next."""

    NEW = "new"
    SAYING = "saying"
    PAUSING = "pausing"
    LISTENING = "listening"
    HEARING = "hearing"
    ENDED = "ended"


class EndReason(StrEnum):
    """Why a conversation ended."""

    HEARD = "heard"
    """Yes, no, a way of help, stop, done or that it cannot be."""
    GAVE_UP = "gave_up"
    CANCELLED = "cancelled"
    REPLACED = "replaced"
    """Another conversation has begun."""
    ANSWERED = "answered"
    """Somebody has answered the question."""
    CLOSED = "closed"
    """The dialogue has closed, or asks something else now."""
    LOST = "lost"
    """The recognizer has failed."""


class Saying(StrEnum):
    """What the robot says."""

    QUESTION = "question"
    HELP = "help"
    SORRY = "sorry"


@dataclass(frozen=True, slots=True)
class SayAloud:
    """Say this; `spoken` is to be called at its end."""

    what: Saying
    text: str


@dataclass(frozen=True, slots=True)
class StartListening:
    """From now on the microphone counts."""


@dataclass(frozen=True, slots=True)
class Hear:
    """Somebody has begun to speak."""


@dataclass(frozen=True, slots=True)
class Understood:
    """An utterance has ended; `command` None where it is not one.

    `latency_s` is the time since its last sound.
    """

    command: Command | None
    phrase: str | None
    latency_s: float


@dataclass(frozen=True, slots=True)
class StopTrying:
    """Nothing more is tried by voice."""


@dataclass(frozen=True, slots=True)
class End:
    """The conversation is over."""

    reason: EndReason


Act = SayAloud | StartListening | Hear | Understood | StopTrying | End


class SpokenCall(StrEnum):
    """What comes to a conversation."""

    OPEN = "open"
    SPOKEN = "spoken"
    PAUSE_OVER = "pause_over"
    SPEECH_BEGAN = "speech_began"
    UTTERANCE = "utterance"
    NOTHING_SAID = "nothing_said"
    END = "end"


_CALLS = Transitions(
    "the spoken conversation",
    {
        State.NEW: (SpokenCall.OPEN, SpokenCall.END),
        State.SAYING: (SpokenCall.SPOKEN, SpokenCall.END),
        State.PAUSING: (SpokenCall.PAUSE_OVER, SpokenCall.END),
        State.LISTENING: (SpokenCall.SPEECH_BEGAN, SpokenCall.END),
        State.HEARING: (SpokenCall.UTTERANCE, SpokenCall.NOTHING_SAID, SpokenCall.END),
        State.ENDED: (),
    },
)


class SpokenConversation:
    """Asks one question aloud until it has heard a command, or has apologized often enough.

    Every call returns what is to be done, in order; one that the state does not allow raises
    `IllegalTransitionError`. `now_s` is a clock that never goes back.
    """

    def __init__(
        self, question: str, help_text: str, now_s: Callable[[], float], sorry: str = SORRY
    ) -> None:
        self._texts = {
            Saying.QUESTION: question,
            Saying.HELP: help_text,
            Saying.SORRY: sorry,
        }
        self._now_s = now_s
        self._state = State.NEW
        self._listens_at_s = 0.0
        self._apologies_left = MAX_APOLOGIES

    @property
    def state(self) -> State:
        return self._state

    @property
    def listens(self) -> bool:
        """Whether the microphone counts now."""
        return self._state in (State.LISTENING, State.HEARING)

    @property
    def pause_left_s(self) -> float | None:
        """Seconds until `pause_over` may be called; None unless pausing."""
        if self._state is not State.PAUSING:
            return None
        return max(0.0, self._listens_at_s - self._now_s())

    def open(self) -> list[Act]:
        """Begin: ask the question."""
        _CALLS.require(self._state, SpokenCall.OPEN)
        return self._say(Saying.QUESTION)

    def spoken(self) -> list[Act]:
        """What was said has been played to its end."""
        _CALLS.require(self._state, SpokenCall.SPOKEN)
        self._state = State.PAUSING
        self._listens_at_s = self._now_s() + PAUSE_S
        return []

    def pause_over(self) -> list[Act]:
        """Listen, if the pause is over; nothing before."""
        _CALLS.require(self._state, SpokenCall.PAUSE_OVER)
        if self._now_s() < self._listens_at_s:
            return []
        self._state = State.LISTENING
        return [StartListening()]

    def speech_began(self) -> list[Act]:
        _CALLS.require(self._state, SpokenCall.SPEECH_BEGAN)
        self._state = State.HEARING
        return [Hear()]

    def utterance(self, command: Command | None, phrase: str | None, latency_s: float) -> list[Act]:
        """Somebody has said something; `command` None where it is not a command."""
        _CALLS.require(self._state, SpokenCall.UTTERANCE)
        heard = Understood(command, phrase, latency_s)
        match command:
            case Command.REPEAT:
                return [heard, *self._say(Saying.QUESTION)]
            case Command.HELP:
                return [heard, *self._say(Saying.HELP)]
            case None if self._apologies_left > 0:
                self._apologies_left -= 1
                return [heard, *self._say(Saying.SORRY)]
            case None:
                return [heard, StopTrying(), *self._end(EndReason.GAVE_UP)]
            case _:
                return [heard, *self._end(EndReason.HEARD)]

    def nothing_said(self) -> list[Act]:
        """What began was no speech after all."""
        _CALLS.require(self._state, SpokenCall.NOTHING_SAID)
        self._state = State.LISTENING
        return [StartListening()]

    def end(self, reason: EndReason) -> list[Act]:
        """End it for a reason outside of it."""
        _CALLS.require(self._state, SpokenCall.END)
        return self._end(reason)

    def _say(self, what: Saying) -> list[Act]:
        self._state = State.SAYING
        return [SayAloud(what, self._texts[what])]

    def _end(self, reason: EndReason) -> list[Act]:
        self._state = State.ENDED
        return [End(reason)]
