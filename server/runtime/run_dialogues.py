"""The dialogues of all runs, and what helpers do in them."""

from collections.abc import Awaitable, Callable, Sequence
from itertools import islice
from typing import Literal, cast
from uuid import UUID

from mend.errors import ConflictError, NotFoundError, RefusalError
from mend.server.errors import LostRaceError
from mend.server.journal import events as ev
from mend.server.runtime.dialogue_state import DialogueState
from mend.server.runtime.question_queue import (
    OpenQuestion,
    batches_of,
    open_questions,
    ways_for_all,
)
from mend.server.runtime.robot_proxy import RobotProxy
from mend.server.runtime.run import Run
from mend.server.runtime.run_state import RunState
from mend.server.runtime.run_states import RunStates
from mend.server.runtime.run_views import dialogue_view
from mend.server.runtime.views import ChosenView, DialogueView, QuestionBatchView

Take = Callable[[Run, DialogueState, RobotProxy], Awaitable[ev.Answered]]
"""Takes a helper's answer in a run, to a dialogue that a robot of it has opened."""


class RunDialogues:
    """Implements `mend.server.runtime.service.DialogueService`.

    `running`: a run that goes on. It raises `NotFoundError`, `UnreadableError` and `ConflictError`.
    `now_of`: the clock of one.
    """

    def __init__(
        self,
        states: RunStates,
        running: Callable[[UUID], Awaitable[Run]],
        now_of: Callable[[RunState], float],
    ) -> None:
        self._states, self._running, self._now_of = states, running, now_of

    async def page(
        self, status: Literal["open", "closed"] | None, limit: int, offset: int
    ) -> list[DialogueView]:
        """A page of dialogues, oldest first; without those of runs that cannot be read."""
        if status == "open":
            # Whoever hears of an event finds it here already; the index is a moment ahead of that.
            opened = self._states.open_dialogues()
            return [dialogue_view(each) for each in islice(opened, offset, offset + limit)]
        page = await self._states.page_of_dialogues(status, limit, offset)
        views = [dialogue_view(each) for each in page]
        return [each for each in views if status is None or each.status == status]

    def count_open(self) -> int:
        """How many dialogues are open."""
        return sum(1 for _ in self._states.open_dialogues())

    def questions(self) -> list[QuestionBatchView]:
        """The open questions of all runs, the most urgent first; those alike stand together."""
        return batches_of(self._open_questions())

    async def choose_for_all(
        self, way: str, prompts: Sequence[UUID], helper: str, author: ev.Author | None = None
    ) -> list[ChosenView]:
        """Choose a way for several open questions; each is told what became of it.

        Raises `NotFoundError` where one of them is not open, and `ConflictError` where the way is
        not safe to be chosen for all of them at once.
        """
        open_ = {each.view.prompt: each for each in self._open_questions()}
        for prompt in prompts:
            if prompt not in open_:
                raise NotFoundError(f"there is no open question {prompt}")
        batch = [open_[prompt] for prompt in dict.fromkeys(prompts)]
        if len(batch) > 1 and way not in {each.way for each in ways_for_all(batch)}:
            raise ConflictError(
                f"'{way}' cannot be chosen for these {len(batch)} questions at once: "
                "answer each on its own"
            )
        return [await self._chosen(each, way, helper, author) for each in batch]

    async def _chosen(
        self, question: OpenQuestion, way: str, helper: str, author: ev.Author | None
    ) -> ChosenView:
        dialogue, prompt = question.view.dialogue, question.view.prompt
        try:
            await self.choose(dialogue, prompt, way, helper, author)
        except RefusalError as error:
            return ChosenView(dialogue=dialogue, prompt=prompt, refused=str(error))
        return ChosenView(dialogue=dialogue, prompt=prompt)

    def _open_questions(self) -> list[OpenQuestion]:
        return open_questions((state, self._now_of(state)) for state in self._states.all_going_on())

    async def view(self, dialogue: UUID) -> DialogueView:
        """One dialogue. Raises `NotFoundError` or `UnreadableError`."""
        return dialogue_view(await self._states.find_dialogue(dialogue))

    async def answer(
        self,
        dialogue: UUID,
        prompt: UUID,
        answer: Literal["yes", "no"],
        helper: str,
        author: ev.Author | None = None,
    ) -> ev.Answered:
        """Answer a prompt: the first answer wins.

        Raises `NotFoundError`, `LostRaceError` or `ConflictError`.
        """
        return await self._answered(
            dialogue,
            prompt,
            lambda run, found, proxy: run.dialogues.answer(
                found, prompt, answer, helper, proxy, author
            ),
        )

    async def choose(
        self,
        dialogue: UUID,
        prompt: UUID,
        way: str,
        helper: str,
        author: ev.Author | None = None,
    ) -> ev.Answered:
        """Choose a way of help at once: what it stands for is answered, and the last returned.

        Raises as `answer` does, and `ConflictError` where there is no such way now.
        """
        return await self._answered(
            dialogue,
            prompt,
            lambda run, found, proxy: run.dialogues.choose(
                found, prompt, way, helper, proxy, author
            ),
        )

    async def _answered(self, dialogue: UUID, prompt: UUID, take: Take) -> ev.Answered:
        found = await self._put_to_people(dialogue)
        try:
            run = await self._running(found.opened.run)
            proxy = run.proxies[found.opened.robot]
            answered = await run.request(lambda: take(run, found, proxy))
        except ConflictError:
            # Who was first is told also where that answer has ended the run.
            if prompt in found.answers:
                raise LostRaceError(prompt, found.answers[prompt].helper) from None
            raise
        return cast(ev.Answered, answered)

    async def extend(
        self, dialogue: UUID, prompt: UUID, helper: str, author: ev.Author | None = None
    ) -> ev.DeadlineExtended:
        """Give the open question more time. Raises `NotFoundError` or `ConflictError`."""
        found = await self._put_to_people(dialogue)
        run = await self._running(found.opened.run)
        extended = await run.request(lambda: run.dialogues.extend(found, prompt, helper, author))
        return cast(ev.DeadlineExtended, extended)

    async def said_done(
        self, dialogue: UUID, helper: str, author: ev.Author | None = None
    ) -> ev.HelpReported:
        """Somebody says that awaited help is done. Raises `NotFoundError` or `ConflictError`."""
        found = await self._put_to_people(dialogue)
        run = await self._running(found.opened.run)
        proxy = run.proxies[found.opened.robot]
        said = await run.request(lambda: run.dialogues.word.said_done(found, helper, proxy, author))
        return cast(ev.HelpReported, said)

    async def take_back(
        self, dialogue: UUID, helper: str, author: ev.Author | None = None
    ) -> ev.PromiseTakenBack:
        """Take a promise back. Raises `NotFoundError` or `ConflictError`."""
        found = await self._put_to_people(dialogue)
        run = await self._running(found.opened.run)
        proxy = run.proxies[found.opened.robot]
        done = await run.request(lambda: run.dialogues.word.take_back(found, helper, proxy, author))
        return cast(ev.PromiseTakenBack, done)

    async def claim(
        self,
        dialogue: UUID,
        helper: str,
        *,
        take_over: bool = False,
        author: ev.Author | None = None,
    ) -> DialogueView:
        """Show the others that a helper is on it.

        Raises `ConflictError` while another is, unless it is taken over from them.
        """
        found = await self._put_to_people(dialogue)
        run = await self._running(found.opened.run)
        await run.request(
            lambda: run.claims.claim(found, helper, take_over=take_over, author=author)
        )
        return dialogue_view(found)

    async def release(
        self, dialogue: UUID, helper: str, author: ev.Author | None = None
    ) -> DialogueView:
        """Give up a claim. Raises `ConflictError` without one."""
        found = await self._states.find_dialogue(dialogue)
        run = await self._running(found.opened.run)
        await run.request(lambda: run.claims.release(found, helper, author))
        return dialogue_view(found)

    async def _put_to_people(self, dialogue: UUID) -> DialogueState:
        found = await self._states.find_dialogue(dialogue)
        if found.opened.scripted:
            raise ConflictError(
                "the script of this run answers its questions: people are not asked"
            )
        return found
