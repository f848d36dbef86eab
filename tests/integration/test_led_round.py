"""A blocked hallway of a building with rings is gone round, and others do not go there at all."""

import asyncio
import json
from pathlib import Path

import pytest
from blocked_ring import BlockedRing, blocked_ring

from mend.fleet.requests import GoToRoom
from mend.server.composition import Service, open_service
from mend.server.journal import events as ev
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunStatus
from mend.server.settings import Settings
from mend.server.sites.requests import FleetOptions, SiteRequest
from mend.tasks.scenario import Person

PATIENCE_S = 500.0
LONGER_S = 30.0
"""A way round that takes so much longer is taken without asking."""


def settings(folder: Path) -> Settings:
    return Settings(port=0, data_dir=folder, log_level="error", speech_voice="none")


async def save(service: Service, ring: BlockedRing) -> None:
    await service.library.scenes.save("ring", ring.scene.model_dump_json(exclude_defaults=True))


def found_in(events: list[ev.Event]) -> list[tuple[str, frozenset[str]]]:
    found = [each for each in events if isinstance(each, ev.WayFound)]
    return [(each.finding, frozenset(each.between)) for each in found]


@pytest.mark.slow(4)
async def test_a_robot_alone_goes_round_without_asking(tmp_path: Path) -> None:
    ring = blocked_ring(1, LONGER_S)
    tree = {"then": [{"behavior": "go_to", "place": ring.rooms[0].replace("/", "-")}]}
    async with open_service(settings(tmp_path)) as service, asyncio.timeout(PATIENCE_S):
        await save(service, ring)
        task = {"name": "go", "scene": "ring", "tree": tree}
        await service.library.trees.save("go", json.dumps(task))
        request = RunRequest(
            tree="go",
            world="building",
            speed="max",
            seed=ring.seed,
            answers=["yes"] * 20,
            person=Person(acts=True),
            world_options=ring.options,
        )
        run = await service.runtime.start_run(request)
        view = await service.runtime.wait_for_end(run.id)
        events = list(await service.journal.read(0, 100_000, run.id))
    assert view.status is RunStatus.FINISHED, view.result
    assert found_in(events) == [("blocked", ring.lane)]
    assert not [each for each in events if isinstance(each, ev.IssueRaised)]


async def done(service: Service, name: str) -> None:
    """Wait until a request is done."""
    while True:
        _, view = await service.fleets.request(None, name)
        if view.status in ("done", "failed", "cancelled"):
            break
        await asyncio.sleep(0.05)
    assert view.status == "done", view.reason


@pytest.mark.slow(6)
async def test_what_one_robot_finds_others_go_round_from_the_beginning_after_a_restart_too(
    tmp_path: Path,
) -> None:
    ring = blocked_ring(2, LONGER_S)
    first, second = ring.rooms
    async with open_service(settings(tmp_path)) as service, asyncio.timeout(PATIENCE_S):
        await save(service, ring)
        opened = SiteRequest(
            scene="ring",
            world="building",
            speed="max",
            seed=ring.seed,
            world_options=ring.options,
            fleet=FleetOptions(answers="yes"),
        )
        site = (await service.sites.open_site(opened)).id
        fleet = await service.fleets.fleet(site)
        robot1, robot2 = sorted(await fleet.read(lambda all_: list(all_.fleet.robots)))
        await fleet.operators.take_out(robot2, "it waits", None)
        await service.fleets.submit(site, GoToRoom(name="first", place=first), None)
        await done(service, "first")
        before = list(await service.journal.read(0, 100_000))
    assert found_in(before) == [("blocked", ring.lane)]
    async with open_service(settings(tmp_path)) as service, asyncio.timeout(PATIENCE_S):
        fleet = await service.fleets.fleet(site)
        assert ring.lane in await fleet.read(lambda all_: dict(all_.closed_until_s()))
        await fleet.operators.take_out(robot1, "it waits", None)
        await fleet.operators.put_back(robot2, None)
        await service.fleets.submit(site, GoToRoom(name="second", place=second), None)
        await done(service, "second")
        events = list(await service.journal.read(0, 100_000))
    assert found_in(events) == [("blocked", ring.lane)], "it did not go there"
    assert not [each for each in events if isinstance(each, ev.IssueRaised)]
    begun = [each.robot for each in events if isinstance(each, ev.LegBegun)]
    assert begun == [robot1, robot2]
