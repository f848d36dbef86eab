"""Somebody carries a robot into an elevator's cabin, or out of it: it goes on from there."""

import asyncio
from collections.abc import Callable
from pathlib import Path

import pytest
from office_with_fleet import office, open_office_with_fleet

from mend.fleet.requests import Transport
from mend.maps.building.cabin import stop_of
from mend.server.composition import open_service
from mend.server.journal import events as ev
from mend.server.settings import Settings
from mend.sim.building.floor_pose import FloorPose
from mend.sim.building.world import BuildingWorld

pytestmark = pytest.mark.slow(4)

PATIENCE_S = 500.0
BUILDING = office(floors=2)
(LIFT,) = BUILDING.document.elevators
ROOM = BUILDING.floors["F1"].places["102"]
RIDES_CYCLES = 60
"""So long it has been in the cabin by then."""

Carrying = Callable[[BuildingWorld], bool]


@pytest.fixture
def carried(monkeypatch: pytest.MonkeyPatch) -> Callable[[Carrying], None]:
    """Has somebody carry a robot, once, as soon as they do."""
    to_come: list[Carrying] = []
    cycle = BuildingWorld.advance_cycle

    def advance_cycle(self: BuildingWorld) -> None:
        if to_come and to_come[0](self):
            to_come.clear()
        cycle(self)

    monkeypatch.setattr(BuildingWorld, "advance_cycle", advance_cycle)
    return to_come.append


async def _brought(folder: Path, destination: str) -> list[ev.Event]:
    settings = Settings(port=0, data_dir=folder, log_level="error", speech_voice="none")
    tea = Transport(name="tea", what="tea", origin="F1/101", destination=destination)
    async with open_service(settings) as service, asyncio.timeout(PATIENCE_S):
        site = await open_office_with_fleet(service, "max", robots=1, floors=2)
        await service.fleets.submit(site, tea, None)
        while (await service.fleets.request(None, "tea"))[1].status != "done":  # noqa: ASYNC110
            await asyncio.sleep(0.05)
        return list(await service.journal.read(0, 100_000))


async def test_who_is_carried_into_a_cabin_drives_out_and_brings_what_it_has(
    tmp_path: Path, carried: Callable[[Carrying], None]
) -> None:
    put: list[FloorPose] = []

    def into_the_cabin(world: BuildingWorld) -> bool:
        (robot,) = world.robots
        if world.time_s() < 21.0:
            return False
        robot.stand(FloorPose(f"/{LIFT}", *stop_of(BUILDING, LIFT, "F1")))
        put.append(robot.at)
        return True

    carried(into_the_cabin)
    events = await _brought(tmp_path, "F1/106")
    assert put
    issues = [each.issue for each in events if isinstance(each, ev.IssueRaised)]
    assert set(issues) <= {"item_not_given", "item_not_taken", "elevator_help"}


async def test_who_is_carried_out_of_a_cabin_says_nothing_of_its_floor_and_rides_again(
    tmp_path: Path, carried: Callable[[Carrying], None]
) -> None:
    ridden: list[FloorPose] = []

    def out_of_the_cabin(world: BuildingWorld) -> bool:
        (robot,) = world.robots
        if robot.at.floor.startswith("/"):
            ridden.append(robot.at)
        if len(ridden) < RIDES_CYCLES:
            return False
        robot.stand(FloorPose("F1", ROOM.x, ROOM.y))
        return True

    carried(out_of_the_cabin)
    events = await _brought(tmp_path, "F2/205")
    assert len(ridden) == RIDES_CYCLES
    issues = [each.issue for each in events if isinstance(each, ev.IssueRaised)]
    assert issues.count("elevator_help") == 2
    assert "wrong_floor" not in issues
