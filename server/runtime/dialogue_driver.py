"""Keeps a run's open dialogues going: answers, deadlines, escalation, and what looks have seen."""

from collections.abc import Callable, Mapping, Sequence
from uuid import UUID, uuid4

from mend.dialogue.outlook import Outlook
from mend.dialogue.script import Answer, Ask, Remark, Turn, Way
from mend.dialogue.spoken import spoken
from mend.dialogue.worded import joined, worded
from mend.dialogue.wording import sentence
from mend.errors import ConflictError, NotFoundError
from mend.server.access.principal import SCRIPT
from mend.server.dialogues.answers import AnswerSource
from mend.server.dialogues.duty import Duty
from mend.server.dialogues.escalation import (
    NOBODY,
    EscalationPolicy,
    Exhausted,
    Mail,
    Repeat,
    Standing,
    ToHelper,
    first_helper,
    handed_on,
    next_rung,
)
from mend.server.errors import LostRaceError
from mend.server.journal import events as ev
from mend.server.runtime.awaited_help import HelpersWord
from mend.server.runtime.clock import has_come, rate_while_asked
from mend.server.runtime.context import RunContext
from mend.server.runtime.dialogue_events import DialogueEvents
from mend.server.runtime.dialogue_looks import DialogueLooks, seen_at
from mend.server.runtime.dialogue_state import (
    MOST_EXTENSIONS,
    DialogueState,
    call_of,
    rehearse,
    seen_call,
)
from mend.server.runtime.outlooks import is_suspect, outlook_at, outlook_now
from mend.server.runtime.promises import Promises
from mend.server.runtime.robot_proxy import Purpose, RobotProxy
from mend.server.runtime.unseen_help import unseen_help
from mend.tasks.scenario import Person

SendMail = Callable[[ev.Escalated | ev.SuspectedFalseAlarm, DialogueState], None]
"""Writes to the operators: about a question that nobody answered, or a suspected false alarm."""


