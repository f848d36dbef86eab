"""Who promised help says that it is done, or cannot give it after all; and others may not."""

import asyncio
from collections.abc import AsyncIterator, Callable
from pathlib import Path
from typing import Any
from uuid import UUID

import pytest
from answer_races import ONE_PART
from pretend_robots import SECOND_JPEG, PretendRobot
from pretend_service import PretendService, pretend_service

from mend.dialogue.conversation import MOST_LOOKS
from mend.dialogue.script import Sight
from mend.errors import ConflictError
from mend.server.journal import events as ev
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import DialogueView, RunStatus

FAULT = {"part_1": [("missed", 4)]}
NOBODY_COMES = {"never": 1.0}


@pytest.fixture
async def service() -> AsyncIterator[PretendService]:
    async with pretend_service(ONE_PART, FAULT, patient=True, films=True) as service:
        yield service


async def view_when(
    service: PretendService, so: Callable[[DialogueView], bool], status: str = "open"
) -> DialogueView:
    """The one dialogue, once it is so."""
    async with asyncio.timeout(60):
        while True:
            found = await service.runtime.dialogues.page(None, 100, 0)
            if found and so(found[-1]) and (status == "any" or found[-1].status == status):
                return found[-1]
            await asyncio.sleep(0)


async def promised(service: PretendService, **options: Any) -> DialogueView:
    """Ann has said yes to the first question, and the robot watches."""
    request = {"tree": "tree", "world": "tabletop", "speed": "max", "person": NOBODY_COMES}
    await service.runtime.start_run(RunRequest.model_validate({**request, **options}))
    view = await view_when(service, lambda each: each.awaiting == "answer")
    assert view.prompt is not None
    await service.runtime.dialogues.answer(view.dialogue, view.prompt.prompt, "yes", "ann")
    async with asyncio.timeout(60):
        # What changes before it is no change that the robot sees.
        while not of_type(await events_of(service), ev.FirstLook):
            pass
    return await view_when(service, lambda each: each.awaiting == "help")


def the_robot(service: PretendService) -> PretendRobot:
    (robot,) = service.robots.robots.values()
    return robot


async def events_of(service: PretendService) -> list[ev.Event]:
    return await service.journal.read(0, 10_000)


def of_type(events: list[ev.Event], kind: type[Any]) -> list[Any]:
    return [each for each in events if isinstance(each, kind)]


async def said_done(service: PretendService, dialogue: UUID, helper: str = "ann") -> None:
    """Say so, and let the robot look."""
    await service.runtime.dialogues.said_done(dialogue, helper)
    await view_when(service, lambda each: each.help is None or each.help.reported_by is None, "any")


# --- Done, look again -------------------------------------------------------------------------


async def test_what_is_not_done_is_not_seen_and_the_robot_says_what_it_sees(
    service: PretendService,
) -> None:
    view = await promised(service)
    await said_done(service, view.dialogue)
    events = await events_of(service)
    [unseen] = of_type(events, ev.HelpNotSeenYet)
    assert unseen.sight is Sight.NOWHERE
    assert of_type(events, ev.Prompt)[-1].text == (
        "I do not see the part 1 where I can reach it yet. I do not see it at all. I keep watching."
    )
    assert not any("Thank you" in each.text for each in of_type(events, ev.Prompt))


async def test_it_goes_on_watching_as_long_as_it_was_to(service: PretendService) -> None:
    before = await promised(service)
    await said_done(service, before.dialogue)
    after = await view_when(service, lambda each: each.awaiting == "help")
    assert before.help is not None
    assert after.help == before.help


async def test_what_the_camera_showed_then_is_kept(service: PretendService) -> None:
    view = await promised(service)
    await said_done(service, view.dialogue)
    seen = (await service.runtime.dialogues.view(view.dialogue)).unseen_help
    assert seen is not None
    assert await service.journal.picture(seen.picture) == SECOND_JPEG


async def test_what_is_done_is_thanked_for_once_it_is_seen(service: PretendService) -> None:
    view = await promised(service)
    robot = the_robot(service)
    robot.right.add("part_1")
    robot.lost.discard("part_1")
    await said_done(service, view.dialogue)
    ended = await service.runtime.wait_for_end(view.run)
    assert ended.status is RunStatus.FINISHED
    events = await events_of(service)
    assert any(each.text.startswith("Thank you.") for each in of_type(events, ev.Prompt))
    [reported] = of_type(events, ev.HelpReported)
    [verified] = of_type(events, ev.HelpVerified)
    assert reported.seq < verified.seq
    assert of_type(events, ev.Resolved)[0].helped


async def test_somebody_else_who_is_there_may_say_so(service: PretendService) -> None:
    view = await promised(service)
    await said_done(service, view.dialogue, "bob")
    [reported] = of_type(await events_of(service), ev.HelpReported)
    assert reported.helper == "bob"


async def test_the_robot_does_not_look_at_a_word_without_end(
    service: PretendService,
) -> None:
    view = await promised(service)
    for _ in range(MOST_LOOKS):
        await said_done(service, view.dialogue)
    with pytest.raises(ConflictError, match="goes on looking by itself") as refused:
        await service.runtime.dialogues.said_done(view.dialogue, "ann")
    assert refused.value.limit == "looks_at_a_word"
    assert len(of_type(await events_of(service), ev.HelpReported)) == MOST_LOOKS


