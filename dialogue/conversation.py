"""One conversation: walks a script's table for one issue, as the journal replays it."""

from mend.dialogue.calls import CALLS, ConversationPhase, DialogueCall
from mend.dialogue.evidence import Change, PutRight
from mend.dialogue.outlook import Outlook
from mend.dialogue.reading import ROBOT_GOES_ON, ScriptReading
from mend.dialogue.script import (
    ATTEMPT_FAILED,
    EXPECTED,
    Answer,
    Ask,
    AskState,
    AwaitHelp,
    Close,
    CloseReason,
    CloseState,
    Expectation,
    Felt,
    Help,
    HelpState,
    LeaveState,
    Remark,
    Script,
    Sight,
    ToldState,
    Turn,
    Way,
)
from mend.dialogue.telling import SEEN_NOW, asked_about, not_yet, nothing_could_be_seen
from mend.dialogue.ways import ways_of, ways_of_repeated
from mend.dialogue.worded import Worded, joined, worded
from mend.dialogue.wording import sentence
from mend.tasks.issue import Issue
from mend.tasks.resolution import Resolution

MOST_LOOKS = 10
"""So often the robot looks at a helper's word that one promise is kept."""

_THANKS = worded("Thank you.")
_KEEPS = "I keep watching"
_OR_FAILS = "; if I do not see it then, {attempt} has failed, and {later}."


