"""A dispatcher against doing without: what is done in time, how long people wait, metres driven.

The same requests of the published mix, in drawn offices, in discrete events
(`fleet/dispatch/discrete_execution.py`; the same drive times, elevators that take one robot at a
time, people's times from the same distributions; nothing fails), shared out by the dispatcher,
first come first served, and by lowest bid as in Open-RMF, the last two one request at a time for
each robot (`peers/one_task_at_a_time.py`). Most requests have a latest moment. What the dispatcher
refuses, since it cannot be done in time, counts as not done in time; the others do it late. What a
plan changed on the way counts as driven to its end. Told are the means over the seeds and how much
the others differ, with their 95 % intervals.

    python benchmarks/dispatch_peers.py [--seeds 30] [--first 1] [--robots 4] [--hours 2]
        [--requests 60 120 180 240] [--floors 4] [--quick]
"""

# ruff: noqa: T201
import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from random import Random
from statistics import fmean, stdev

from dispatch_happenings import MIX
from peers.one_task_at_a_time import OneTaskAtATime, Sharing

from mend.fleet.dispatch.booking import AnyRequest
from mend.fleet.dispatch.discrete_execution import DiscreteExecution, LegTimes
from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.dispatch.leg import LegOutcome
from mend.fleet.dispatch.setting import FleetSetting, ServiceRobot
from mend.fleet.requests import RequestStatus, request_of
from mend.fleet.scheduling.alns.solve import prepare
from mend.maps.building.building import Building, PlaceKind
from mend.maps.building.random_building import random_building
from mend.sim.building.trips import BuildingTrips

TIMES = LegTimes(fails=0.0, loses=0.0)
MEND = "dispatcher"
LATEST_S = (None, 300.0, 600.0, 1200.0, 2400.0)
LONGEST_S = 24 * 3600.0
T_95 = 1.96
Asked = Sequence[tuple[float, AnyRequest]]


@dataclass(frozen=True, slots=True)
class Shift:
    """When each request was done (seconds), and how far robots drove for all of them."""

    done_s: dict[str, float]
    driven_m: float


