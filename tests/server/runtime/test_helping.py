"""What helpers may do with an open question: answer it, claim it, take it over, get more time."""

import asyncio
import base64
from collections.abc import AsyncIterator
from pathlib import Path

import pytest
from answer_races import ONE_PART, race
from pretend_robots import FIRST_JPEG, SECOND_JPEG
from pretend_service import PretendService, pretend_service

from mend.errors import ConflictError, NotFoundError
from mend.robots.link.messages import ClipPicture, ClipTaken
from mend.server.dialogues.escalation import EscalationPolicy
from mend.server.journal import events as ev
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import DialogueView, PromptView

FAULT = {"part_1": [("missed", 4)]}


async def open_question(service: PretendService) -> DialogueView:
    request = {"tree": "tree", "world": "tabletop", "speed": "max"}
    await service.runtime.start_run(RunRequest.model_validate(request))
    return await service.first_question()


def prompt_in(view: DialogueView) -> PromptView:
    assert view.prompt is not None
    return view.prompt


@pytest.fixture
async def service() -> AsyncIterator[PretendService]:
    async with pretend_service(ONE_PART, FAULT, patient=True) as service:
        yield service


# --- Racing -----------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", [1, 2])
async def test_of_helpers_who_answer_at_once_exactly_one_wins(seed: int) -> None:
    found = await race(races=80, helpers=6, seed=seed)
    assert found.races == 80
    assert found.doubled == 0
    assert found.unanswered == 0
    assert found.answers == 80
    assert found.refused == 80 * 5
    assert found.told_the_winner > 0
    assert found.mistold == 0


# --- Claims -----------------------------------------------------------------------------------


async def test_a_claim_is_taken_over_from_another_helper(service: PretendService) -> None:
    dialogue = (await open_question(service)).dialogue
    await service.runtime.dialogues.claim(dialogue, "ann")
    with pytest.raises(ConflictError, match="ann"):
        await service.runtime.dialogues.claim(dialogue, "bob")
    taken = await service.runtime.dialogues.claim(dialogue, "bob", take_over=True)
    assert taken.claimed_by == "bob"
    with pytest.raises(ConflictError, match="bob"):
        await service.runtime.dialogues.claim(dialogue, "ann")
    events = await service.journal.read(0, 1000)
    told = [
        (type(each), each.helper) for each in events if isinstance(each, ev.Claimed | ev.Released)
    ]
    assert told == [(ev.Claimed, "ann"), (ev.Released, "ann"), (ev.Claimed, "bob")]


