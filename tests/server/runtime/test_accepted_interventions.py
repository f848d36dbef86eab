"""What a person was asked to do is done once, whoever is killed before it was reported."""

import json
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import pytest
from pretend_robots import PretendRobots
from pretend_service import PretendService, pretend_service
from task_documents import definition_of

from mend.errors import ConflictError, WrongInputError
from mend.robots.link.messages import Intervene
from mend.server.journal import events as ev
from mend.server.runtime.interventions import MOST_WAITING
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunStatus, RunView
from mend.sim.tabletop.layout import lay_out
from mend.tasks.intervention import Act, Intervention

ONE_PART = definition_of({"behavior": "pick_and_place", "object": "part_1", "place": "spot_1"})
SCENE = lay_out([("part_1", "spot_1")], seed=1)
STEAL = Intervention(act=Act.STEAL, object="part_1")
PUT_BACK = Intervention(act=Act.PUT_BACK, object="part_1")


def service_with(**fields: Any) -> Any:
    return pretend_service(ONE_PART, scene=SCENE, **fields)


async def start(service: PretendService) -> RunView:
    return await service.runtime.start_run(RunRequest(tree="tree", world="tabletop", speed="max"))


async def interventions(service: PretendService, run: RunView) -> list[ev.Event]:
    events = await service.journal.read(0, 1_000_000, run.id)
    kinds = ev.InterventionAccepted, ev.InterventionDone
    return [each for each in events if isinstance(each, kinds)]


def told(service: PretendService, run: RunView) -> list[Intervene]:
    [name] = run.robots
    return [each for each in service.robots.robots[name].commands if isinstance(each, Intervene)]


async def test_an_intervention_is_accepted_and_then_done() -> None:
    async with service_with(faults={"part_1": [("missed", 4)]}) as service:
        run = await start(service)
        await service.runtime.pause(run.id)
        await service.runtime.intervene(run.id, STEAL)
        await service.runtime.resume(run.id)
        await service.runtime.wait_for_end(run.id)
        accepted, done = await interventions(service, run)
    assert isinstance(accepted, ev.InterventionAccepted)
    assert isinstance(done, ev.InterventionDone)
    assert done.command == accepted.command
    assert (done.intervention, done.by) == (STEAL, "api")


async def test_nobody_who_has_promised_help_reaches_into_a_world_sooner_than_they_really_did() -> (
    None
):
    wall = datetime(2026, 1, 1, tzinfo=UTC)
    faults = {"part_1": [("missed", 4)]}
    async with service_with(faults=faults, patient=True, utc_now=lambda: wall) as service:
        run = await start(service)
        asked = await service.first_question()
        await service.runtime.intervene(run.id, STEAL)
        assert asked.prompt is not None
        await service.runtime.dialogues.answer(asked.dialogue, asked.prompt.prompt, "yes", "ann")
        await service.runtime.intervene(run.id, PUT_BACK)
        wall += timedelta(seconds=1.0)
        await service.runtime.intervene(run.id, PUT_BACK)
        wall += timedelta(hours=1.0)
        await service.runtime.intervene(run.id, PUT_BACK)
        before, at_once, later, stood = (each for each in told(service, run) if each.by == "api")
    assert before.at is None
    assert at_once.at is not None
    assert later.at == pytest.approx(at_once.at + 1.0)
    # The world stood for an hour: nobody is kept from helping for that long.
    assert stood.at is not None
    assert stood.at < at_once.at + 60.0


async def test_what_a_killed_service_had_accepted_is_done_after_its_restart(
    tmp_path: Path,
) -> None:
    path = tmp_path / "journal.db"
    async with service_with(journal=path, deaf=True) as service:
        run = await start(service)
        await service.runtime.intervene(run.id, STEAL)
        [accepted] = await interventions(service, run)
    async with service_with(journal=path, boot=2) as service:
        ended = await service.runtime.wait_for_end(run.id)
        again, done = await interventions(service, run)
    assert ended.status is RunStatus.FINISHED
    assert again == accepted
    assert isinstance(done, ev.InterventionDone)
    assert isinstance(accepted, ev.InterventionAccepted)
    assert done.command == accepted.command