class DialogueDriver:
    """Drives the dialogues of one run. `person` is None where nobody is simulated.

    `duty`: who is signed in to help, and what all runs ask of whom.
    """

    def __init__(
        self,
        context: RunContext,
        answers: AnswerSource,
        policy: EscalationPolicy,
        person: Person | None,
        send_mail: SendMail,
        duty: Callable[[], Duty] = lambda: NOBODY,
    ) -> None:
        self._context = context
        self._duty = duty
        self._answers = answers
        self._policy = policy
        self._promises = Promises(context, person)
        self._looks = DialogueLooks(context, self._rate)
        self._send_mail = send_mail
        self.word = HelpersWord(context, self._converse)
        """What helpers say of help that is awaited."""

    # --- What the run calls -------------------------------------------------------------------

    def robot_rebooted(self) -> None:
        """The world was rebuilt: what a person was about to do has to be asked for again."""
        self._promises.forget()

    def open(self, raised: ev.IssueRaised, proxy: RobotProxy) -> list[ev.Event]:
        """The events that raise an issue and open a dialogue about it, with its first prompts."""
        state, most = self._context.state, self._context.settings.max_helped_retries
        raised = raised.model_copy(update={"last_seen": seen_at(proxy, raised.object)})
        outlook = outlook_at(state, proxy, raised, most)
        raised = raised.model_copy(update={"outlook": outlook})
        make = DialogueEvents(self._context.stamp, uuid4(), raised)
        turns = rehearse(state.scripts[raised.issue], raised, ["open"], outlook)
        said = self._of_turns(make, turns, "", waits=raised.interrupts, stopped=None)
        return [raised, make.opened(scripted=not self._answers.live), *said]

    async def drive(self, dialogue: DialogueState, proxy: RobotProxy) -> bool:
        """Do what the dialogue needs now; True if that changed the state."""
        if await self._tell_of_suspicion(dialogue):
            return True
        if dialogue.awaiting is not None:
            # Nobody reaches in before the arm has drawn back and the robot has looked.
            looked = not dialogue.raised.interrupts or dialogue.first_look is not None
            if looked and (proxy.free or proxy.interruptible):
                self._promises.have_kept(dialogue, dialogue.awaiting, proxy)
            self._looks.watch_for_help(dialogue, dialogue.awaiting, proxy)
            return False
        ask = dialogue.open_ask
        if ask is None:
            return False
        clock = self._context.clock
        scripted = self._scripted(dialogue)
        if scripted is not None and has_come(clock, scripted[1]):
            await self._take(self._answered(dialogue, ask, [scripted[0]], SCRIPT, proxy))
            return True
        assert ask.deadline is not None, "every question has a deadline"
        if has_come(clock, ask.deadline):
            await self._nobody_answered(dialogue, ask, proxy)
            return True
        if await self._handed_on(dialogue, ask, proxy):
            return True
        if proxy.free:
            due = min(ask.deadline, scripted[1]) if scripted else ask.deadline
            self._looks.let_time_pass(dialogue, proxy, due)
        return False

    def next_due(self, after: float) -> float | None:
        """When, in the run's clock, the next answer, look or deadline after a moment is due."""
        dues = []
        for dialogue in self._context.state.open_dialogues:
            if (ask := dialogue.open_ask) is not None and ask.deadline is not None:
                scripted = self._scripted(dialogue)
                dues.append(min(ask.deadline, scripted[1]) if scripted else ask.deadline)
            if (look := self._looks.next_watch(dialogue)) is not None:
                dues.append(look)
        return min((each for each in dues if each > after), default=None)

    async def looked(
        self, dialogue: DialogueState, proxy: RobotProxy, purpose: Purpose, fulfilled: bool
    ) -> None:
        """Take the answer of a look that was made for a dialogue."""
        nothing_seen = dialogue.first_look is None or self._looks.awaits_view(dialogue)
        if purpose is Purpose.BASELINE and nothing_seen:
            await self._looked_first(dialogue, proxy, fulfilled)
        elif purpose is Purpose.WATCH and dialogue.open_ask is not None:
            await self._watched(dialogue, proxy, fulfilled)
        elif purpose is Purpose.HELP and dialogue.awaiting is not None:
            await self._help_looked_for(dialogue, dialogue.awaiting, proxy, fulfilled)

    async def _looked_first(
        self, dialogue: DialogueState, proxy: RobotProxy, fulfilled: bool
    ) -> None:
        first, make = self._looks.first_look(dialogue, proxy, fulfilled), self._make(dialogue)
        if dialogue.first_look is not None and first.blind:
            return
        anew = dialogue.first_look is not None
        noted = make.looked_anew(first) if anew else make.first_look(first)
        right = self._looks.right_at_first(dialogue, first) if dialogue.open_ask else None
        if right is None:
            await self._context.commit([noted])
        else:
            call = f"put_right:{right.seen}:{right.change}"
            await self._converse(dialogue, call, [noted], proxy)

    async def _watched(self, dialogue: DialogueState, proxy: RobotProxy, fulfilled: bool) -> None:
        seen = self._looks.put_right(dialogue, proxy, fulfilled)
        if seen is not None:
            await self._converse(dialogue, f"put_right:{seen.seen}:{seen.change}", [], proxy)
        elif (undone := self._looks.undone(dialogue, proxy, fulfilled)) is not None:
            await self._context.commit([self._make(dialogue).looked_anew(undone)])

    async def _tell_of_suspicion(self, dialogue: DialogueState) -> bool:
        """Once per leaf, tell the operators that the robot may be wrong; True if that was now."""
        state, raised = self._context.state, dialogue.raised
        leaf = state.tree.index_of(raised.node)
        if leaf in state.suspected or not is_suspect(state, raised):
            return False
        outlook = raised.outlook or Outlook()
        said = "" if raised.detection is None else raised.detection.explanation
        told = list(self._policy.operators)
        suspected = self._make(dialogue).suspected_false_alarm(outlook.unchanged, said, told)
        await self._context.commit([suspected])
        if told:
            self._send_mail(suspected, dialogue)
        return True

    async def answer(
        self,
        dialogue: DialogueState,
        prompt: UUID,
        answer: Answer,
        helper: str,
        proxy: RobotProxy,
        author: ev.Author | None = None,
    ) -> ev.Answered:
        """Take a live helper's answer; the first one wins.

        Raises `LostRaceError`, `ConflictError` (no longer open) or `NotFoundError` (no such
        prompt).
        """
        ask = _open_ask(dialogue, prompt)
        return await self._take(self._answered(dialogue, ask, [answer], helper, proxy, author))

    async def choose(
        self,
        dialogue: DialogueState,
        prompt: UUID,
        way: str,
        helper: str,
        proxy: RobotProxy,
        author: ev.Author | None = None,
    ) -> ev.Answered:
        """Take all the answers that lead to a way of help; returns the last of them.

        Raises as `answer` does, and `ConflictError` where there is no such way to answer now.
        """
        ask = _open_ask(dialogue, prompt)
        ways = dialogue.conversation.ways
        chosen = next((each for each in ways if each.name == way), None)
        if chosen is None:
            raise ConflictError(_no_such_way(way, ways))
        answers = chosen.answers
        return await self._take(self._answered(dialogue, ask, answers, helper, proxy, author))

    async def extend(
        self,
        dialogue: DialogueState,
        prompt: UUID,
        helper: str,
        author: ev.Author | None = None,
    ) -> ev.DeadlineExtended:
        """Move the open question's deadline by as long as it was first put for.

        Raises `NotFoundError` (no such prompt) or `ConflictError` (not open, or too often).
        """
        if prompt not in dialogue.prompts:
            raise NotFoundError(f"there is no prompt {prompt} in this dialogue")
        ask, length_s = dialogue.open_ask, dialogue.asked_for_s
        if ask is None or ask.prompt != prompt or ask.deadline is None or length_s is None:
            raise ConflictError("this prompt does not wait for an answer: it has no deadline")
        left = dialogue.extensions_left - 1
        if left < 0:
            raise ConflictError(
                f"this question was given more time {MOST_EXTENSIONS} times already",
                limit="extensions",
            )
        make = self._make(dialogue)
        event = make.extended(ask, ask.deadline + length_s, left, helper, author)
        (extended,) = await self._context.commit([event])
        assert isinstance(extended, ev.DeadlineExtended), "what is committed keeps its type"
        return extended

    def abort(self, dialogue: DialogueState) -> ev.DialogueClosed:
        """The event that ends a dialogue because its run, robot or alternative ends."""
        return self._make(dialogue).aborted()

    def too_late(self, dialogue: DialogueState, proxy: RobotProxy) -> list[ev.Event]:
        """The events that end a question to which nobody can say yes any more.

        A script's answer counts that was due before: the clock leaps from report to report.
        """
        ask, scripted = dialogue.open_ask, self._scripted(dialogue)
        if ask is None or scripted is None or not has_come(self._context.clock, scripted[1]):
            return [self.abort(dialogue)]
        events = self._answered(dialogue, ask, [scripted[0]], SCRIPT, proxy)
        closed = any(isinstance(each, ev.DialogueClosed) for each in events)
        return events if closed else [*events, self.abort(dialogue)]

    def remark(self, dialogue: DialogueState, clause: str) -> ev.Prompt:
        """The event that tells whoever was asked why nobody has to answer any more."""
        return self._make(dialogue).say(Remark(sentence(spoken(clause))))

    # --- Silence and answers ------------------------------------------------------------------

    def _make(self, dialogue: DialogueState) -> DialogueEvents:
        return DialogueEvents(self._context.stamp, dialogue.id, dialogue.raised)

    def _scripted(self, dialogue: DialogueState) -> tuple[Answer, float] | None:
        """The scripted answer to the open question and when it is due.

        Who takes longer than the deadline answers while the question is put again.
        """
        if self._answers.live:
            return None
        due = []
        for number, put_at in dialogue.put_at.items():
            scripted = self._answers.next_answer(number)
            if scripted.answer is not None:
                due.append((scripted.answer, put_at + scripted.delay_s))
        return min(due, key=lambda each: each[1], default=None)

    async def _take(self, answered: Sequence[ev.Event]) -> ev.Answered:
        """Commit the events of answers; returns the last answer."""
        committed = await self._context.commit(answered)
        return [each for each in committed if isinstance(each, ev.Answered)][-1]

    def _answered(
        self,
        dialogue: DialogueState,
        ask: ev.Prompt,
        answers: Sequence[Answer],
        helper: str,
        proxy: RobotProxy,
        author: ev.Author | None = None,
    ) -> list[ev.Event]:
        """The events of an answer to the open question, and to each that follows from that."""
        make = self._make(dialogue)
        events: list[ev.Event] = []
        if dialogue.claim is not None and dialogue.claim.helper != helper:
            events.append(make.released(dialogue.claim.helper, expired=False, author=author))
        for number, answer in enumerate(answers, start=1):
            said = self._said_after(dialogue, answers[:number], proxy, helper)
            events += [make.answered(ask, answer, helper, author), *said]
            ask = next((each for each in said if isinstance(each, ev.Prompt)), ask)
        return events

    async def _nobody_answered(
        self, dialogue: DialogueState, ask: ev.Prompt, proxy: RobotProxy
    ) -> None:
        if not dialogue.raised.interrupts:
            await self._converse(dialogue, "silence", [], proxy)
            return
        make = self._make(dialogue)
        rung = next_rung(self._policy, _standing(dialogue), self._duty(), dialogue.id)
        if isinstance(rung, Exhausted):
            await self._converse(dialogue, "silence", [], proxy)
            return
        again = self._ask_again(dialogue, ask, proxy, rung)
        match rung:
            case Repeat():
                await self._context.commit([again])
            case ToHelper(helper=helper):
                await self._context.commit([make.escalated("helper", helper), again])
            case Mail(addresses=addresses):
                escalated = make.escalated("mail", ", ".join(addresses))
                await self._context.commit([escalated, again])
                self._send_mail(escalated, dialogue)

    async def _handed_on(self, dialogue: DialogueState, ask: ev.Prompt, proxy: RobotProxy) -> bool:
        """Put a question that waits for somebody busy to somebody idle; True if that was now."""
        helper, to = ask.to, handed_on(self._policy, self._duty()).get(dialogue.id)
        if helper is None or to is None:
            return False
        rung = ToHelper(to, self._policy.answer_within_s)
        again = self._ask_again(dialogue, ask, proxy, rung)
        await self._context.commit([self._make(dialogue).handed_on(helper, to), again])
        return True

    def _ask_again(
        self,
        dialogue: DialogueState,
        ask: ev.Prompt,
        proxy: RobotProxy,
        rung: Repeat | ToHelper | Mail,
    ) -> ev.Prompt:
        """The open question once more, worded as things are now."""
        script = self._context.state.scripts[dialogue.raised.issue]
        turns = dialogue.turns_after([], script, self._outlook(dialogue, proxy))
        question = next(each for each in turns if isinstance(each, Ask))
        deadline = self._context.clock.now() + rung.answer_within_s
        to = ask.to if isinstance(rung, Mail) else rung.helper
        mailed = dialogue.mailed or isinstance(rung, Mail)
        standing = Standing((*dialogue.asked_of, to), mailed)
        effect = joined(self._if_silent(standing, dialogue.id), question.timeout_effect)
        return self._make(dialogue).repeat(ask, question, deadline, to, effect)

    def _if_silent(self, standing: Standing, dialogue: UUID) -> str:
        """What is done before silence counts as an answer, as the beginning of a sentence."""
        match next_rung(self._policy, standing, self._duty(), dialogue):
            case Repeat():
                return worded("I ask again; if nobody answers at all:")
            case ToHelper(helper=helper):
                return worded("I ask {helper}; if nobody answers at all:", helper=helper)
            case Mail():
                return worded("I write to the operators; if nobody answers at all:")
            case _:
                return ""

    # --- Turns --------------------------------------------------------------------------------

    async def _converse(
        self,
        dialogue: DialogueState,
        call: str,
        before: Sequence[ev.Event],
        proxy: RobotProxy,
        helper: str = "",
        pictures: Mapping[UUID, bytes] | None = None,
    ) -> list[ev.Event]:
        """Commit a call to the conversation: the events before it, and what it says to it."""
        events = self._said_after(dialogue, [call], proxy, helper)
        return await self._context.commit([*before, *events], pictures=pictures)

    def _said_after(
        self, dialogue: DialogueState, calls: Sequence[str], proxy: RobotProxy, helper: str
    ) -> list[ev.Event]:
        """The events of what the conversation says to the last of more calls."""
        script = self._context.state.scripts[dialogue.raised.issue]
        turns = dialogue.turns_after(calls, script, self._outlook(dialogue, proxy))
        make = self._make(dialogue)
        stopped = self._why_it_cannot_go_on(dialogue, proxy)
        waits = dialogue.raised.interrupts
        return self._of_turns(make, turns, helper, waits=waits, stopped=stopped)

    def _why_it_cannot_go_on(self, dialogue: DialogueState, proxy: RobotProxy) -> str | None:
        """Why a robot cannot go on with what it was doing when it needed help; None if it can."""
        state = self._context.state
        leaf = state.tree.index_of(dialogue.raised.node)
        execution = state.execution_of(leaf)
        has_it = (
            execution is not None
            and proxy.hello is not None
            and execution.boot == proxy.hello.boot
            and not proxy.gone_for_good
        )
        return None if has_it else "the robot had lost what it was doing"

    def _outlook(self, dialogue: DialogueState, proxy: RobotProxy) -> Outlook:
        """What follows, as things are now."""
        state, raised = self._context.state, dialogue.raised
        begins_anew = self._why_it_cannot_go_on(dialogue, proxy) is not None
        leaf, outlook = state.tree.index_of(raised.node), raised.outlook or Outlook()
        return outlook_now(state, proxy, leaf, outlook, begins_anew=begins_anew)

    def _of_turns(
        self,
        make: DialogueEvents,
        turns: Sequence[Turn],
        helper: str,
        *,
        waits: bool,
        stopped: str | None,
    ) -> list[ev.Event]:
        """The events of turns; only where the robot `waits` for an answer is it asked for again."""
        now, settings = self._context.clock.now(), self._context.settings
        duty = self._duty().without(make.dialogue)
        to = first_helper(self._policy, duty, waits=waits, answering=helper)
        return make.of_turns(
            turns,
            ask_deadline=now + self._policy.answer_within_s,
            if_silent=self._if_silent(Standing((to,)), make.dialogue) if waits else "",
            to=to,
            help_until=now + settings.help_window_s,
            helper=helper,
            stopped=stopped,
        )

    async def _help_looked_for(
        self,
        dialogue: DialogueState,
        awaiting: ev.HelpAwaited,
        proxy: RobotProxy,
        fulfilled: bool,
    ) -> None:
        make = self._make(dialogue)
        if fulfilled:
            change = self._looks.change_seen(dialogue, proxy, awaiting.help)
            at_place = self._looks.is_at_place(dialogue, proxy)
            verified = make.help_verified(awaiting, change, at_place=at_place)
            await self._converse(dialogue, seen_call(verified), [verified], proxy, dialogue.helper)
            return
        over = has_come(self._context.clock, awaiting.until)
        if not over and dialogue.reported is None:
            return
        seen = unseen_help(dialogue, proxy, awaiting.help)
        make_unseen = make.help_not_seen if over else make.help_not_seen_yet
        unseen = make_unseen(awaiting, seen)
        await self._converse(dialogue, call_of(unseen), [unseen], proxy, pictures=seen.pictures)

    @property
    def _rate(self) -> float | None:
        """How fast the clock may run while somebody is asked."""
        if not self._answers.live:
            return None
        return rate_while_asked(self._context.state.started.speed)


def _standing(dialogue: DialogueState) -> Standing:
    return Standing(tuple(dialogue.asked_of), dialogue.mailed)


def _open_ask(dialogue: DialogueState, prompt: UUID) -> ev.Prompt:
    """The open question. Raises `LostRaceError`, `ConflictError` or `NotFoundError`."""
    if prompt not in dialogue.prompts:
        raise NotFoundError(f"there is no prompt {prompt} in this dialogue")
    if prompt in dialogue.answers:
        raise LostRaceError(prompt, dialogue.answers[prompt].helper)
    if dialogue.closed is not None:
        raise ConflictError(f"this dialogue is closed ({dialogue.closed})")
    ask = dialogue.open_ask
    if ask is None or ask.prompt != prompt:
        raise ConflictError("this prompt does not wait for an answer")
    return ask


def _no_such_way(way: str, ways: Sequence[Way]) -> str:
    if not ways:
        return "this question takes yes or no, and no way of help by its name"
    there_are = ", ".join(each.name for each in ways)
    return f"'{way}' is no way to answer this question: there are {there_are}"