async def test_nobody_fills_the_journal_with_claims(
    service: PretendService, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("mend.server.runtime.claims.MOST_CLAIMS", 5)
    question = await open_question(service)
    for _ in range(2):
        for helper in ("ann", "bob"):
            await service.runtime.dialogues.claim(question.dialogue, helper, take_over=True)
    await service.runtime.dialogues.claim(question.dialogue, "bob")
    head = service.journal.head
    for take_over in (False, True):
        with pytest.raises(ConflictError, match="can be answered, not claimed") as refused:
            await service.runtime.dialogues.claim(question.dialogue, "bob", take_over=take_over)
        assert refused.value.limit == "claims"
    assert service.journal.head == head
    await service.runtime.dialogues.answer(
        question.dialogue, prompt_in(question).prompt, "yes", "ann"
    )


async def test_taking_over_ones_own_or_nobodys_claim_only_renews_it(
    service: PretendService,
) -> None:
    dialogue = (await open_question(service)).dialogue
    first = await service.runtime.dialogues.claim(dialogue, "ann", take_over=True)
    again = await service.runtime.dialogues.claim(dialogue, "ann", take_over=True)
    assert first.claimed_until is not None
    assert again.claimed_until is not None
    assert again.claimed_until >= first.claimed_until
    events = await service.journal.read(0, 1000)
    assert not [each for each in events if isinstance(each, ev.Released)]


async def test_a_claim_that_was_taken_over_never_blocks_an_answer(service: PretendService) -> None:
    view = await open_question(service)
    await service.runtime.dialogues.claim(view.dialogue, "ann")
    await service.runtime.dialogues.claim(view.dialogue, "bob", take_over=True)
    answered = await service.runtime.dialogues.answer(
        view.dialogue, prompt_in(view).prompt, "no", "cem"
    )
    assert answered.helper == "cem"


# --- More time --------------------------------------------------------------------------------


async def test_more_time_moves_the_deadline_by_its_original_length(
    service: PretendService,
) -> None:
    view = await open_question(service)
    before = prompt_in(view)
    assert before.deadline is not None
    assert before.within_s == pytest.approx(60.0)
    assert before.extensions_left == 10
    for number in (1, 2):
        extended = await service.runtime.dialogues.extend(view.dialogue, before.prompt, "ann")
        assert extended.deadline == pytest.approx(before.deadline + 60.0 * number)
        assert extended.helper == "ann"
        after = prompt_in(await service.runtime.dialogues.view(view.dialogue))
        assert after.deadline == extended.deadline
        assert after.extensions_left == extended.extensions_left == 10 - number
        assert after.prompt == before.prompt
        assert after.within_s == before.within_s


async def test_more_time_is_given_ten_times_and_no_more(service: PretendService) -> None:
    view = await open_question(service)
    for _ in range(10):
        await service.runtime.dialogues.extend(view.dialogue, prompt_in(view).prompt, "ann")
    head = service.journal.head
    with pytest.raises(ConflictError, match="10 times") as refused:
        await service.runtime.dialogues.extend(view.dialogue, prompt_in(view).prompt, "bob")
    assert refused.value.limit == "extensions"
    assert service.journal.head == head


async def test_the_next_question_of_a_dialogue_has_its_own_time(service: PretendService) -> None:
    view = await open_question(service)
    for _ in range(10):
        await service.runtime.dialogues.extend(view.dialogue, prompt_in(view).prompt, "ann")
    await service.runtime.dialogues.answer(view.dialogue, prompt_in(view).prompt, "no", "ann")
    second = prompt_in(await service.runtime.dialogues.view(view.dialogue))
    assert second.prompt != prompt_in(view).prompt
    assert second.extensions_left == 10
    with pytest.raises(ConflictError):
        await service.runtime.dialogues.extend(view.dialogue, prompt_in(view).prompt, "ann")
    with pytest.raises(NotFoundError):
        await service.runtime.dialogues.extend(view.dialogue, view.dialogue, "ann")


async def test_nobody_is_asked_instead_before_the_moved_deadline() -> None:
    policy = EscalationPolicy(helpers=("ann", "bob"), repeats=0, answer_within_s=20.0)
    async with pretend_service(ONE_PART, FAULT, policy=policy, patient=True) as service:
        view = await open_question(service)
        extended = await service.runtime.dialogues.extend(
            view.dialogue, prompt_in(view).prompt, "ann"
        )
        robot = next(iter(service.robots.robots.values()))
        robot.patient = False
        await service.runtime.pause(view.run)
        await service.runtime.resume(view.run)
        await service.runtime.wait_for_end(view.run)
        events = await service.journal.read(0, 10_000)
    escalated = next(each for each in events if isinstance(each, ev.Escalated))
    assert escalated.to == "bob"
    assert escalated.time >= extended.deadline
    repeated = [each for each in events if isinstance(each, ev.Prompt) and each.to == "bob"]
    assert repeated[0].deadline == pytest.approx(escalated.time + 20.0)


async def test_a_restart_keeps_the_moved_deadline_and_what_is_left(tmp_path: Path) -> None:
    path = tmp_path / "journal.db"
    async with pretend_service(ONE_PART, FAULT, journal=path, patient=True) as service:
        view = await open_question(service)
        await service.runtime.dialogues.extend(view.dialogue, prompt_in(view).prompt, "ann")
        before = await service.runtime.dialogues.view(view.dialogue)
    async with pretend_service(ONE_PART, journal=path, patient=True, boot=2) as service:
        after = await service.runtime.dialogues.view(view.dialogue)
        assert after.prompt == before.prompt
        extended = await service.runtime.dialogues.extend(
            view.dialogue, prompt_in(view).prompt, "bob"
        )
        assert extended.extensions_left == 8


# --- The clip ---------------------------------------------------------------------------------


async def test_the_clip_of_a_fault_is_kept_after_the_question_and_belongs_to_it() -> None:
    async with pretend_service(ONE_PART, FAULT, patient=True, films=True) as service:
        view = await open_question(service)
        async with asyncio.timeout(60):
            while not (await service.runtime.dialogues.view(view.dialogue)).clip:  # noqa: ASYNC110
                await asyncio.sleep(0)
        events = await service.journal.read(0, 1000)
        clip = (await service.runtime.dialogues.view(view.dialogue)).clip
        pictures = [await service.journal.picture(each.picture) for each in clip]
    raised = next(each for each in events if isinstance(each, ev.IssueRaised))
    recorded = next(each for each in events if isinstance(each, ev.ClipRecorded))
    prompt = next(each for each in events if isinstance(each, ev.Prompt))
    assert raised.seq < prompt.seq < recorded.seq
    assert (recorded.dialogue, recorded.issue) == (view.dialogue, "missed")
    assert recorded.execution == raised.execution
    assert [each.time for each in clip] == pytest.approx(
        [max(0.0, raised.time - 1.5), max(0.0, raised.time - 0.5)]
    )
    assert pictures == [FIRST_JPEG, SECOND_JPEG]
    assert recorded.pictures == clip


async def test_a_clip_of_no_dialogue_is_not_kept(service: PretendService) -> None:
    view = await open_question(service)
    (robot,) = service.robots.robots.values()
    head = service.journal.head
    clip = ClipTaken(execution="other", issue="missed", pictures=[])
    await service.robots.report(robot, clip)
    assert service.journal.head == head
    assert (await service.runtime.dialogues.view(view.dialogue)).clip == []


async def test_a_second_clip_of_one_issue_is_not_kept() -> None:
    async with pretend_service(ONE_PART, FAULT, patient=True, films=True) as service:
        view = await open_question(service)
        async with asyncio.timeout(60):
            while not (first := (await service.runtime.dialogues.view(view.dialogue)).clip):  # noqa: ASYNC110
                await asyncio.sleep(0)
        events = await service.journal.read(0, 1000)
        raised = next(each for each in events if isinstance(each, ev.IssueRaised))
        (robot,) = service.robots.robots.values()
        picture = ClipPicture(
            before_s=0.1, jpeg=base64.b64encode(b"\xff\xd8\xff third \xff\xd9").decode()
        )
        again = ClipTaken(execution=str(raised.execution), issue="missed", pictures=[picture])
        await service.robots.report(robot, again)
        kept = await service.journal.read(0, 1000)
        assert sum(isinstance(each, ev.ClipRecorded) for each in kept) == 1
        assert (await service.runtime.dialogues.view(view.dialogue)).clip == first
