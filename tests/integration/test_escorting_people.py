"""A request to escort somebody is done only if they really came along."""

import asyncio
import json
from pathlib import Path

import pytest
from office_with_fleet import open_office_with_fleet

from mend.fleet.requests import Escort
from mend.maps.building.building import Building
from mend.maps.building.random_building import random_building
from mend.server.composition import Service, open_service
from mend.server.journal import events as ev
from mend.server.journal.stored_event import read_event
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunStatus
from mend.server.settings import Settings
from mend.sim.building.scene import scene_of
from mend.tasks.scenario import Person

PATIENCE_S = 500.0
LEE = Escort(name="guest", person="Ms Lee", origin="101", destination="203")


def settings(folder: Path) -> Settings:
    return Settings(port=0, data_dir=folder, log_level="error", speech_voice="none")


async def ended(service: Service, name: str) -> tuple[ev.RequestChanged, list[ev.Event]]:
    """How a request ended, and all events until then."""
    events: list[ev.Event] = []
    with service.journal.subscribe(0, 100_000) as records:
        async for record in records:
            event = read_event(record.seq, record.text)
            events.append(event)
            if not isinstance(event, ev.RequestChanged) or event.request != name:
                continue
            if event.status in ("done", "failed"):
                return event, events
    raise AssertionError("the journal ended")


def said(events: list[ev.Event]) -> list[str]:
    return [each.text for each in events if isinstance(each, ev.Prompt)]


@pytest.mark.slow(4)
async def test_somebody_is_led_to_another_floor_and_arrives(tmp_path: Path) -> None:
    async with open_service(settings(tmp_path)) as service, asyncio.timeout(PATIENCE_S):
        site = await open_office_with_fleet(service, "max", floors=2, dawdling=1.0)
        await service.fleets.submit(site, LEE, None)
        end, events = await ended(service, "guest")
    assert end.status == "done"
    raised = [each for each in events if isinstance(each, ev.IssueRaised)]
    assert {each.issue for each in raised} >= {"fell_behind", "elevator_help"}
    assert {each.person for each in raised} == {"Ms Lee"}
    assert any("Will you tell Ms Lee to come?" in each for each in said(events))
    behaviors = [each.name for each in events if isinstance(each, ev.NodeDone)]
    assert behaviors == ["meet_person", "escort"]


@pytest.mark.slow(4)
async def test_who_does_not_come_is_asked_for_never_thanked_for_and_told(tmp_path: Path) -> None:
    async with open_service(settings(tmp_path)) as service, asyncio.timeout(PATIENCE_S):
        site = await open_office_with_fleet(service, "max", floors=2, no_shows=1.0)
        await service.fleets.submit(site, LEE, None)
        end, events = await ended(service, "guest")
    assert end.status == "failed"
    assert end.reason is not None
    assert "meet 'guest' at F1/101" in end.reason
    issues = [each.issue for each in events if isinstance(each, ev.IssueRaised)]
    assert set(issues) == {"person_not_there"}
    assert any("I still do not see Ms Lee." in each for each in said(events))
    assert not any("Thank" in each for each in said(events))


@pytest.mark.slow(4)
async def test_one_robot_escorts_two_people_one_after_the_other(tmp_path: Path) -> None:
    tree = json.dumps(
        {
            "name": "task",
            "scene": "office",
            "tree": {
                "and": [
                    {
                        "then": [
                            {"behavior": "meet_person", "place": a, "person": person},
                            {"behavior": "escort", "place": b, "person": person},
                        ]
                    }
                    for person, a, b in (
                        ("Ms Lee", "F1-101", "F1-104"),
                        ("Mr Ito", "F1-102", "F1-105"),
                    )
                ]
            },
        }
    )
    scene = scene_of(Building(random_building(7, 1, 6)), "office", 1)
    async with open_service(settings(tmp_path)) as service, asyncio.timeout(PATIENCE_S):
        await service.library.scenes.save("office", scene.model_dump_json(exclude_defaults=True))
        await service.library.trees.save("task", tree)
        request = RunRequest(
            tree="task",
            world="building",
            speed="max",
            seed=3,
            answers=["yes"] * 20,
            person=Person(acts=True),
            world_options={"localizer": "exact", "unmapped": 0.0, "shut_doors": 0.0},
        )
        run = await service.runtime.start_run(request)
        view = await service.runtime.wait_for_end(run.id)
        events = list(await service.journal.read(0, 100_000, run.id))
    assert view.status is RunStatus.FINISHED, view.result
    started = [each.name for each in events if isinstance(each, ev.NodeStarted)]
    assert len(started) == 4
    assert all(b.startswith("escort") for b in started[1::2])
