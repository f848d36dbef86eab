"""A robot is out of service and stands in an elevator's cabin: it does not stay there."""

import asyncio
from pathlib import Path
from typing import Literal

import pytest
from office_with_fleet import office, open_office_with_fleet

from mend.fleet.requests import GoToRoom
from mend.maps.building.cabin import stop_of
from mend.server.composition import Service, open_service
from mend.server.journal import events as ev
from mend.server.settings import Settings
from mend.sim.building.floor_pose import FloorPose
from mend.sim.building.world import BuildingWorld

pytestmark = pytest.mark.slow(4)

PATIENCE_S = 500.0
BUILDING = office(floors=2)
(LIFT,) = BUILDING.document.elevators


@pytest.fixture
def in_cabin(monkeypatch: pytest.MonkeyPatch) -> asyncio.Event:
    """Once it is set the second robot stands in the cabin, which was shut."""
    put, cycle = asyncio.Event(), BuildingWorld.advance_cycle

    def advance_cycle(self: BuildingWorld) -> None:
        if put.is_set():
            put.clear()
            x, y = stop_of(BUILDING, LIFT, "F1")
            self.robots[1].stand(FloorPose(f"/{LIFT}", x, y))
        cycle(self)

    monkeypatch.setattr(BuildingWorld, "advance_cycle", advance_cycle)
    return put


async def events_of(
    folder: Path, in_cabin: asyncio.Event, visit: GoToRoom, answers: Literal["live", "yes"]
) -> list[ev.Event]:
    """What becomes of a visit while the second robot stands in the cabin and works no more."""
    settings = Settings(port=0, data_dir=folder, log_level="error", speech_voice="none")
    async with open_service(settings) as service, asyncio.timeout(PATIENCE_S):
        site = await open_office_with_fleet(service, "max", robots=2, floors=2, answers=answers)
        fleet = await service.fleets.fleet(site)
        await fleet.operators.take_out(robots_of(service)[1], "its wheel squeaks", None)
        in_cabin.set()
        await service.fleets.submit(site, visit, None)
        while (await service.fleets.request(None, visit.name))[1].status != "done":  # noqa: ASYNC110
            await asyncio.sleep(0.05)
        return list(await service.journal.read(0, 100_000))


def robots_of(service: Service) -> list[str]:
    return [each.robot for each in service.sites.sites()[0].robots]


def told(events: list[ev.Event]) -> list[str]:
    return [e.told for e in events if isinstance(e, ev.FleetTold) and e.finder is not None]


async def test_who_wants_to_ride_asks_people_to_push_it_out(
    tmp_path: Path, in_cabin: asyncio.Event
) -> None:
    events = await events_of(tmp_path, in_cabin, GoToRoom(name="up", place="F2/201"), "yes")
    (asked,) = [e for e in events if isinstance(e, ev.IssueRaised) and e.issue == "elevator_help"]
    assert asked.detection is not None
    assert asked.detection.robot is not None
    assert f"I need {LIFT} to get from F1 to F2" in asked.detection.explanation
    assert asked.detection.explanation.endswith("which has failed, has to be pushed out of it")


async def test_nobody_is_planned_to_ride_until_it_has_got_out_by_itself(
    tmp_path: Path, in_cabin: asyncio.Event
) -> None:
    visit = GoToRoom(name="here", place="F1/101", stay_s=150.0)
    events = await events_of(tmp_path, in_cabin, visit, "live")
    assert told(events) == [f"stays in {LIFT}, which nobody else can ride", f"is out of {LIFT}"]
    (sent,) = [each for each in events if isinstance(each, ev.ErrandBegun)]
    assert sent.place.startswith("F1/")
    issues = [e for e in events if isinstance(e, ev.IssueRaised)]
    assert not [(e.robot, e.issue, e.detection and e.detection.explanation) for e in issues]
