"""What helpers say of promised help, at a table and in a building, where it is done or not."""

import asyncio
from collections.abc import Callable
from pathlib import Path
from uuid import UUID

import pytest
from test_carrying_for_people import BRING, LIES, office, request, settings_in
from test_people_take_leaves import bench, when

from mend.dialogue.script import Felt, Sight
from mend.errors import ConflictError
from mend.server.composition import Service, open_service
from mend.server.journal import events as ev
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import DialogueView, RunStatus
from mend.tasks.intervention import Act, Intervention


async def dialogue_when(service: Service, so: Callable[[DialogueView], bool]) -> DialogueView:
    """The last dialogue, once it is so."""
    with service.journal.subscribe(0) as records:
        async with asyncio.timeout(120.0):
            async for _ in records:
                found = await service.runtime.dialogues.page(None, 100, 0)
                if found and so(found[-1]):
                    return found[-1]
    raise AssertionError("the journal has ended")


async def promise(service: Service) -> UUID:
    """Anna says yes to what is asked, and is waited for."""
    asked = await dialogue_when(service, lambda each: each.awaiting == "answer")
    assert asked.prompt is not None
    await service.runtime.dialogues.answer(asked.dialogue, asked.prompt.prompt, "yes", "anna")
    await dialogue_when(service, lambda each: each.awaiting == "help")
    return asked.dialogue


async def after_a_look(service: Service, count: int) -> ev.HelpNotSeenYet:
    """The `count`-th look at a word that did not see it."""
    seen: list[ev.HelpNotSeenYet] = []

    def so(event: ev.Event) -> bool:
        if isinstance(event, ev.HelpNotSeenYet):
            seen.append(event)
        return len(seen) == count

    await when(service, so)
    return seen[-1]


async def test_at_a_table_the_robot_says_what_it_sees_until_it_sees_the_help() -> None:
    # Faster than clocks go, so that nobody waits for the arm, and with as much time to help.
    async with bench(help_window_s=300.0) as service:
        wish = RunRequest(
            tree="both", world="tabletop", speed=8.0, seed=2, answers="live", person=LIES
        )
        run = await service.runtime.start_run(wish)
        await service.runtime.intervene(run.id, Intervention(act=Act.STEAL, object="blue_box"))
        dialogue = await promise(service)
        await service.runtime.dialogues.said_done(dialogue, "anna")
        unseen = await after_a_look(service, 1)
        assert unseen.sight is Sight.NOWHERE
        assert unseen.picture is None or await service.journal.picture(unseen.picture)
        await service.runtime.intervene(run.id, Intervention(act=Act.PUT_BACK, object="blue_box"))
        verified = await when(service, lambda each: isinstance(each, ev.HelpVerified))
        assert isinstance(verified, ev.HelpVerified)
        assert verified.change.by_a_person
        ended = await asyncio.wait_for(service.runtime.wait_for_end(run.id), 120.0)
        assert ended.status is RunStatus.FINISHED
        events = await service.journal.read(0, 100_000, run.id)
    thanked = [each for each in events if isinstance(each, ev.Prompt) and "Thank" in each.text]
    assert all(each.seq > verified.seq for each in thanked)


async def test_in_a_building_a_basket_feels_nothing_and_the_promise_is_taken_back(
    tmp_path: Path,
) -> None:
    async with open_service(settings_in(tmp_path)) as service:
        await service.library.scenes.save("office", office())
        await service.library.trees.save("task", BRING)
        wish = request(LIES, []).model_copy(update={"answers": "live"})
        run = await service.runtime.start_run(wish)
        dialogue = await promise(service)
        await service.runtime.dialogues.said_done(dialogue, "anna")
        unseen = await after_a_look(service, 1)
        assert unseen.felt is Felt.NOTHING
        with pytest.raises(ConflictError, match="anna has promised this"):
            await service.runtime.dialogues.take_back(dialogue, "ben")
        await service.runtime.dialogues.take_back(dialogue, "anna")
        after = await service.runtime.dialogues.view(dialogue)
        assert after.help is None
        await service.runtime.abort(run.id)
        events = await service.journal.read(0, 100_000, run.id)
    said = [each.text for each in events if isinstance(each, ev.Prompt)]
    assert "I feel nothing new in my basket. I keep watching." in said
    assert not any("Thank" in each for each in said)
