"""Days of a building in discrete events: how fast, and where the time of its robots goes.

Requests of the published mix come at random from eight to six. Drives take what the drive-time
model says (`drive_times.py`), elevators one robot at a time, and people drawn times.

    python benchmarks/dispatch_days.py [--days 1] [--robots 4] [--requests 40] [--seed 1]
"""

# ruff: noqa: T201
import argparse
import time
from collections import Counter
from random import Random
from statistics import median

from dispatch_happenings import DispatchHappenings, drawn_fleet

from mend.fleet.dispatch.discrete_execution import DiscreteExecution, LegTimes
from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.requests import request_of
from mend.fleet.scheduling.alns.solve import prepare
from mend.sim.building.trips import BuildingTrips

DAY_S, FROM_S, UNTIL_S = 86400.0, 8 * 3600.0, 18 * 3600.0
PARTS = ("start_s", "elevator_s", "driving_s", "blocked_s", "waiting_s", "end_s")


def main() -> None:
    """Run the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--days", type=int, default=1)
    parser.add_argument("--robots", type=int, default=4)
    parser.add_argument("--requests", type=int, default=40, help="a day")
    parser.add_argument("--floors", type=int, default=4)
    parser.add_argument("--rooms", type=int, default=12)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    building, setting = drawn_fleet(
        given.seed, floors=given.floors, rooms=given.rooms, robots=given.robots
    )
    prepare()
    dispatcher = Dispatcher(building, setting)
    execution = DiscreteExecution(
        dispatcher, BuildingTrips(building), LegTimes(), Random(given.seed)
    )
    people, chance = DispatchHappenings(building, Random(given.seed)), Random(given.seed + 1)
    took_ms: dict[bool, list[float]] = {True: [], False: []}
    began_s = time.process_time()
    for day in range(given.days):
        begins_s = day * DAY_S
        times = sorted(chance.uniform(FROM_S, UNTIL_S) for _ in range(given.requests))
        for asked_s in times:
            execution.run_until(begins_s + asked_s)
            request = request_of(people.request(execution.now_s))
            once, submitted_s = request.model_copy(update={"recurrence": None}), time.process_time()
            booked = dispatcher.submit(once, execution.now_s).booked
            took_ms[booked].append(1000 * (time.process_time() - submitted_s))
        execution.run_until(begins_s + DAY_S)
    took_s = time.process_time() - began_s
    ended = Counter(str(view.status) for view in dispatcher.views())
    print(f"{given.days} days, {given.robots} robots, {given.requests} requests a day")
    print(f"{took_s:.1f} s of the processor: {given.days * DAY_S / took_s:.0f} x real time")
    print("the latest requests:", ", ".join(f"{n} {status}" for status, n in ended.most_common()))
    for booked, each in took_ms.items():
        if each:
            what = "to book one" if booked else "to refuse one and look for another time"
            print(f"{what}: p50 {median(each):.0f} ms, longest {max(each):.0f} ms")
    spent = {part: sum(getattr(each, part) for each in execution.records) for part in PARTS}
    print(
        ", ".join(f"{part[:-2]} {100 * s / sum(spent.values()):.0f} %" for part, s in spent.items())
    )


if __name__ == "__main__":
    main()
