"""Robots of a building ask people to open doors, for elevators and where they are, and go on."""

import asyncio
import json
from pathlib import Path

import pytest
from sampled import sample

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
PATIENCE_S = 500.0


def rounds(*rooms: int) -> str:
    leaves = [{"behavior": "go_to", "place": f"F1-10{each}"} for each in rooms]
    return json.dumps({"name": "rounds", "scene": "office", "tree": {"and": leaves}})


def office(robots: int) -> str:
    scene = scene_of(Building(random_building(7, 1, 6)), "office", robots)
    return scene.model_dump_json(exclude_defaults=True)


async def run_to_its_end(
    folder: Path, scene: tuple[str, str], tree: str, seed: int, **options: float | str
) -> list[ev.Event]:
    """The events of a run that has finished, with somebody who says yes and does what they say."""
    settings = Settings(port=0, data_dir=folder, log_level="error", speech_voice="none")
    async with open_service(settings) as service, asyncio.timeout(PATIENCE_S):
        await service.library.scenes.save(*scene)
        await service.library.trees.save("task", tree)
        request = RunRequest(
            tree="task",
            world="building",
            speed="max",
            seed=seed,
            answers=["yes"] * 20,
            person=Person(acts=True),
            world_options=dict(options),
        )
        run = await service.runtime.start_run(request)
        view = await service.runtime.wait_for_end(run.id)
        events = list(await service.journal.read(0, 100_000, run.id))
    assert view.status is RunStatus.FINISHED, view.result
    return events


def issues_of(events: list[ev.Event]) -> list[str]:
    return [each.issue for each in events if isinstance(each, ev.IssueRaised)]


def require_all_helped(events: list[ev.Event]) -> None:
    resolved = [each for each in events if isinstance(each, ev.Resolved)]
    assert resolved
    assert all(each.resolution == "robot_finish" and each.helped for each in resolved)


@pytest.mark.slow
async def test_shut_doors_are_asked_about_and_the_rooms_are_reached(tmp_path: Path) -> None:
    scene, tree = ("office", office(2)), rounds(1, 3, 4)
    events = await run_to_its_end(tmp_path, scene, tree, 2, shut_doors=1.0, localizer="exact")
    assert set(issues_of(events)) == {"door_closed"}
    require_all_helped(events)


@pytest.mark.slow
async def test_the_published_plan_asks_rides_notices_the_wrong_floor_and_arrives(
    tmp_path: Path,
) -> None:
    kept = (EXAMPLES / "scenes" / "office_at_work.yaml").read_text("utf-8")
    tree = (EXAMPLES / "conditional_plan.yaml").read_text("utf-8")
    scene = ("office_at_work", kept)
    events = await run_to_its_end(tmp_path, scene, tree, 4, shut_doors=1.0, wrong_floors=0.6)
    issues = issues_of(events)
    assert issues[0] == "elevator_help"
    assert "wrong_floor" in issues
    require_all_helped(events)


@pytest.mark.slow
async def test_a_robot_that_is_carried_asks_where_it_is_and_goes_on(tmp_path: Path) -> None:
    # Wherever it is carried it looks for its place on the whole floor, which takes seconds.
    scene, tree = ("office", office(1)), rounds(*sample((1, 2), (1, 2, 3, 4, 5, 6)))
    events = await run_to_its_end(
        tmp_path, scene, tree, 3, shut_doors=0.0, unmapped=0.33, carried_every_s=12.0
    )
    asked = [each.text for each in events if isinstance(each, ev.Prompt) and each.kind == "ask"]
    assert any("I do not know where I am." in each and "Am I " in each for each in asked), asked
    told = [
        each for each in events if isinstance(each, ev.HelpVerified) and each.help == "tell_place"
    ]
    assert told
    assert all(each.change == "told" for each in told)
