"""The program of robots ends while one of them rides an elevator: nothing stays there for ever."""

import asyncio
from collections.abc import Callable
from pathlib import Path

import pytest
from office_with_fleet import office, open_office_with_fleet

from mend.fleet.requests import GoToRoom
from mend.server.composition import Service, open_service
from mend.server.journal import events as ev
from mend.server.settings import Settings
from mend.sim.building.world import BuildingWorld
from mend.tasks.scene import Base

pytestmark = pytest.mark.slow(4)

PATIENCE_S = 500.0
BUILDING = office(floors=2)
(LIFT,) = BUILDING.document.elevators
ROOM = BUILDING.floors["F1"].places["102"]
VISIT = GoToRoom(name="up", place="F2/201")


@pytest.fixture
def end_in_cabin(monkeypatch: pytest.MonkeyPatch) -> Callable[[int], None]:
    """Has the world end so many times as soon as a robot is in the cabin that is shut."""

    def end_in_cabin(times: int) -> None:
        cycle, ended = BuildingWorld.advance_cycle, 0

        def advance_cycle(self: BuildingWorld) -> None:
            nonlocal ended
            cycle(self)
            if ended < times and any(each.at.floor == f"/{LIFT}" for each in self.robots):
                ended += 1
                raise RuntimeError("power cut")

        monkeypatch.setattr(BuildingWorld, "advance_cycle", advance_cycle)

    return end_in_cabin


async def events_of(folder: Path) -> list[ev.Event]:
    """What is journaled until a visit upstairs is done; both robots begin downstairs."""
    settings = Settings(port=0, data_dir=folder, log_level="critical", speech_voice="none")
    async with open_service(settings) as service, asyncio.timeout(PATIENCE_S):
        below = {"robot2": Base(x=ROOM.x, y=ROOM.y, z=0.0)}
        site = await open_office_with_fleet(service, "max", robots=2, floors=2, stand=below)
        await service.fleets.submit(site, VISIT, None)
        while await status(service) != "done":  # noqa: ASYNC110 - nothing tells of it
            await asyncio.sleep(0.05)
        return list(await service.journal.read(0, 100_000))


async def status(service: Service) -> str:
    return (await service.fleets.request(None, VISIT.name))[1].status


async def test_it_goes_on_from_where_it_was_and_nobody_is_asked_for_anything_more(
    tmp_path: Path, end_in_cabin: Callable[[int], None]
) -> None:
    end_in_cabin(3)
    events = await events_of(tmp_path)
    lost = [each.reason for each in events if isinstance(each, ev.RobotLost)]
    assert lost == ["its program failed: power cut"] * 3
    asked = [each.issue for each in events if isinstance(each, ev.IssueRaised)]
    assert asked == ["elevator_help"], "to be let in, before it rode"
    assert not [each for each in events if isinstance(each, ev.FleetTold)]
