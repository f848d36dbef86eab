"""Where robots of a fleet have been: frames as one of them moves, robots in the fleet's order."""

import math
import struct
from pathlib import Path
from uuid import UUID

import pytest

from mend.robots.link.messages import IDENTITY, Poses, PoseValues
from mend.server.fleets.fleet_track import FleetTrack
from mend.server.poses.frame import Frame as Recorded
from mend.server.poses.frame import time_of
from mend.server.poses.record import PoseRecords
from mend.tasks.frames import Frame

SITE = UUID(int=7)
FRAMES = {"r0": Frame(), "r1": Frame(x=1.0, y=2.0, quarters=1)}


def at(x: float, y: float = 0.0) -> PoseValues:
    return (x, y, 0.0, *IDENTITY[3:])


def poses(time_s: float, base: PoseValues) -> Poses:
    return Poses(time=time_s, tool=IDENTITY, opening_m=0.0, base=base)


def bases(frame: Recorded) -> list[tuple[float, ...]]:
    """x, y and age of each robot."""
    values = [struct.unpack_from("<8f", frame, 76 + 32 * number) for number in range(2)]
    return [(round(each[0], 3), round(each[1], 3), each[7]) for each in values]


class Recording:
    def __init__(self, folder: Path, since_s: float = -math.inf) -> None:
        self.records = PoseRecords(folder)
        self.track = FleetTrack(FRAMES, self.records.open(SITE), since_s)

    async def frames(self) -> list[Recorded]:
        return list((await self.records.read(SITE, 0.0, math.inf, 1000)).frames)


async def test_robots_stand_in_the_frame_of_the_scene_in_the_order_of_the_fleet(
    tmp_path: Path,
) -> None:
    recording = Recording(tmp_path)
    recording.track.take("r1", poses(1.0, at(3.0)))
    recording.track.take("r0", poses(2.0, at(4.0)))
    first, second = await recording.frames()
    assert bases(first) == [(0.0, 0.0, math.inf), (1.0, 5.0, 0.0)]
    assert bases(second) == [(4.0, 0.0, 0.0), (1.0, 5.0, 1.0)]


async def test_who_stands_is_recorded_now_and_then_only(tmp_path: Path) -> None:
    recording = Recording(tmp_path)
    for half_seconds in range(41):
        recording.track.take("r0", poses(half_seconds / 2, at(1.0)))
    assert [time_of(each) for each in await recording.frames()] == [0.0, 5.0, 10.0, 15.0, 20.0]


async def test_who_moves_is_recorded_every_half_second(tmp_path: Path) -> None:
    recording = Recording(tmp_path)
    for tenths in range(21):
        recording.track.take("r0", poses(tenths / 10, at(tenths / 10)))
    assert [time_of(each) for each in await recording.frames()] == pytest.approx(
        [0.0, 0.5, 1.0, 1.5, 2.0]
    )


async def test_who_turns_on_the_spot_has_moved(tmp_path: Path) -> None:
    recording = Recording(tmp_path)
    recording.track.take("r0", poses(0.0, at(1.0)))
    turned = (1.0, 0.0, 0.0, 0.0, 0.0, math.sin(0.1), math.cos(0.1))
    recording.track.take("r0", poses(1.0, turned))
    assert len(await recording.frames()) == 2


async def test_time_that_passes_once_more_is_recorded_once(tmp_path: Path) -> None:
    recording = Recording(tmp_path, since_s=10.0)
    for time_s in (8.0, 10.0, 10.4, 11.0, 3.0):
        recording.track.take("r0", poses(time_s, at(time_s)))
    assert [time_of(each) for each in await recording.frames()] == [11.0]
