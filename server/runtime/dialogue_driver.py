"""Keeps a run's open dialogues going: answers, deadlines, escalation, and looking for the help."""

from collections.abc import Callable, Sequence
from typing import Literal
from uuid import UUID, uuid4

import numpy as np

from dialogue.script import Expectation, Turn
from server.dialogues.answers import AnswerSource
from server.dialogues.escalation import (
    EscalationPolicy,
    Exhausted,
    Mail,
    Repeat,
    ToHelper,
    first_helper,
    next_rung,
)
from server.errors import ConflictError, LostRaceError, NotFoundError
from server.journal import events as ev
from server.runtime.at_place import is_at_place
from server.runtime.context import RunContext
from server.runtime.dialogue_events import DialogueEvents
from server.runtime.robot_side import Purpose, RobotSide
from server.runtime.run_state import EXPECTED, MOST_EXTENSIONS, DialogueState, rehearse
from sim.interventions import HELPER
from sim.person import Promise, deed
from tasks.scenario import Person

TOLERANCE_S = 1e-6
"""Two moments of the run's clock closer than this are the same."""

AT_PLACE_TOLERANCE_M = 0.03
"""An object seen this close to its place's centre counts as placed."""

Request = Callable[[ev.Escalated, DialogueState], None]
"""Sends the mail of an escalation."""


