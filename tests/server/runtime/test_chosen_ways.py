"""A way of help that is chosen at once is journaled as the answers that it stands for."""

import asyncio
from collections.abc import AsyncIterator
from typing import Any
from uuid import UUID, uuid4

import pytest
from answer_races import ONE_PART
from pretend_service import PretendService, pretend_service

from mend.errors import ConflictError, NotFoundError
from mend.server.errors import LostRaceError
from mend.server.journal import events as ev
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import DialogueView, PromptView
from mend.tasks.scenario import Person

FAULT = {"part_1": [("missed", 4)]}


@pytest.fixture
async def service() -> AsyncIterator[PretendService]:
    async with pretend_service(ONE_PART, FAULT, patient=True) as service:
        yield service


async def asked(service: PretendService, helper: str = "ann") -> tuple[DialogueView, PromptView]:
    """The robot asks, and somebody is on it."""
    request = RunRequest(tree="tree", world="tabletop", speed="max", person=Person(never=1.0))
    await service.runtime.start_run(request)
    async with asyncio.timeout(60):
        while True:
            for view in await service.runtime.dialogues.page("open", 10, 0):
                if view.awaiting == "answer" and view.prompt is not None:
                    await service.runtime.dialogues.claim(view.dialogue, helper)
                    return view, view.prompt
            await asyncio.sleep(0)


async def in_the_journal(service: PretendService, dialogue: UUID) -> list[dict[str, Any]]:
    """What a dialogue has come to, without what no two dialogues have in common."""
    own = {"seq", "time", "wall_time", "run", "dialogue", "prompt", "robot", "deadline", "until"}
    events = await service.journal.read(0, 10_000)
    return [
        each.model_dump(exclude=own)
        for each in events
        if isinstance(each, ev.Prompt | ev.Answered | ev.HelpAwaited | ev.Resolved | ev.Released)
        and each.dialogue == dialogue
    ]


async def told(service: PretendService, *answers: str) -> list[dict[str, Any]]:
    view, _ = await asked(service)
    for answer in answers:
        now = (await service.runtime.dialogues.view(view.dialogue)).prompt
        assert now is not None
        await service.runtime.dialogues.answer(
            view.dialogue, now.prompt, "yes" if answer == "yes" else "no", "ann"
        )
    return await in_the_journal(service, view.dialogue)


@pytest.mark.parametrize(
    ("way", "answers"),
    [("put_back", ["yes"]), ("place", ["no", "yes"]), ("later", ["no", "no"])],
)
async def test_the_journal_says_what_it_says_of_the_same_answers(
    way: str, answers: list[str]
) -> None:
    async with pretend_service(ONE_PART, FAULT, patient=True) as one_by_one:
        expected = await told(one_by_one, *answers)
    async with pretend_service(ONE_PART, FAULT, patient=True) as at_once:
        view, prompt = await asked(at_once)
        answered = await at_once.runtime.dialogues.choose(view.dialogue, prompt.prompt, way, "ann")
        assert answered.answer == answers[-1]
        chosen = await in_the_journal(at_once, view.dialogue)
    assert [each["answer"] for each in chosen if each["type"] == "answered"] == answers
    assert chosen == expected


async def test_all_its_answers_are_in_one_entry_of_the_journal(service: PretendService) -> None:
    view, prompt = await asked(service)
    await service.runtime.dialogues.choose(view.dialogue, prompt.prompt, "place", "ann")
    events = await service.journal.read(0, 10_000)
    first = next(index for index, each in enumerate(events) if isinstance(each, ev.Answered))
    assert [each.type for each in events[first : first + 5]] == [
        "answered",
        "prompt",
        "answered",
        "prompt",
        "help_awaited",
    ]


async def test_the_prompt_says_what_may_be_chosen(service: PretendService) -> None:
    _, prompt = await asked(service)
    assert prompt.headline == "Put the part 1 back on the table"
    assert [each.way for each in prompt.ways] == ["put_back", "place", "later"]
    assert prompt.ways[1].effect.startswith("You put the part 1 at its place; it is done once")


