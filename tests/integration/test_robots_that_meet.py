"""Robots of one fleet that meet in a doorway resolve it, and nobody is asked for anything."""

import asyncio
import math
from pathlib import Path

import pytest
from awaited_events import events_until
from office_with_fleet import office, open_office_with_fleet

from mend.server.composition import open_service
from mend.server.journal import events as ev
from mend.server.settings import Settings
from mend.tasks.scene import Base

PATIENCE_S = 200.0
ROOM = "101"
FROM_DOOR_M = 0.9


def face_to_face() -> dict[str, Base]:
    """One robot on each side of the door of a room, the first within."""
    floor = office().floors["F1"]
    (ax, ay), (bx, by) = floor.doors[ROOM].posts
    x, y, room = (ax + bx) / 2.0, (ay + by) / 2.0, floor.places[ROOM]
    away_m = math.dist((x, y), (room.x, room.y))
    off = FROM_DOOR_M * (room.x - x) / away_m, FROM_DOOR_M * (room.y - y) / away_m
    return {
        "robot1": Base(x=x + off[0], y=y + off[1]),
        "robot2": Base(x=x - off[0], y=y - off[1]),
    }


@pytest.mark.slow(15)
async def test_one_of_two_that_meet_in_a_door_makes_way_and_nobody_is_asked(
    tmp_path: Path,
) -> None:
    settings = Settings(port=0, data_dir=tmp_path, log_level="error", speech_voice="none")
    async with open_service(settings) as service, asyncio.timeout(PATIENCE_S):
        site = await open_office_with_fleet(service, 5.0, robots=2, stand=face_to_face())
        fleet = await service.fleets.fleet(site)
        inside, outside = fleet.dispatcher.fleet.robots
        await fleet.operators.send(inside, "F1/103", None)
        await fleet.operators.send(outside, f"F1/{ROOM}", None)
        events = await events_until(
            service, lambda all_: sum(isinstance(e, ev.ErrandEnded) for e in all_) == 2
        )
    ended = {each.robot: each for each in events if isinstance(each, ev.ErrandEnded)}
    assert {robot: (each.came, each.at) for robot, each in ended.items()} == {
        inside: (True, "F1/103"),
        outside: (True, f"F1/{ROOM}"),
    }
    assert not [each for each in events if isinstance(each, ev.IssueRaised)]
    told = [each.told for each in events if isinstance(each, ev.FleetTold)]
    assert any("is to make way" in each for each in told)
