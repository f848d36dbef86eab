"""One conversation: walks a script's table for one issue, as the journal replays it."""

from enum import StrEnum
from typing import Literal

from dialogue.script import (
    Ask,
    AskState,
    AwaitHelp,
    Close,
    CloseReason,
    CloseState,
    Expectation,
    Help,
    HelpState,
    Say,
    Script,
    State,
    Turn,
)
from dialogue.wording import word
from tasks.issue import Issue
from tasks.resolution import Resolution


class Phase(StrEnum):
    """Where a conversation is, and so which calls it takes."""

    NEW = "new"
    ASKING = "asking"
    AWAITING_HELP = "awaiting help"
    CLOSED = "closed"


_LEGAL_CALLS = {
    Phase.NEW: ("open", "abort"),
    Phase.ASKING: ("answer", "put_right", "silence", "abort"),
    Phase.AWAITING_HELP: ("help_seen", "help_not_seen", "abort"),
    Phase.CLOSED: (),
}

_ROBOT_GOES_ON = (Resolution.ROBOT_FINISH, Resolution.COLLAB_FINISH)
"""Once it sees the help, or to take it, the robot moves."""


class IllegalTransitionError(Exception):
    """A call came that the conversation's phase does not allow; nothing was changed."""

    def __init__(self, phase: Phase, came: str, expected: tuple[str, ...]) -> None:
        wanted = " or ".join(expected) if expected else "nothing more"
        super().__init__(f"the conversation is {phase}: expected {wanted}, but {came} came")
        self.phase = phase
        self.came = came
        self.expected = expected


class Conversation:
    """Walks a script for one issue; every call returns the turns that follow from it.

    The same calls always give the same turns. The script must be sound (`dialogue.soundness`); then
    it closes after a bounded number of calls, exactly once. A call that the phase does not allow
    raises `IllegalTransitionError`.
    """

    def __init__(self, script: Script, issue: Issue) -> None:
        self._script = script
        self._issue = issue
        self._phase = Phase.NEW
        self._at: AskState | HelpState | None = None
        self._reasks_left = 0

    @property
    def phase(self) -> Phase:
        return self._phase

    @property
    def awaited_help(self) -> Help | None:
        """The help that is being watched for, if any."""
        if self._phase is Phase.AWAITING_HELP and isinstance(self._at, HelpState):
            return self._at.help
        return None

    @property
    def watched_for(self) -> tuple[Expectation, ...]:
        """What would put the issue right now, the most telling first; empty unless asking."""
        return tuple(self._script.put_right) if self._phase is Phase.ASKING else ()

    def open(self) -> list[Turn]:
        """Begin."""
        self._require("open")
        on_the_way = self._script.on_the_way
        if on_the_way is not None and not self._issue.interrupts:
            return self._enter(on_the_way)
        return self._enter(self._script.opening)

    def answer(self, answer: Literal["yes", "no"]) -> list[Turn]:
        """Take a helper's answer to the open question."""
        self._require("answer")
        match self._at, answer:
            case AskState(yes=following), "yes":
                return self._enter(following)
            case AskState(no=following), "no":
                return self._enter(following)
            case HelpState(help=promised), "yes":
                self._phase = Phase.AWAITING_HELP
                return [AwaitHelp(promised)]
            case HelpState(otherwise=following), "no":
                return self._enter(following)
        raise ValueError(f"an answer is 'yes' or 'no', not {answer!r}")

    def help_seen(self) -> list[Turn]:
        """The camera saw the promised help."""
        state = self._require_help_state("help_seen")
        return [
            Say(self._word(state.thanks)),
            self._close(CloseReason.RESOLVED, state.resolution, helped=True),
        ]

    def help_not_seen(self) -> list[Turn]:
        """The promised help was not seen in time: ask about it again, or give up."""
        state = self._require_help_state("help_not_seen")
        if self._reasks_left == 0:
            return self._give_up("I still do not see that help. I will try again later.")
        self._reasks_left -= 1
        self._phase = Phase.ASKING
        return [
            Ask(
                text=self._word(state.not_seen),
                yes_effect="I keep watching for it.",
                no_effect=self._word(state.otherwise_effect),
                yes_final=_is_final(state),
                no_final=_is_final(self._script.states[state.otherwise]),
            )
        ]

    def put_right(self, seen: Expectation) -> list[Turn]:
        """The robot saw the issue put right before anyone answered: withdraw the question.

        Raises `ValueError` when the script does not watch for what was seen.
        """
        self._require("put_right")
        if seen not in self._script.put_right:
            raise ValueError(f"'{seen}' does not put an issue '{self._issue.kind}' right")
        return [
            Say("I see that it is put right. Thank you."),
            self._close(CloseReason.WITHDRAWN, self._script.put_right[seen], helped=True),
        ]

    def silence(self) -> list[Turn]:
        """Nobody answered and nobody is left to ask: give up."""
        self._require("silence")
        return self._give_up("I heard no answer. I will try again later.")

    def abort(self) -> list[Turn]:
        """The run has ended."""
        self._require("abort")
        return [self._close(CloseReason.ABORTED, None, helped=False)]

    def _enter(self, name: str) -> list[Turn]:
        state = self._script.states[name]
        match state:
            case AskState():
                self._at, self._phase = state, Phase.ASKING
                return [
                    Ask(
                        text=self._word(state.text),
                        yes_effect=self._word(state.yes_effect),
                        no_effect=self._word(state.no_effect),
                        yes_final=_is_final(self._script.states[state.yes]),
                        no_final=_is_final(self._script.states[state.no]),
                    )
                ]
            case HelpState():
                self._at, self._phase = state, Phase.AWAITING_HELP
                self._reasks_left = self._script.reasks
                return [Say(self._word(state.text)), AwaitHelp(state.help)]
            case CloseState():
                helped = state.resolution is not Resolution.ROBOT_RETRY
                return [
                    Say(self._word(state.text)),
                    self._close(CloseReason.RESOLVED, state.resolution, helped=helped),
                ]

    def _give_up(self, last_word: str) -> list[Turn]:
        closing = self._close(CloseReason.GAVE_UP, Resolution.ROBOT_RETRY, helped=False)
        return [Say(last_word), closing]

    def _close(self, reason: CloseReason, resolution: Resolution | None, *, helped: bool) -> Close:
        self._at, self._phase = None, Phase.CLOSED
        return Close(reason, resolution, helped)

    def _require(self, call: str) -> None:
        expected = _LEGAL_CALLS[self._phase]
        if call not in expected:
            raise IllegalTransitionError(self._phase, call, expected)

    def _require_help_state(self, call: str) -> HelpState:
        self._require(call)
        assert isinstance(self._at, HelpState)
        return self._at

    def _word(self, text: str) -> str:
        return word(text, self._issue)


def _is_final(following: State) -> bool:
    """Whether what an answer leads to closes the dialogue or sets the robot in motion."""
    match following:
        case AskState():
            return False
        case HelpState(resolution=resolution):
            return resolution in _ROBOT_GOES_ON
        case CloseState():
            return True