class DialogueDriver:
    """Drives the dialogues of one run. `person` is None where nobody is simulated."""

    def __init__(
        self,
        context: RunContext,
        answers: AnswerSource,
        policy: EscalationPolicy,
        person: Person | None,
        send_mail: Request,
    ) -> None:
        self._context = context
        self._answers = answers
        self._policy = policy
        self._person = person
        self._send_mail = send_mail
        self._was_right: dict[UUID, bool] = {}
        self._deeds_sent: set[str] = set()

    # --- What the run calls -------------------------------------------------------------------

    def robot_rebooted(self) -> None:
        """The world was rebuilt: what a person was about to do has to be asked for again."""
        self._deeds_sent.clear()

    def open(self, raised: ev.IssueRaised, before: Sequence[ev.Event]) -> list[ev.Event]:
        """The events that open a dialogue about an issue, with its first prompts."""
        make = DialogueEvents(self._context.stamp, uuid4(), raised)
        turns = rehearse(self._context.state.scripts[raised.issue], raised, ["open"])
        return [*before, make.opened(), *self._of_turns(make, turns, "", stopped=None)]

    async def drive(self, dialogue: DialogueState, side: RobotSide) -> bool:
        """Do what the dialogue needs now; True if that changed the state."""
        if dialogue.awaiting is not None:
            self._watch_for_help(dialogue, dialogue.awaiting, side)
            return False
        ask = dialogue.open_ask
        if ask is None:
            return False
        now = self._context.clock.now() + TOLERANCE_S
        scripted = self._scripted(dialogue, ask)
        if scripted is not None and now >= scripted[1]:
            await self._take_answer(dialogue, ask, scripted[0], "script", side)
            return True
        assert ask.deadline is not None, "every question has a deadline"
        if now >= ask.deadline:
            await self._nobody_answered(dialogue, ask, side)
            return True
        if side.free:
            due = min(ask.deadline, scripted[1]) if scripted else ask.deadline
            self._let_time_pass(dialogue, side, due)
        return False

    def next_due(self) -> float | None:
        """When, in the run's clock, the next answer or deadline is due."""
        dues = []
        for dialogue in self._context.state.open_dialogues:
            if (ask := dialogue.open_ask) is not None and ask.deadline is not None:
                scripted = self._scripted(dialogue, ask)
                dues.append(min(ask.deadline, scripted[1]) if scripted else ask.deadline)
        return min(dues, default=None)

    async def looked(
        self, dialogue: DialogueState, side: RobotSide, purpose: Purpose, fulfilled: bool
    ) -> None:
        """Take the answer of a look that was made for a dialogue."""
        if purpose is Purpose.BASELINE:
            self._was_right[dialogue.id] = fulfilled
        elif purpose is Purpose.WATCH and fulfilled and dialogue.open_ask is not None:
            seen = self._what_was_seen(dialogue, side)
            await self._converse(dialogue, f"put_right:{seen}", [], side)
        elif purpose is Purpose.HELP and dialogue.awaiting is not None:
            await self._help_looked_for(dialogue, dialogue.awaiting, side, fulfilled)

    async def answer(
        self,
        dialogue: DialogueState,
        prompt: UUID,
        answer: Literal["yes", "no"],
        helper: str,
        side: RobotSide,
    ) -> ev.Answered:
        """Take a live helper's answer; the first one wins.

        Raises `LostRaceError`, `ConflictError` (no longer open) or `NotFoundError` (no such
        prompt).
        """
        if prompt not in dialogue.prompts:
            raise NotFoundError(f"there is no prompt {prompt} in this dialogue")
        if prompt in dialogue.answers:
            raise LostRaceError(prompt, dialogue.answers[prompt].helper)
        ask = dialogue.open_ask
        if dialogue.closed is not None:
            raise ConflictError(f"this dialogue is closed ({dialogue.closed})")
        if ask is None or ask.prompt != prompt:
            raise ConflictError("this prompt does not wait for an answer")
        return await self._take_answer(dialogue, ask, answer, helper, side)

    async def extend(
        self, dialogue: DialogueState, prompt: UUID, helper: str
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
                f"this question was given more time {MOST_EXTENSIONS} times already"
            )
        make = self._make(dialogue)
        event = make.extended(ask, ask.deadline + length_s, left, helper)
        (extended,) = await self._context.commit([event])
        assert isinstance(extended, ev.DeadlineExtended), "what is committed keeps its type"
        return extended

    def abort(self, dialogue: DialogueState) -> ev.DialogueClosed:
        """The event that ends a dialogue because its run, robot or alternative ends."""
        return self._make(dialogue).aborted()

    # --- Silence and answers ------------------------------------------------------------------

    def _make(self, dialogue: DialogueState) -> DialogueEvents:
        return DialogueEvents(self._context.stamp, dialogue.id, dialogue.raised)

    def _scripted(
        self, dialogue: DialogueState, ask: ev.Prompt
    ) -> tuple[Literal["yes", "no"], float] | None:
        """The scripted answer to the open question and when it is due."""
        if self._answers.live:
            return None
        scripted = self._answers.next_answer(dialogue.ask_number)
        return None if scripted.answer is None else (scripted.answer, ask.time + scripted.delay_s)

    async def _take_answer(
        self,
        dialogue: DialogueState,
        ask: ev.Prompt,
        answer: Literal["yes", "no"],
        helper: str,
        side: RobotSide,
    ) -> ev.Answered:
        answered = self._make(dialogue).answered(ask, answer, helper)
        committed = await self._converse(dialogue, answer, [answered], side, helper)
        return next(each for each in committed if isinstance(each, ev.Answered))

    async def _nobody_answered(
        self, dialogue: DialogueState, ask: ev.Prompt, side: RobotSide
    ) -> None:
        make = self._make(dialogue)
        now = self._context.clock.now()
        match next_rung(self._policy, ask.version):
            case Repeat(helper=helper, answer_within_s=within_s):
                await self._context.commit([make.repeat(ask, now + within_s, helper)])
            case ToHelper(helper=helper, answer_within_s=within_s):
                escalated = make.escalated("helper", helper)
                await self._context.commit([escalated, make.repeat(ask, now + within_s, helper)])
            case Mail(addresses=addresses, answer_within_s=within_s):
                escalated = make.escalated("mail", ", ".join(addresses))
                await self._context.commit([escalated, make.repeat(ask, now + within_s, ask.to)])
                self._send_mail(escalated, dialogue)
            case Exhausted():
                await self._converse(dialogue, "silence", [], side)

    # --- Turns --------------------------------------------------------------------------------

    async def _converse(
        self,
        dialogue: DialogueState,
        call: str,
        before: Sequence[ev.Event],
        side: RobotSide,
        helper: str = "",
    ) -> list[ev.Event]:
        """Commit a call to the conversation: the events before it, and what it says to it."""
        turns = dialogue.turns_after(call, self._context.state.scripts[dialogue.raised.issue])
        make = self._make(dialogue)
        stopped = self._why_it_cannot_go_on(dialogue, side)
        events = self._of_turns(make, turns, helper, stopped=stopped)
        return await self._context.commit([*before, *events])

    def _why_it_cannot_go_on(self, dialogue: DialogueState, side: RobotSide) -> str | None:
        """Why a robot cannot go on with what it was doing when it needed help; None if it can."""
        state, settings = self._context.state, self._context.settings
        leaf = state.tree.index_of(dialogue.raised.node)
        execution = state.execution_of(leaf)
        has_it = (
            execution is not None
            and side.hello is not None
            and execution.boot == side.hello.boot
            and not side.gone_for_good
        )
        if not has_it:
            return "the robot had lost what it was doing"
        if state.helped_retries[leaf] >= settings.max_helped_retries:
            return f"it was helped {settings.max_helped_retries} times before"
        return None

    def _of_turns(
        self, make: DialogueEvents, turns: Sequence[Turn], helper: str, *, stopped: str | None
    ) -> list[ev.Event]:
        now, settings = self._context.clock.now(), self._context.settings
        return make.of_turns(
            turns,
            ask_deadline=now + self._policy.answer_within_s,
            to=first_helper(self._policy),
            help_until=now + settings.help_window_s,
            helper=helper,
            stopped=stopped,
        )

    # --- Looking ------------------------------------------------------------------------------

    @property
    def _rate(self) -> float | None:
        """How fast the clock may run while somebody is asked."""
        if not self._answers.live:
            return None
        speed = self._context.state.started.speed
        return 1.0 if speed == "max" else min(1.0, speed)

    def _let_time_pass(self, dialogue: DialogueState, side: RobotSide, due: float) -> None:
        """Until somebody answers, see whether it is put right; let a simulated clock run."""
        watched = dialogue.conversation.watched_for
        wait_s = max(0.0, due - self._context.clock.now())
        if watched:
            expect = Expectation.IN_REACH if Expectation.IN_REACH in watched else watched[0]
            fields = {
                "object": dialogue.raised.object,
                "place": dialogue.raised.place,
                "expect": str(expect),
            }
            if dialogue.id not in self._was_right:
                side.look(Purpose.BASELINE, **fields)
                return
            if not self._was_right[dialogue.id]:
                side.look(Purpose.WATCH, **fields, within_s=wait_s, rate=self._rate)
                return
        if side.hello is not None and side.hello.simulated:
            side.hold(self._context.clock.to_robot(due), self._rate)

    def _what_was_seen(self, dialogue: DialogueState, side: RobotSide) -> Expectation:
        """The most telling of what the script watches for and the last look saw."""
        watched = dialogue.conversation.watched_for
        if Expectation.AT_PLACE in watched and self._seen_at_place(dialogue, side):
            return Expectation.AT_PLACE
        return Expectation.IN_REACH if Expectation.IN_REACH in watched else watched[0]

    def _seen_at_place(self, dialogue: DialogueState, side: RobotSide) -> bool:
        scene = self._context.state.scene
        place = scene.places.get(dialogue.raised.place or "")
        seen = side.seen.get(dialogue.raised.object or "")
        if seen is None or place is None:
            return False
        return is_at_place(seen, place, scene, AT_PLACE_TOLERANCE_M)

    def _watch_for_help(
        self, dialogue: DialogueState, awaiting: ev.HelpAwaited, side: RobotSide
    ) -> None:
        if not (side.free or side.interruptible):
            return
        self._have_it_done(dialogue, awaiting, side)
        side.look(
            Purpose.HELP,
            object=dialogue.raised.object,
            place=dialogue.raised.place,
            expect=EXPECTED[awaiting.help],
            within_s=max(0.0, awaiting.until - self._context.clock.now()),
            rate=self._rate,
        )

    def _have_it_done(
        self, dialogue: DialogueState, awaiting: ev.HelpAwaited, side: RobotSide
    ) -> None:
        """Let the simulated person keep the promise, as reliably as they are."""
        state, command = self._context.state, f"{dialogue.id}:{dialogue.helps}"
        known = command in self._deeds_sent or command in state.intervened
        if self._person is None or not self._person.acts or known:
            return
        self._deeds_sent.add(command)
        rng = np.random.default_rng([state.started.seed, state.helps])
        raised = dialogue.raised
        promise = Promise(str(awaiting.help), raised.object, raised.place)
        finished = {
            state.tree.leaf_definition(leaf).object
            for leaf in state.tree.leaves
            if state.tree.done(leaf)
        }
        # Nobody takes for the promised object what stands finished at its place.
        others = [name for name in state.scene.objects if name not in {raised.object, *finished}]
        done = deed(promise, self._person, state.scene, others, rng)
        if done is not None:
            promised = awaiting.until - self._context.settings.help_window_s
            at = self._context.clock.to_robot(promised + done.delay_s)
            side.intervene(command, done.intervention, HELPER, at)

    async def _help_looked_for(
        self,
        dialogue: DialogueState,
        awaiting: ev.HelpAwaited,
        side: RobotSide,
        fulfilled: bool,
    ) -> None:
        make = self._make(dialogue)
        if fulfilled:
            await self._converse(dialogue, "seen", [make.help_verified(awaiting)], side)
        elif self._context.clock.now() + TOLERANCE_S >= awaiting.until:
            await self._converse(dialogue, "not_seen", [make.help_not_seen(awaiting)], side)
