"""Days of deliveries in drawn buildings, with robots that find out themselves where they are.

    python benchmarks/building_day.py [--first 0] [--buildings 1] [--hours 8] [--robots 3]
        [--every 600] [--unmapped 0.33] [--localizer enml|exact] [--escorts 0] [--log FILE]

People of a building ask for transports, messages and visits about every so many seconds (`--every`,
for each robot), for so many hours; the dispatcher hands them to the robots, and somebody does what
robots ask. A fifth of the doors that people open are shut at first. Nothing has to be done by any
time, so that a day is over once nothing is open any more. `--escorts`: so many are asked for to ten
others. Told are the requests that were met; how far off robots were while
they said that they knew where they were, how often one was more than 2 m off for longer than 2 s
without having said that it is lost, and for how many seconds in all; how often one was lost, and
for how long. `--log` keeps what was said. The exit code is 1 where something was not met, or a
robot was wrong in silence or touched anything.
"""

# ruff: noqa: T201
import argparse
import asyncio
import os
import sys
import time
from collections import Counter
from collections.abc import Callable
from contextlib import redirect_stdout
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from believed_poses import BelievedPoses
from dispatch_happenings import DispatchHappenings

from mend.fleet.request_file import RequestsDocument
from mend.maps.building.building import Building
from mend.maps.building.random_building import random_building
from mend.server.cli.run_request import closed_settings
from mend.server.cli.shift import Shift
from mend.server.sites.requests import FleetOptions
from mend.sim.building.buildings import BUILDINGS
from mend.sim.building.scene import scene_of
from mend.sim.building.world import BuildingWorld
from mend.sim.shared_world import SharedWorld
from mend.sim.world import WorldSetup

MIX = {"transport": 6, "deliver_message": 2, "go_to_room": 2}
LOOKS_EVERY_S = 0.25


class WatchedDay:
    """The world of a day, looked at while its time passes."""

    def __init__(self) -> None:
        self.world: BuildingWorld | None = None
        self.poses = BelievedPoses([])
        self.starts = 0
        self._create = BUILDINGS.create_agents
        self._looked_s = 0.0

    def __enter__(self) -> "WatchedDay":
        BUILDINGS.create_agents = self._watched  # type: ignore[method-assign]
        return self

    def __exit__(self, *_: object) -> None:
        BUILDINGS.create_agents = self._create  # type: ignore[method-assign]

    def _watched(self, setup: WorldSetup) -> SharedWorld:
        group = self._create(setup)
        assert isinstance(group.world, BuildingWorld), "it is a building"
        self.world, self.poses.robots = group.world, group.world.robots
        self.starts += 1
        self.world.advance_cycle = self._looking(self.world)  # type: ignore[method-assign]
        return group

    def _looking(self, world: BuildingWorld) -> Callable[[], None]:
        advance_cycle, poses = world.advance_cycle, self.poses

        def advance() -> None:
            advance_cycle()
            now_s = world.time_s()
            if abs(now_s - self._looked_s) >= LOOKS_EVERY_S - 1e-9:
                poses.look(now_s, max(0.0, now_s - self._looked_s))
                self._looked_s = now_s

        return advance


def asked(building: Building, seed: int, options: argparse.Namespace) -> RequestsDocument:
    """What people ask for in the course of a day, and when."""
    chance = Random(seed)
    people = DispatchHappenings(building, chance, mix={**MIX, "escort": options.escorts})
    until_s = options.hours * 3600.0
    requests, asked_s, now_s = list[dict[str, Any]](), {}, 0.0
    while (now_s := now_s + chance.expovariate(options.robots / options.every)) < until_s:
        request = people.request(now_s)
        for limit in ("latest_s", "recurrence"):
            request.pop(limit, None)
        requests.append(request)
        asked_s[request["name"]] = now_s
    document = {"requests": requests, "asked_s": asked_s}
    return RequestsDocument.model_validate(document, strict=False)


def main() -> int:
    """Run the command line."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--buildings", type=int, default=1)
    parser.add_argument("--hours", type=float, default=8.0)
    parser.add_argument("--robots", type=int, default=3)
    parser.add_argument("--every", type=float, default=600.0)
    parser.add_argument("--unmapped", type=float, default=0.33)
    parser.add_argument("--localizer", choices=["enml", "exact"], default="enml")
    parser.add_argument("--escorts", type=int, default=0)
    parser.add_argument("--log", type=Path, default=Path(os.devnull))
    options = parser.parse_args()
    with options.log.open("w", encoding="utf-8") as log:
        seeds = range(options.first, options.first + options.buildings)
        went_well = [_day(seed, options, log) for seed in seeds]
    return 0 if all(went_well) else 1


def _day(seed: int, options: argparse.Namespace, log: Any) -> bool:
    """One day in one building; whether all of it went well."""
    building = Building(random_building(seed, 1 + seed % 4, 6 + seed % 15))
    shift = Shift(
        scene_of(building, "day", options.robots),
        asked(building, seed, options),
        seed=seed,
        options={"localizer": options.localizer, "unmapped": options.unmapped},
        fleet=FleetOptions(capacity=3.0, transfer_places=(), answers="yes"),
        speed="max",
    )
    began_s = time.process_time()
    with TemporaryDirectory() as folder, WatchedDay() as day, redirect_stdout(log):
        settings = closed_settings().model_copy(update={"journal": Path(folder) / "journal"})
        asyncio.run(shift.carry_out(settings))
    took_s = time.process_time() - began_s
    world, poses = day.world, day.poses
    assert world is not None, "it was opened"
    ended, lost_s = Counter(shift.ended.values()), poses.lost_s or [0.0]
    silent = poses.silent["silent"]
    print(
        f"seed {seed}: {len(shift.ended)} asked, {_told(ended)}{poses.told}; "
        f"{silent} times silent, {poses.silent_s:.1f} s in all; lost {len(poses.lost_s)} times, "
        f"{np.median(lost_s):.1f} s (p50), {max(lost_s):.1f} s (max), {poses.still_lost} for good; "
        f"{world.touches} touches; its world died {day.starts - 1} times; "
        f"{world.time_s() / 3600.0:.1f} h, {world.time_s() / took_s:.0f} x real time",
        flush=True,
    )
    well = set(ended) <= {"done"} and day.starts == 1
    return well and not (silent or world.touches or poses.still_lost)


def _told(counts: Counter[str]) -> str:
    return ", ".join(f"{count} {what}" for what, count in sorted(counts.items()))


if __name__ == "__main__":
    sys.exit(main())
