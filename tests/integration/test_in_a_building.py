"""Robots of a building go to rooms whose doors are shut, ask people to open them, and go on."""

import asyncio
import json
from pathlib import Path

import pytest

from mend.maps.building.building import Building
from mend.maps.building.random_building import random_building
from mend.server.composition import open_service
from mend.server.journal import events as ev
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunStatus
from mend.server.settings import Settings
from mend.sim.building.scene import scene_of
from mend.tasks.scenario import Person

EXAMPLES = Path(__file__).parents[2] / "examples" / "buildings"
PATIENCE_S = 120.0
ROUNDS = {
    "name": "rounds",
    "scene": "office",
    "tree": {"and": [{"behavior": "go_to", "place": f"F1-10{each}"} for each in (1, 3, 4)]},
}


@pytest.mark.slow
async def test_shut_doors_are_asked_about_and_the_rooms_are_reached(tmp_path: Path) -> None:
    scene = scene_of(Building(random_building(7, 1, 6)), "office", 2)
    settings = Settings(port=0, data_dir=tmp_path, log_level="error", speech_voice="none")
    async with open_service(settings) as service, asyncio.timeout(PATIENCE_S):
        await service.library.scenes.save("office", scene.model_dump_json(exclude_defaults=True))
        await service.library.trees.save("rounds", json.dumps(ROUNDS))
        request = RunRequest(
            tree="rounds",
            world="building",
            speed="max",
            seed=2,
            answers=["yes"] * 6,
            person=Person(acts=True),
            world_options={"shut_doors": 1.0, "localizer": "exact"},
        )
        run = await service.runtime.start_run(request)
        view = await service.runtime.wait_for_end(run.id)
        events = list(await service.journal.read(0, 100_000, run.id))
    assert view.status is RunStatus.FINISHED, view.result
    issues = {each.issue for each in events if isinstance(each, ev.IssueRaised)}
    assert issues == {"door_closed"}
    resolved = [each for each in events if isinstance(each, ev.Resolved)]
    assert resolved
    assert all(each.resolution == "robot_finish" and each.helped for each in resolved)


@pytest.mark.slow
async def test_the_published_plan_asks_rides_notices_the_wrong_floor_and_arrives(
    tmp_path: Path,
) -> None:
    scene = (EXAMPLES / "scenes" / "office_at_work.yaml").read_text("utf-8")
    task = (EXAMPLES / "conditional_plan.yaml").read_text("utf-8")
    settings = Settings(port=0, data_dir=tmp_path, log_level="error", speech_voice="none")
    async with open_service(settings) as service, asyncio.timeout(PATIENCE_S):
        await service.library.scenes.save("office_at_work", scene)
        await service.library.trees.save("conditional_plan", task)
        request = RunRequest(
            tree="conditional_plan",
            world="building",
            speed="max",
            seed=4,
            answers=["yes"] * 20,
            person=Person(acts=True),
            world_options={"shut_doors": 1.0, "wrong_floors": 0.6},
        )
        run = await service.runtime.start_run(request)
        view = await service.runtime.wait_for_end(run.id)
        events = list(await service.journal.read(0, 100_000, run.id))
    assert view.status is RunStatus.FINISHED, view.result
    issues = [each.issue for each in events if isinstance(each, ev.IssueRaised)]
    assert issues[0] == "elevator_help"
    assert "wrong_floor" in issues
    resolved = [each for each in events if isinstance(each, ev.Resolved)]
    assert all(each.resolution == "robot_finish" and each.helped for each in resolved)


@pytest.mark.slow
async def test_a_robot_that_is_carried_asks_where_it_is_and_goes_on(tmp_path: Path) -> None:
    scene = scene_of(Building(random_building(7, 1, 6)), "office", 1)
    settings = Settings(port=0, data_dir=tmp_path, log_level="error", speech_voice="none")
    tree = {
        "name": "rounds",
        "scene": "office",
        "tree": {"and": [{"behavior": "go_to", "place": f"F1-10{each}"} for each in range(1, 7)]},
    }
    async with open_service(settings) as service, asyncio.timeout(PATIENCE_S):
        await service.library.scenes.save("office", scene.model_dump_json(exclude_defaults=True))
        await service.library.trees.save("rounds", json.dumps(tree))
        request = RunRequest(
            tree="rounds",
            world="building",
            speed="max",
            seed=3,
            answers=["yes"] * 20,
            person=Person(acts=True),
            world_options={"shut_doors": 0.0, "unmapped": 0.33, "carried_every_s": 12.0},
        )
        run = await service.runtime.start_run(request)
        view = await service.runtime.wait_for_end(run.id)
        events = list(await service.journal.read(0, 100_000, run.id))
    assert view.status is RunStatus.FINISHED, view.result
    asked = [each.text for each in events if isinstance(each, ev.Prompt) and each.kind == "ask"]
    assert any("I do not know where I am." in each and "Am I " in each for each in asked), asked
    told = [
        each for each in events if isinstance(each, ev.HelpVerified) and each.help == "tell_place"
    ]
    assert told
    assert all(each.change == "told" for each in told)