def main() -> None:
    """Run the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=30)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--robots", type=int, default=4)
    parser.add_argument("--requests", type=int, nargs="+", default=[60, 120, 180, 240])
    parser.add_argument("--hours", type=float, default=2.0)
    parser.add_argument("--floors", type=int, default=4)
    parser.add_argument("--quick", action="store_true", help="two seeds of one size")
    given = parser.parse_args()
    prepare()
    for requests in given.requests[:1] if given.quick else given.requests:
        print(f"{requests} requests in {given.hours:g} h, {given.robots} robots")
        shifts = [
            (asked, shifts_of(building, setting, asked, seed))
            for seed in range(given.first, given.first + (2 if given.quick else given.seeds))
            for building, setting, asked in [drawn_shift(seed, requests, given)]
        ]
        print_shifts(shifts)


def drawn_shift(
    seed: int, requests: int, given: argparse.Namespace
) -> tuple[Building, FleetSetting, Asked]:
    """An office, its robots, and what is asked for when."""
    chance = Random(seed)
    building = Building(random_building(seed, given.floors, 12))
    rooms = building.of_kind(PlaceKind.ROOM)
    robots = tuple(
        ServiceRobot(name=f"r{number}", start=chance.choice(rooms), capacity=3.0)
        for number in range(given.robots)
    )
    times_s = sorted(chance.uniform(0.0, 3600.0 * given.hours) for _ in range(requests))
    asked = [(at_s, _request(f"q{n}", at_s, rooms, chance)) for n, at_s in enumerate(times_s)]
    return building, FleetSetting(robots=robots), asked


def _request(name: str, asked_s: float, rooms: list[str], chance: Random) -> AnyRequest:
    kind = chance.choices(list(MIX), weights=list(MIX.values()))[0]
    origin, destination = chance.sample(rooms, 2)
    within_s = chance.choice(LATEST_S)
    latest_s = None if within_s is None else asked_s + within_s
    common = {"kind": kind, "name": name, "earliest_s": asked_s, "latest_s": latest_s}
    match kind:
        case "escort":
            more = {"origin": origin, "destination": destination, "person": "Ann"}
        case "transport":
            more = {"origin": origin, "destination": destination, "what": "a parcel"}
        case "deliver_message":
            more = {"place": origin, "message": "the meeting begins"}
        case _:
            more = {"place": origin}
    return request_of({**common, **more})


def shifts_of(
    building: Building, setting: FleetSetting, asked: Asked, seed: int
) -> dict[str, Shift]:
    """The same requests in each of the three ways."""
    trips = BuildingTrips(building)
    shifts = {MEND: _dispatched(building, setting, asked, trips, seed)}
    for sharing in Sharing:
        fleet = OneTaskAtATime(building, setting, trips, TIMES, sharing, Random(seed + 1))
        fleet.work_off(asked)
        shifts[sharing] = Shift(fleet.done_s, fleet.driven_m)
    return shifts


def _dispatched(
    building: Building, setting: FleetSetting, asked: Asked, trips: BuildingTrips, seed: int
) -> Shift:
    dispatcher = Dispatcher(building, setting)
    execution = DiscreteExecution(dispatcher, trips, TIMES, Random(seed + 1))
    for at_s, request in asked:
        execution.run_until(at_s)
        dispatcher.submit(request, at_s)
    execution.run_until(asked[-1][0] + LONGEST_S)
    done_s = {}
    for record in execution.records:
        leg = record.leg
        if record.outcome is not LegOutcome.DONE:
            continue
        lasts_s = record.start_s + record.elevator_s + record.driving_s + record.blocked_s
        lasts_s += record.waiting_s + record.end_s + leg.done_s - leg.begins_s
        done_s[leg.booking] = record.begun_s + lasts_s
    done = [each.name for each in dispatcher.views() if each.status is RequestStatus.DONE]
    driven_m = sum(each.driven_m for each in execution.records)
    return Shift({name: done_s[name] for name in done}, driven_m)


def print_shifts(shifts: list[tuple[Asked, dict[str, Shift]]]) -> None:
    """The means, and how much the others differ from the dispatcher."""
    figures = {
        "in time, %": in_time,
        "asked until done, s": waited_s,
        "driven for each, m": driven_m,
    }
    print(f"{'':26}" + "".join(f"{each:>34}" for each in figures))
    for way in (MEND, *Sharing):
        cells = []
        for figure in figures.values():
            mine = [figure(asked, all_, way) for asked, all_ in shifts]
            less = [figure(asked, all_, MEND) for asked, all_ in shifts]
            cells.append(_cell(mine, less, way == MEND))
        print(f"{way:26}" + "".join(f"{each:>34}" for each in cells))
    asked_in_all = sum(len(asked) for asked, _ in shifts)
    done = {way: sum(len(all_[way].done_s) for _, all_ in shifts) for way in (MEND, *Sharing)}
    print("done at all:", ", ".join(f"{way} {done[way]} of {asked_in_all}" for way in done))


def _cell(mine: list[float], dispatcher: list[float], is_dispatcher: bool) -> str:
    if is_dispatcher:
        return f"{fmean(mine):.1f}"
    off = [a - b for a, b in zip(mine, dispatcher, strict=True)]
    spread = T_95 * stdev(off) / len(off) ** 0.5 if len(off) > 1 else float("nan")
    low, high = fmean(off) - spread, fmean(off) + spread
    return f"{fmean(mine):.1f} ({low:+.1f} to {high:+.1f})"


def in_time(asked: Asked, shifts: dict[str, Shift], way: str) -> float:
    """Of the requests with a latest moment, how many per cent are done by then."""
    done_s = shifts[way].done_s
    bounded = [each for _, each in asked if each.latest_s is not None]
    met = [e for e in bounded if e.latest_s is not None and done_s.get(e.name, 1e9) <= e.latest_s]
    return 100.0 * len(met) / max(1, len(bounded))


def waited_s(asked: Asked, shifts: dict[str, Shift], way: str) -> float:
    """Mean time from asking until done, of what is done in all ways."""
    everywhere = set.intersection(*(set(each.done_s) for each in shifts.values()))
    done_s = shifts[way].done_s
    return fmean(done_s[each.name] - at_s for at_s, each in asked if each.name in everywhere)


def driven_m(asked: Asked, shifts: dict[str, Shift], way: str) -> float:
    """Metres driven for each request that is done."""
    del asked
    return shifts[way].driven_m / max(1, len(shifts[way].done_s))


if __name__ == "__main__":
    main()