async def test_a_robot_with_a_new_boot_is_told_again_what_the_old_one_had_not_done() -> None:
    async with service_with(deaf=True) as service:
        run = await start(service)
        [name] = run.robots
        await service.runtime.intervene(run.id, STEAL)
        await service.runtime.pause(run.id)
        robot = service.robots.robots[name]
        robot.boot, robot.deaf = 2, False
        before = len(told(service, run))
        await service.run_of(run).robot_connected(name, robot.hello())
        await service.runtime.resume(run.id)
        await service.runtime.wait_for_end(run.id)
        assert len(told(service, run)) == before + 1
        _, done = await interventions(service, run)
    assert isinstance(done, ev.InterventionDone)


async def test_what_was_done_is_not_told_again(tmp_path: Path) -> None:
    path = tmp_path / "journal.db"
    async with service_with(journal=path) as service:
        run = await start(service)
        await service.runtime.pause(run.id)
        await service.runtime.intervene(run.id, STEAL)
        with service.journal.subscribe(0) as subscription:
            async for record in subscription:
                if json.loads(record.text)["type"] == "intervention":
                    break
    async with service_with(journal=path, boot=2) as service:
        await service.runtime.resume(run.id)
        await service.runtime.wait_for_end(run.id)
        assert told(service, run) == []
        assert len(await interventions(service, run)) == 2


async def test_an_ended_run_accepts_nothing() -> None:
    async with service_with() as service:
        run, _ = await service.run_to_end()
        with pytest.raises(ConflictError, match="has ended"):
            await service.runtime.intervene(run.id, STEAL)
        assert await interventions(service, run) == []


async def test_no_more_are_accepted_than_may_wait(tmp_path: Path) -> None:
    path = tmp_path / "journal.db"
    async with service_with(journal=path, deaf=True) as service:
        run = await start(service)
        for _ in range(MOST_WAITING):
            await service.runtime.intervene(run.id, STEAL)
        too_many = "100 interventions of this run are still to be"
        with pytest.raises(ConflictError, match=too_many) as refused:
            await service.runtime.intervene(run.id, STEAL)
        assert refused.value.limit == "waiting_interventions"
        assert len(await interventions(service, run)) == MOST_WAITING
    async with service_with(journal=path, boot=2) as service:
        await service.runtime.wait_for_end(run.id)
        done = await interventions(service, run)
    assert len(done) == 2 * MOST_WAITING


async def _nothing() -> None: ...


async def test_what_was_accepted_is_not_refused_by_a_robot_for_which_too_much_waits(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async with service_with(deaf=True) as service:
        run = await start(service)
        await service.runtime.pause(run.id)
        send = PretendRobots.send

        def full(robots: PretendRobots, robot: str, command: str, body: Any) -> None:
            if isinstance(body, Intervene):
                raise ConflictError("it has not taken its last commands")
            send(robots, robot, command, body)

        monkeypatch.setattr(PretendRobots, "send", full)
        await service.runtime.intervene(run.id, STEAL)
        [name] = run.robots
        robot = service.robots.robots[name]
        robot.boot, robot.deaf = 2, False
        await service.run_of(run).robot_connected(name, robot.hello())
        # What is asked for now has its turn after that.
        await service.run_of(run).request(_nothing)
        monkeypatch.undo()
        assert len(await interventions(service, run)) == 1
        assert (await service.runtime.run(run.id)).status is RunStatus.PAUSED


async def test_a_run_remembers_nothing_of_what_was_accepted_and_done() -> None:
    async with service_with(faults={"part_1": [("missed", 4)]}) as service:
        run = await start(service)
        state = service.run_of(run).context.state
        await service.runtime.pause(run.id)
        await service.runtime.intervene(run.id, STEAL)
        await service.runtime.resume(run.id)
        await service.runtime.wait_for_end(run.id)
        assert len(await interventions(service, run)) == 2
    assert not state.accepted
    assert not state.intervened


async def test_what_is_done_in_buildings_only_is_refused_and_nobody_hears_of_it() -> None:
    async with service_with() as service:
        run = await start(service)
        await service.runtime.pause(run.id)
        with pytest.raises(WrongInputError, match="'charge' is for buildings, and the scene"):
            await service.runtime.intervene(run.id, Intervention(act=Act.CHARGE))
        await service.runtime.resume(run.id)
        await service.runtime.wait_for_end(run.id)
        assert await interventions(service, run) == []
        assert told(service, run) == []
