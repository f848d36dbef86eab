"""Two weeks of the published tasks, many times over: where the time goes, and what transfers save.

The 140 tasks of Table 2 in Veloso et al., "CoBots: Robust Symbiotic Autonomous Mobile Service
Robots" (IJCAI 2015), 66 of them over several floors, are asked for at random on ten weekdays from
nine to five, in an office of several floors, and carried out in discrete events
(`fleet/dispatch/discrete_execution.py`): drives take what the drive-time model says
(`drive_times.py`), elevators one robot at a time, and people drawn times. Printed is how the time
of each kind of task is split as in its Figure 7; and how long people waited with and without places
where things may change robots.

    python benchmarks/dispatch_weeks.py [--seeds 30] [--first 1] [--robots 4] [--quick]
"""

# ruff: noqa: T201
import argparse
from collections import defaultdict
from dataclasses import dataclass, field
from random import Random
from statistics import fmean, stdev
from typing import Any

from mend.fleet.dispatch.discrete_execution import DiscreteExecution, LegTimes
from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.dispatch.leg import LegOutcome
from mend.fleet.dispatch.setting import FleetSetting, ServiceRobot
from mend.fleet.requests import RequestStatus, request_of
from mend.fleet.scheduling.alns.solve import prepare
from mend.maps.building.building import Building, PlaceKind
from mend.maps.building.random_building import random_building
from mend.sim.building.trips import BuildingTrips

TASKS = {
    "escort": (3, 2),
    "go_to_room": (52, 22),
    "deliver_message": (56, 20),
    "transport": (29, 22),
}
"""How many of each kind, and how many of those over several floors (Table 2)."""
DAY_S, FROM_S, UNTIL_S = 86400.0, 9 * 3600.0, 17 * 3600.0
WEEKDAYS = (0, 1, 2, 3, 4, 7, 8, 9, 10, 11)
PUBLISHED_S = 9 * 3600.0 + 13 * 60.0
"""What the 140 tasks took together, by the text to Figure 7."""
PARTS = {
    "start_s": "help at start",
    "elevator_s": "elevator",
    "driving_s": "navigating",
    "blocked_s": "blocked",
    "end_s": "help at end",
}
"""Its parts, as Figure 7 calls them."""
T_95 = 1.96


@dataclass
class Weeks:
    """What two weeks came to: the time of each kind by its parts, and how long people waited."""

    spent_s: dict[str, dict[str, float]] = field(
        default_factory=lambda: defaultdict(lambda: dict.fromkeys(PARTS, 0.0))
    )
    tasks: dict[str, int] = field(default_factory=lambda: defaultdict(int))
    waited_s: dict[str, float] = field(default_factory=dict)
    failed: int = 0
    given: int = 0


