"""A robot whose way is barred lets one from the other side go, and asks nobody to clear it."""

import asyncio
from pathlib import Path

import pytest

from mend.fleet.requests import GoToRoom
from mend.maps.building.building import Building
from mend.maps.building.random_building import random_building
from mend.server.composition import open_service
from mend.server.journal import events as ev
from mend.server.settings import Settings
from mend.server.sites.requests import FleetOptions, SiteRequest
from mend.sim.building.scene import scene_of
from mend.tasks.intervention import Act, Intervention
from mend.tasks.scenario import ScriptedIntervention
from mend.tasks.scene import Base, Scene

PATIENCE_S = 500.0
ROW = Building(random_building(3, 1, 8))
ROOM, BARRED = "F1/106", ("F1/w0_7", "F1/w0_8")
"""One corridor, barred between the room and the robot that is nearer to it."""


def office() -> Scene:
    places = ROW.floors["F1"].places
    near, far = places["charger1"], places["w0_0"]
    bases = {"near": Base(x=near.x, y=near.y), "far": Base(x=far.x, y=far.y)}
    return scene_of(ROW, "row", 2).model_copy(update={"robots": bases})


@pytest.mark.slow(2)
async def test_who_can_get_there_goes_before_people_are_asked(tmp_path: Path) -> None:
    settings = Settings(port=0, data_dir=tmp_path, log_level="error", speech_voice="none")
    async with open_service(settings) as service, asyncio.timeout(PATIENCE_S):
        await service.library.scenes.save("row", office().model_dump_json(exclude_defaults=True))
        barred = Intervention(act=Act.BAR, between=BARRED)
        opened = SiteRequest(
            scene="row",
            world="building",
            speed=20.0,
            seed=2,
            world_options={"localizer": "exact", "unmapped": 0.0, "shut_doors": 0.0},
            fleet=FleetOptions(answers="yes"),
            interventions=[ScriptedIntervention(do=barred, at_s=0.0)],
        )
        site = (await service.sites.open_site(opened)).id
        await service.fleets.submit(site, GoToRoom(name="visit", place=ROOM), None)
        while (await service.fleets.request(None, "visit"))[1].status != "done":  # noqa: ASYNC110
            await asyncio.sleep(0.05)
        events = list(await service.journal.read(0, 100_000))
    begun = [each.robot for each in events if isinstance(each, ev.LegBegun)]
    assert [name.split("-")[0] for name in begun] == ["near", "far"]
    (found,) = [each for each in events if isinstance(each, ev.WayFound)]
    assert (found.finding, frozenset(found.between)) == ("blocked", frozenset(BARRED))
    assert not [each for each in events if isinstance(each, ev.IssueRaised)]
    why = [each.reason for each in events if isinstance(each, ev.PlanChanged)]
    assert any("takes over 'visit' from near" in each for each in why)
