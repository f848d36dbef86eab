"""`kill -9` of the real service and of simulated robots, and what is left of their runs."""

import asyncio
from collections.abc import AsyncIterator, Callable
from uuid import UUID

import pytest
import pytest_asyncio
from forked_mend import FORKED
from kills import Ordeal, doubled_starts
from sampled import sample
from service_process import ServiceProcess, service_process
from two_boxes import BENCH, BOTH

from mend.server.client import MendClient
from mend.server.journal import events as ev
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import DialogueView, RunStatus
from mend.tasks.intervention import Act, Intervention

# One event loop for all of them, and so one service.
pytestmark = [pytest.mark.slow(3), pytest.mark.asyncio(loop_scope="module")]

WILLING = {"answers": ["yes"] * 100, "max_attempts": 100, "speed": "max"}


def eket(world: str, **fields: object) -> RunRequest:
    return RunRequest.model_validate({"tree": "eket", "world": world, **fields})


async def boxes(service: ServiceProcess, world: str, **fields: object) -> RunRequest:
    """A short task, of two boxes."""
    async with MendClient(service.url) as client:
        await client.upload_scene(BENCH)
        await client.upload_tree(BOTH)
    return RunRequest.model_validate({"tree": "both", "world": world, **fields})


@pytest_asyncio.fixture(scope="module", loop_scope="module")
async def lasting(tmp_path_factory: pytest.TempPathFactory) -> AsyncIterator[ServiceProcess]:
    async with service_process(tmp_path_factory.mktemp("service"), forked=FORKED) as service:
        yield service


@pytest_asyncio.fixture(loop_scope="module")
async def service(lasting: ServiceProcess) -> ServiceProcess:
    """The one of all tests, which lives again, once the robots of other tests have gone."""
    async with asyncio.timeout(60):
        while lasting.robots():  # noqa: ASYNC110 - processes tell nobody
            await asyncio.sleep(0.05)
    return lasting


async def test_runs_live_through_kills_of_the_service(service: ServiceProcess) -> None:
    requests = [
        eket("tabletop", scenario="eket_paper", seed=7, **WILLING),
        await boxes(service, "tabletop", seed=8, **WILLING),
    ]
    found = await Ordeal(service, requests, seed=7).kill_service(sample(1, 3))
    assert found.faults == []
    assert found.finished == found.runs > 0
    assert "Traceback" not in service.complaints


async def test_a_run_lives_through_kills_of_its_robot_and_then_of_the_service(
    service: ServiceProcess,
) -> None:
    pytest.importorskip("pybullet")
    ordeal = Ordeal(service, [await boxes(service, "workcell", seed=7, **WILLING)], seed=7)
    found = await ordeal.kill_robots(sample(1, 2))
    assert found.faults == []
    assert found.finished == found.runs > 0
    assert "Traceback" not in service.complaints


async def test_a_question_outlives_the_service_and_can_be_answered_afterwards(
    service: ServiceProcess,
) -> None:
    async with MendClient(service.url) as client:
        run = await client.start_run(await boxes(service, "tabletop", speed=20.0))
        await client.intervene(run.id, Intervention(act=Act.STEAL, object="red_box"))
        before = await _wait_for(client, lambda each: each.awaiting == "answer")
        await service.kill()
        await service.start()
        after = await client.dialogue(before.dialogue)
        assert before.prompt is not None
        assert after.prompt is not None
        assert (after.status, after.awaiting) == ("open", "answer")
        assert after.prompt.prompt == before.prompt.prompt
        await client.answer(before.dialogue, before.prompt.prompt, "yes", "ann")
        ended = await _answer_until_the_end(client, run.id)
    assert ended is RunStatus.FINISHED


async def test_an_accepted_intervention_that_was_not_reported_is_done_once(
    service: ServiceProcess,
) -> None:
    pytest.importorskip("pybullet")
    async with MendClient(service.url) as client:
        run = await client.start_run(await boxes(service, "workcell", seed=7, **WILLING))
        seen = (await _first(client, ev.StepStarted, run.id)).seq
        for victim, part in (("robot", "blue_box"), ("service", "red_box")):
            [robot] = service.robots()
            robot.suspend()
            await client.intervene(run.id, Intervention(act=Act.STEAL, object=part))
            if victim == "service":
                await service.kill()
                await service.start()
            else:
                await service.kill_robot()
            seen = (await _first(client, ev.InterventionDone, run.id, after=seen)).seq
        await client.abort(run.id)
        events = await client.events(run.id, limit=1000)
    accepted = [each.command for each in events if isinstance(each, ev.InterventionAccepted)]
    stolen = [each for each in events if isinstance(each, ev.InterventionDone) and each.by == "api"]
    assert len(accepted) == 2
    assert [(each.command, each.ok) for each in stolen] == [(each, True) for each in accepted]


async def _first(
    client: MendClient, kind: type[ev.Event], run: UUID, *, after: int = 0
) -> ev.Event:
    async with asyncio.timeout(60), client.follow("watcher", after=after) as stream:
        async for message in stream:
            if isinstance(message, kind) and message.run == run:
                return message
    raise AssertionError("a stream has no end of its own")


async def _wait_for(client: MendClient, what: Callable[[DialogueView], bool]) -> DialogueView:
    async with asyncio.timeout(60):
        while True:
            for dialogue in await client.dialogues("open"):
                if what(dialogue):
                    return dialogue
            await asyncio.sleep(0.05)


async def _answer_until_the_end(client: MendClient, run: UUID) -> RunStatus:
    """Say yes to whatever else is asked."""
    async with asyncio.timeout(60):
        while not (view := await client.run(run)).status.ended:
            for dialogue in view.dialogues:
                if dialogue.awaiting == "answer" and dialogue.prompt is not None:
                    prompt = dialogue.prompt.prompt
                    await client.answer(dialogue.dialogue, prompt, "yes", "ann")
            await asyncio.sleep(0.05)
    return view.status


async def test_a_run_that_is_asked_for_under_a_key_is_not_started_twice(
    service: ServiceProcess,
) -> None:
    """Once each: `benchmarks/kill.py` has more of them, while earlier runs go on."""
    async with MendClient(service.url) as client:
        before = len(await client.runs())
    assert await doubled_starts(service, 1, committed=True, runs_before=before) == []
    assert await doubled_starts(service, 1, committed=False, runs_before=before + 1) == []
    assert "Traceback" not in service.complaints