async def test_while_the_robot_looks_it_needs_no_other_word(service: PretendService) -> None:
    view = await promised(service)
    the_robot(service).deaf = True
    await service.runtime.dialogues.said_done(view.dialogue, "ann")
    with pytest.raises(ConflictError, match="ann has said so"):
        await service.runtime.dialogues.said_done(view.dialogue, "bob")


async def test_a_restart_still_looks_at_the_word(tmp_path: Path) -> None:
    path = tmp_path / "journal.db"
    async with pretend_service(ONE_PART, FAULT, journal=path, patient=True) as service:
        view = await promised(service)
        the_robot(service).deaf = True
        await service.runtime.dialogues.said_done(view.dialogue, "ann")
    async with pretend_service(
        ONE_PART, journal=path, patient=True, boot=2, lost={"part_1"}
    ) as service:
        await view_when(service, lambda each: each.help is not None and not each.help.reported_by)
        assert len(of_type(await events_of(service), ev.HelpNotSeenYet)) == 1


# --- I can't after all ------------------------------------------------------------------------


async def test_a_promise_taken_back_leads_to_what_a_no_would_lead_to(
    service: PretendService,
) -> None:
    view = await promised(service)
    taken_back = await service.runtime.dialogues.take_back(view.dialogue, "ann")
    assert taken_back.helper == "ann"
    after = await service.runtime.dialogues.view(view.dialogue)
    assert after.awaiting == "answer"
    assert after.help is None
    assert after.prompt is not None
    assert after.prompt.text == "Will you place the part 1 yourself?"


async def test_the_dialogue_goes_on_from_there(service: PretendService) -> None:
    view = await promised(service)
    await service.runtime.dialogues.take_back(view.dialogue, "ann")
    asked = (await service.runtime.dialogues.view(view.dialogue)).prompt
    assert asked is not None
    await service.runtime.dialogues.answer(view.dialogue, asked.prompt, "yes", "bob")
    robot = the_robot(service)
    robot.right.add("part_1")
    robot.placed.add("part_1")
    robot.lost.discard("part_1")
    await said_done(service, view.dialogue, "bob")
    await view_when(service, lambda each: each.status == "closed", "any")
    [done, *_] = of_type(await events_of(service), ev.NodeDone)
    assert done.by == "human"


async def test_it_may_be_taken_back_while_the_robot_looks(service: PretendService) -> None:
    view = await promised(service)
    the_robot(service).deaf = True
    await service.runtime.dialogues.said_done(view.dialogue, "ann")
    await service.runtime.dialogues.take_back(view.dialogue, "ann")
    after = await service.runtime.dialogues.view(view.dialogue)
    assert after.awaiting == "answer"


async def test_who_takes_back_the_last_way_of_help_leaves_it_to_another_try() -> None:
    faults = {"part_1": [("missed", 4)]}
    async with pretend_service(ONE_PART, faults, patient=True) as service:
        view = await promised(service)
        await service.runtime.dialogues.take_back(view.dialogue, "ann")
        asked = (await service.runtime.dialogues.view(view.dialogue)).prompt
        assert asked is not None
        await service.runtime.dialogues.answer(view.dialogue, asked.prompt, "yes", "ann")
        await view_when(service, lambda each: each.awaiting == "help")
        await service.runtime.dialogues.take_back(view.dialogue, "ann")
        ended = await service.runtime.wait_for_end(view.run)
        events = await events_of(service)
    assert ended.status is RunStatus.FINISHED
    [reset] = of_type(events, ev.NodeReset)
    assert reset.failed_attempt
    assert not of_type(events, ev.Resolved)[0].helped


async def test_nobody_else_takes_it_back(service: PretendService) -> None:
    view = await promised(service)
    with pytest.raises(ConflictError, match="ann has promised this"):
        await service.runtime.dialogues.take_back(view.dialogue, "bob")
    assert of_type(await events_of(service), ev.PromiseTakenBack) == []


# --- Where no help is awaited -----------------------------------------------------------------


async def test_where_no_help_is_awaited_there_is_nothing_to_say_of_it(
    service: PretendService,
) -> None:
    request = {"tree": "tree", "world": "tabletop", "speed": "max"}
    await service.runtime.start_run(RunRequest.model_validate(request))
    view = await view_when(service, lambda each: each.awaiting == "answer")
    dialogues = service.runtime.dialogues
    for say in (dialogues.said_done, dialogues.take_back):
        with pytest.raises(ConflictError, match="no help is awaited"):
            await say(view.dialogue, "ann")
    await service.runtime.abort(view.run)
    for say in (dialogues.said_done, dialogues.take_back):
        with pytest.raises(ConflictError, match=r"ended|closed"):
            await say(view.dialogue, "ann")


async def test_the_journal_folds_again_to_the_same_dialogue(tmp_path: Path) -> None:
    path = tmp_path / "journal.db"
    async with pretend_service(ONE_PART, FAULT, journal=path, patient=True) as service:
        view = await promised(service)
        await said_done(service, view.dialogue)
        await service.runtime.dialogues.take_back(view.dialogue, "ann")
        before = await service.runtime.dialogues.view(view.dialogue)
    async with pretend_service(ONE_PART, journal=path, patient=True, boot=2) as service:
        assert await service.runtime.dialogues.view(view.dialogue) == before