class Conversation:
    """Walks a script for one issue; every call returns the turns that follow from it.

    The same calls always give the same turns. The script must be sound (`dialogue.soundness`); then
    it closes after a bounded number of calls, exactly once. A call that the phase does not allow
    raises `IllegalTransitionError`. `outlook` is that of the moment when the issue was raised and
    decides which way is taken; `said_with` is that of now, and words what is said (other robots
    may have changed it meanwhile).
    """

    def __init__(
        self,
        script: Script,
        issue: Issue,
        outlook: Outlook,
        said_with: Outlook | None = None,
    ) -> None:
        self._script = script.variants.get(issue.sensed, script)
        if issue.object is None:
            self._script = self._script.without_object or self._script
        self._issue = issue
        self._outlook = outlook
        self._said_with = said_with or outlook
        self._reading = ScriptReading(self._script, issue, outlook, self._said_with)
        self._phase = ConversationPhase.NEW
        self._at: AskState | HelpState | ToldState | None = None
        self._name = ""
        self._asked: Ask | None = None
        self._reasks_left = 0
        self._looks_left = 0

    @property
    def phase(self) -> ConversationPhase:
        return self._phase

    @property
    def puts_right(self) -> tuple[Expectation, ...]:
        """What would put the issue right, the most telling first."""
        return tuple(self._script.put_right)

    @property
    def watched_for(self) -> tuple[Expectation, ...]:
        """What puts the issue right without an answer; empty unless asking."""
        return self.puts_right if self._phase is ConversationPhase.ASKING else ()

    @property
    def denied(self) -> frozenset[Expectation]:
        """What the issue says not to be so."""
        return self._script.denied

    @property
    def contradictable(self) -> frozenset[Expectation]:
        """What of that the first look may contradict.

        A robot that was contradicted before, and met the same issue again, believes the issue.
        """
        return self.denied if self._outlook.unchanged == 1 else frozenset()

    @property
    def looks_at_a_word(self) -> bool:
        """Whether the robot, told that the help it awaits is done, looks at once."""
        awaits = self._phase is ConversationPhase.AWAITING_HELP
        return awaits and isinstance(self._at, HelpState) and self._looks_left > 0

    def open(self) -> list[Turn]:
        """Begin."""
        CALLS.require(self._phase, DialogueCall.OPEN)
        on_the_way = self._script.on_the_way
        if on_the_way is not None and not self._issue.interrupts:
            return self._enter(on_the_way, heard=False)
        failed = self._script.failed_opening if self._outlook.own_failure else None
        return self._enter(failed or self._script.opening, heard=False)

    @property
    def ways(self) -> tuple[Way, ...]:
        """Every way to answer the open question and what follows its no; empty unless asking."""
        if self._phase is not ConversationPhase.ASKING or self._asked is None:
            return ()
        return self._asked.ways

    def answer(self, answer: Answer) -> list[Turn]:
        """Take a helper's answer to the open question."""
        CALLS.require(self._phase, DialogueCall.ANSWER)
        match self._at, answer:
            case AskState(yes=following), "yes":
                return self._enter(following, heard=True)
            case AskState(no=following), "no":
                return self._enter(following, heard=False)
            case HelpState() as state, "yes":
                return [self._await_help(state)]
            case HelpState(otherwise=following), "no":
                return self._enter(following, heard=False)
        raise ValueError(f"an answer is 'yes' or 'no', not {answer!r}")

    def help_seen(self, change: Change, *, at_place: bool = False) -> list[Turn]:
        """The camera saw what was promised; `change`: what it saw to change since the question.

        `at_place`: whoever was to put the object within reach has put it where it is to go.
        """
        CALLS.require(self._phase, DialogueCall.HELP_SEEN)
        if isinstance(self._at, ToldState):
            said = self._word(self._at.thanks)
            return self._settle(CloseReason.RESOLVED, self._at.resolution, said, change)
        state = self._require_help_state(DialogueCall.HELP_SEEN)
        placed = self._script.put_right.get(Expectation.AT_PLACE) if at_place else None
        if state.help is Help.PUT_BACK and placed is not None and change.by_a_person:
            said = joined(_THANKS, self._word(SEEN_NOW[Expectation.AT_PLACE]))
            return self._settle(CloseReason.RESOLVED, placed, said, change)
        text = state.thanks if change.by_a_person else state.unchanged
        if change is Change.UNKNOWN:
            text = SEEN_NOW[EXPECTED[state.help]]
        if change is Change.LED_ROUND:
            text = SEEN_NOW[Expectation.LED_ROUND]
        said = self._word(text)
        return self._settle(CloseReason.RESOLVED, state.resolution, said, change)

    def help_not_seen(self, felt: Felt | None = None, *, blind: str = "") -> list[Turn]:
        """The promised help was not seen in time: ask about it again, or give up.

        `felt`: what a basket feels instead, where it is one that was to feel the help. `blind`: why
        nothing could be seen, so that nobody can say whether there was any. That is no failed
        attempt the first time: before the next one the robot asks for its view.
        """
        CALLS.require(self._phase, DialogueCall.HELP_NOT_SEEN)
        if blind:
            said = nothing_could_be_seen(blind)
            if self._outlook.times > 1:
                return self._give_up(said)
            close = self._close(CloseReason.GAVE_UP, Resolution.ROBOT_RETRY)
            return [Remark(joined(said, worded("I look again before I go on."))), close]
        if isinstance(self._at, ToldState):
            doubted = Remark(self._word(self._at.doubted))
            return [doubted, *self._enter(self._at.otherwise, heard=False)]
        state = self._require_help_state(DialogueCall.HELP_NOT_SEEN)
        if self._reasks_left == 0:
            return self._give_up(self._word(state.given_up))
        self._reasks_left -= 1
        self._phase = ConversationPhase.ASKING
        return [self._ask_about(state, felt)]

    def said_done(self) -> list[Turn]:
        """A helper says that what was promised is done: nothing is said before a look was made.

        Raises `ValueError` where the robot looks by itself alone (`looks_at_a_word`).
        """
        CALLS.require(self._phase, DialogueCall.SAID_DONE)
        if not self.looks_at_a_word:
            raise ValueError("the robot has looked at a word often enough, or looks already")
        self._looks_left -= 1
        self._phase = ConversationPhase.LOOKING_AGAIN
        return []

    def not_seen_yet(
        self, felt: Felt | None = None, *, sight: Sight | None = None, blind: str = ""
    ) -> list[Turn]:
        """The look at that word did not see the help, which there is still time for.

        `felt` and `blind` as in `help_not_seen`; `sight`: what it saw of the object instead.
        """
        CALLS.require(self._phase, DialogueCall.NOT_SEEN_YET)
        state = self._require_help_state(DialogueCall.NOT_SEEN_YET)
        self._phase = ConversationPhase.AWAITING_HELP
        asked = asked_about(state, felt)
        said = nothing_could_be_seen(blind) if blind else self._word(not_yet(asked, sight))
        return [Remark(joined(said, worded(f"{_KEEPS}.")))]

    def take_back(self) -> list[Turn]:
        """Whoever promised the help cannot give it after all: as if they had said no to it."""
        CALLS.require(self._phase, DialogueCall.TAKE_BACK)
        assert isinstance(self._at, HelpState | ToldState), "only help is promised"
        return self._enter(self._at.otherwise, heard=False)

    def put_right(self, seen: PutRight) -> list[Turn]:
        """The robot saw the issue put right before anyone answered: withdraw the question.

        Raises `ValueError` when the script does not watch for what was seen.
        """
        CALLS.require(self._phase, DialogueCall.PUT_RIGHT)
        resolution = self._script.put_right.get(seen.seen)
        if resolution is None:
            raise ValueError(f"'{seen.seen}' does not put an issue '{self._issue.kind}' right")
        thanks = _THANKS if seen.change.by_a_person else ""
        said = joined(thanks, self._word(SEEN_NOW[seen.seen]))
        return self._settle(CloseReason.WITHDRAWN, resolution, said, seen.change)

    def silence(self) -> list[Turn]:
        """Nobody answered and nobody is left to ask: go on without an answer, or give up."""
        CALLS.require(self._phase, DialogueCall.SILENCE)
        if isinstance(self._at, AskState) and self._at.unanswered is not None:
            return self._enter(self._at.unanswered, heard=False)
        return self._give_up(worded("I heard no answer."))

    def abort(self) -> list[Turn]:
        """The run has ended, or the issue no longer matters."""
        CALLS.require(self._phase, DialogueCall.ABORT)
        return [self._close(CloseReason.ABORTED, None)]

    # --- Going from state to state ------------------------------------------------------------

    def _enter(self, name: str, *, heard: bool) -> list[Turn]:
        self._name = self._reading.following(name)
        state = self._script.states[self._name]
        match state:
            case AskState():
                self._at, self._phase = state, ConversationPhase.ASKING
                return [self._ask(state)]
            case HelpState():
                self._at, self._reasks_left = state, self._script.reasks
                return [Remark(self._word(state.text)), self._await_help(state)]
            case ToldState(guess=guess):
                self._at, self._phase = state, ConversationPhase.AWAITING_HELP
                return [AwaitHelp(Help.TELL_PLACE, self._issue.guesses[guess - 1])]
            case LeaveState():
                return [Remark(self._word(state.text)), self._close(CloseReason.LEFT_OUT, None)]
            case CloseState(resolution=Resolution.ROBOT_RETRY):
                said = joined(self._word(state.text), self._next_after_failure())
                close = self._close(CloseReason.RESOLVED, Resolution.ROBOT_RETRY, failed=True)
                return [Remark(said), close]
            case CloseState(resolution=resolution):
                helped = heard and resolution in ROBOT_GOES_ON
                close = self._close(CloseReason.RESOLVED, resolution, helped=helped)
                return [Remark(self._word(state.text)), close]

    def _await_help(self, state: HelpState) -> AwaitHelp:
        self._phase, self._looks_left = ConversationPhase.AWAITING_HELP, MOST_LOOKS
        return AwaitHelp(state.help)

    def _ask(self, state: AskState) -> Ask:
        reading, choice = self._reading, ways_of(self._reading, state)
        self._asked = Ask(
            text=self._word(state.text),
            yes_effect=reading.effect(state.yes, state.yes_effect),
            no_effect=reading.effect(state.no, state.no_effect),
            timeout_effect=self._word(state.unanswered_effect),
            yes_final=reading.is_final(state.yes),
            no_final=reading.is_final(state.no),
            ways=choice.ways,
            headline=choice.headline,
        )
        return self._asked

    def _ask_about(self, state: HelpState, felt: Felt | None) -> Ask:
        """Whether promised help that is not seen still comes."""
        reading, keeps = self._reading, f"{_KEEPS} for it ({{attempt}})"
        effect = self._word(f"{keeps}." if self._reasks_left else keeps + _OR_FAILS)
        choice = ways_of_repeated(reading, self._name, state, effect, felt)
        self._asked = Ask(
            text=self._word(asked_about(state, felt)),
            yes_effect=effect,
            no_effect=reading.effect(state.otherwise, state.otherwise_effect),
            timeout_effect=self._word(ATTEMPT_FAILED),
            yes_final=reading.is_final(self._name),
            no_final=reading.is_final(state.otherwise),
            ways=choice.ways,
            headline=choice.headline,
        )
        return self._asked

    def _settle(
        self, reason: CloseReason, wanted: Resolution, said: Worded, change: Change
    ) -> list[Turn]:
        """Close with what was seen, which tells whether anybody has helped, and what comes next."""
        helped = change.by_a_person
        led_round = change is Change.LED_ROUND
        resolution = wanted if led_round else self._resolution_for(wanted, helped)
        # Where nobody can say whether anybody has helped it is no failed attempt the first time.
        untold = change is Change.UNKNOWN and self._outlook.times == 1
        failed = not (helped or untold) or self._outlook.helped_out
        match resolution:
            case Resolution.ROBOT_RETRY if failed:
                then = self._next_after_failure()
            case Resolution.ROBOT_RETRY:
                then = sentence(self._said_with.after_help())
            case Resolution.ROBOT_FINISH if not led_round or self._said_with.begins_anew:
                then = sentence(self._goes_on())
            case _:
                then = Worded("", ())
        failed = failed and resolution is Resolution.ROBOT_RETRY
        close = self._close(reason, resolution, helped=helped, failed=failed)
        return [Remark(joined(said, then)), close]

    def _goes_on(self) -> Worded:
        if isinstance(self._at, HelpState) and not self._said_with.begins_anew:
            return worded(self._at.goes_on)
        return self._said_with.going_on()

    def _resolution_for(self, wanted: Resolution, helped: bool) -> Resolution:
        if helped and not self._outlook.helped_out:
            return wanted
        if wanted is Resolution.HUMAN_FINISH:
            # It lies there, but nobody was seen to put it there: the robot finds it in place.
            return wanted if helped else Resolution.ROBOT_FINISH
        if wanted is Resolution.ROBOT_FINISH and self._outlook.unchanged > 1:
            # It went on before for no more than this, and met the same issue again.
            return Resolution.ROBOT_RETRY
        return Resolution.ROBOT_RETRY if self._outlook.helped_out else wanted

    def _give_up(self, last_word: Worded) -> list[Turn]:
        closing = self._close(CloseReason.GAVE_UP, Resolution.ROBOT_RETRY, failed=True)
        return [Remark(joined(last_word, self._next_after_failure())), closing]

    def _next_after_failure(self) -> Worded:
        return sentence(self._said_with.if_it_fails())

    def _close(
        self,
        reason: CloseReason,
        resolution: Resolution | None,
        *,
        helped: bool = False,
        failed: bool = False,
    ) -> Close:
        self._at, self._phase = None, ConversationPhase.CLOSED
        return Close(reason, resolution, helped, failed)

    def _require_help_state(self, call: DialogueCall) -> HelpState:
        CALLS.require(self._phase, call)
        assert isinstance(self._at, HelpState)
        return self._at

    def _word(self, text: str) -> Worded:
        return self._reading.word(text)