async def test_who_was_on_it_is_so_no_more_where_somebody_else_chooses(
    service: PretendService,
) -> None:
    view, prompt = await asked(service, helper="bob")
    await service.runtime.dialogues.choose(view.dialogue, prompt.prompt, "place", "ann")
    now = await service.runtime.dialogues.view(view.dialogue)
    assert (now.claimed_by, now.answered_by) == (None, "ann")


async def test_a_way_that_there_is_not_is_refused_with_those_that_there_are(
    service: PretendService,
) -> None:
    view, prompt = await asked(service)
    with pytest.raises(
        ConflictError,
        match="'left_out' is no way to answer this question: there are put_back, place, later",
    ):
        await service.runtime.dialogues.choose(view.dialogue, prompt.prompt, "left_out", "ann")
    assert (await service.runtime.dialogues.view(view.dialogue)).awaiting == "answer"


async def test_a_choice_that_comes_late_hears_who_was_first(service: PretendService) -> None:
    view, prompt = await asked(service)
    await service.runtime.dialogues.choose(view.dialogue, prompt.prompt, "place", "bob")
    with pytest.raises(LostRaceError, match="bob"):
        await service.runtime.dialogues.choose(view.dialogue, prompt.prompt, "put_back", "ann")


async def test_what_was_refused_before_is_no_way_any_more(service: PretendService) -> None:
    view, prompt = await asked(service)
    await service.runtime.dialogues.answer(view.dialogue, prompt.prompt, "no", "ann")
    now = (await service.runtime.dialogues.view(view.dialogue)).prompt
    assert now is not None
    assert [each.way for each in now.ways] == ["place", "later"]
    with pytest.raises(ConflictError, match="'put_back' is no way"):
        await service.runtime.dialogues.choose(view.dialogue, now.prompt, "put_back", "ann")


async def test_a_question_that_there_is_not_is_not_found(service: PretendService) -> None:
    view, _ = await asked(service)
    with pytest.raises(NotFoundError, match="there is no prompt"):
        await service.runtime.dialogues.choose(view.dialogue, uuid4(), "place", "ann")


async def test_an_open_question_stands_in_the_queue_until_it_is_answered(
    service: PretendService,
) -> None:
    view, prompt = await asked(service)
    [batch] = service.runtime.dialogues.questions()
    [waiting] = batch.questions
    assert (waiting.dialogue, waiting.prompt) == (view.dialogue, prompt.prompt)
    assert (waiting.attempt, waiting.attempts, waiting.claimed_by) == (1, 3, "ann")
    assert waiting.place == "spot_1"
    assert batch.at_once == []
    chosen = await service.runtime.dialogues.choose_for_all("place", [prompt.prompt], "ann")
    assert [(each.prompt, each.refused) for each in chosen] == [(prompt.prompt, None)]
    assert service.runtime.dialogues.questions() == []
    with pytest.raises(NotFoundError, match="no open question"):
        await service.runtime.dialogues.choose_for_all("place", [prompt.prompt], "ann")


async def test_several_questions_take_only_what_is_safe_for_all(service: PretendService) -> None:
    _, first = await asked(service)
    await service.runtime.start_run(RunRequest(tree="tree", world="tabletop", speed="max"))
    async with asyncio.timeout(60):
        while len(service.runtime.dialogues.questions()[0].questions) < 2:  # noqa: ASYNC110
            await asyncio.sleep(0)
    [batch] = service.runtime.dialogues.questions()
    prompts = [each.prompt for each in batch.questions]
    assert first.prompt in prompts
    assert [each.way for each in batch.at_once] == ["later"]
    with pytest.raises(ConflictError, match="'put_back' cannot be chosen for these 2 questions"):
        await service.runtime.dialogues.choose_for_all("put_back", prompts, "ann")
    chosen = await service.runtime.dialogues.choose_for_all("later", prompts, "ann")
    assert [each.refused for each in chosen] == [None, None]