def main() -> None:
    """Run the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=30)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--robots", type=int, default=4)
    parser.add_argument("--floors", type=int, default=4)
    parser.add_argument("--quick", action="store_true", help="two weeks once, of two robots")
    given = parser.parse_args()
    seeds = 1 if given.quick else given.seeds
    robots = 2 if given.quick else given.robots
    prepare()
    alone, together = [], []
    for seed in range(given.first, given.first + seeds):
        for weeks, transfers in ((alone, False), (together, True)):
            weeks.append(two_weeks(seed, robots, given.floors, transfers=transfers))
    _print_split(alone + together)
    _print_transfers(alone, together)


def two_weeks(seed: int, robots: int, floors: int, *, transfers: bool) -> Weeks:
    """Two weeks of the published tasks; `transfers`: things may change robots at the elevators."""
    building = Building(random_building(seed, floors, 12))
    chance = Random(seed)
    rooms = building.of_kind(PlaceKind.ROOM)
    fleet = tuple(
        ServiceRobot(name=f"r{number}", start=chance.choice(rooms), capacity=3.0)
        for number in range(robots)
    )
    lifts = tuple(building.of_kind(PlaceKind.ELEVATOR)) if transfers else ()
    setting = FleetSetting(robots=fleet, transfer_places=lifts)
    dispatcher = Dispatcher(building, setting)
    execution = DiscreteExecution(dispatcher, BuildingTrips(building), LegTimes(), Random(seed + 1))
    weeks, asked_s = Weeks(), {}
    for name, (at_s, kind, several) in enumerate(_tasks(chance)):
        execution.run_until(at_s)
        wanted = _request(f"t{name}", kind, several, dispatcher, rooms, chance)
        if dispatcher.submit(request_of(wanted), execution.now_s).booked:
            asked_s[f"t{name}"] = execution.now_s
    execution.run_until(14 * DAY_S)
    _sum_up(weeks, execution, asked_s)
    return weeks


def _tasks(chance: Random) -> list[tuple[float, str, bool]]:
    """When which kind is asked for, and whether over several floors."""
    kinds = [(kind, n < many) for kind, (all_, many) in TASKS.items() for n in range(all_)]
    at_s = [DAY_S * chance.choice(WEEKDAYS) + chance.uniform(FROM_S, UNTIL_S) for _ in kinds]
    return sorted((time_s, *task) for time_s, task in zip(at_s, kinds, strict=True))


def _request(
    name: str, kind: str, several: bool, dispatcher: Dispatcher, rooms: list[str], chance: Random
) -> dict[str, Any]:
    """Several floors: from floor to floor, or to a floor on which no robot is."""
    graph = dispatcher.building.graph.places
    stand = {graph[each.place].name.split("/")[0] for each in dispatcher.fleet.robots.values()}
    origin = chance.choice(rooms)
    floor = origin.split("/")[0]
    if kind in ("go_to_room", "deliver_message"):
        fitting = [each for each in rooms if (each.split("/")[0] not in stand) is several]
        fields = {"place": chance.choice(fitting or rooms)}
        if kind == "deliver_message":
            fields["message"] = "hello"
        return {"kind": kind, "name": name, **fields}
    others = [e for e in rooms if e != origin and (e.split("/")[0] != floor) is several]
    ways = {"origin": origin, "destination": chance.choice(others)}
    what = {"what": "mail"} if kind == "transport" else {"person": "Ann"}
    return {"kind": kind, "name": name, **ways, **what}


def _sum_up(weeks: Weeks, execution: DiscreteExecution, asked_s: dict[str, float]) -> None:
    ended_s: dict[str, float] = {}
    for record in execution.records:
        if record.outcome is not LegOutcome.DONE:
            continue
        kind = str(record.leg.request.kind)
        for part in PARTS:
            weeks.spent_s[kind][part] += getattr(record, part)
        lasts_s = sum(getattr(record, part) for part in (*PARTS, "waiting_s"))
        ended_s[record.leg.booking] = record.begun_s + lasts_s
        weeks.given += record.leg.action == "give"
    for view in execution.dispatcher.views():
        if view.status is RequestStatus.DONE:
            weeks.tasks[str(view.request.kind)] += 1
            weeks.waited_s[view.name] = ended_s[view.name] - asked_s[view.name]
        else:
            weeks.failed += 1


def _print_split(all_: list[Weeks]) -> None:
    """The split of Figure 7, which shows it as bars without numbers; the text has the sum."""
    print("seconds a task, by kind, and the share of each part")
    print(f"{'':16}{'tasks':>7}" + "".join(f"{each:>17}" for each in (*PARTS.values(), "sum")))
    shares: dict[str, float] = dict.fromkeys(PARTS, 0.0)
    for kind in TASKS:
        tasks = sum(each.tasks[kind] for each in all_)
        parts = {part: sum(each.spent_s[kind][part] for each in all_) for part in PARTS}
        shares = {part: spent_s + parts[part] for part, spent_s in shares.items()}
        cells = [*parts.values(), sum(parts.values())]
        print(f"{kind:16}{tasks:>7}" + "".join(f"{each / max(1, tasks):>17.1f}" for each in cells))
    sum_s, tasks = sum(shares.values()), sum(sum(each.tasks.values()) for each in all_)
    cells = [*shares.values(), sum_s]
    print(f"{'all':16}{tasks:>7}" + "".join(f"{each / tasks:>17.1f}" for each in cells))
    print(f"{'':23}" + "".join(f"{100 * each / sum_s:>15.0f} %" for each in cells))
    print(f"published: 140 tasks in {PUBLISHED_S:.0f} s, {PUBLISHED_S / 140:.0f} s each")


def _print_transfers(alone: list[Weeks], together: list[Weeks]) -> None:
    both = [
        (a, b, a.waited_s.keys() & b.waited_s.keys()) for a, b in zip(alone, together, strict=True)
    ]
    saved = [fmean(a.waited_s[n] - b.waited_s[n] for n in names) for a, b, names in both]
    waited = [fmean(a.waited_s[n] for n in names) for a, b, names in both]
    spread = T_95 * stdev(saved) / len(saved) ** 0.5 if len(saved) > 1 else float("nan")
    print(f"asked until done, without transfers: {fmean(waited):.1f} s")
    print(
        f"with transfers {fmean(saved):.1f} s less (95 % {fmean(saved) - spread:.1f} to "
        f"{fmean(saved) + spread:.1f}), in {sum(each.given for each in together)} transfers"
    )
    failed = [sum(each.failed for each in weeks) for weeks in (alone, together)]
    print(f"not done: {failed[0]} without transfers, {failed[1]} with")


if __name__ == "__main__":
    main()
