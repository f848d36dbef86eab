"""Robots that meet where they cannot pass each other: who gets on without asking anybody?

    python benchmarks/robots_that_meet.py [--meetings 40] [--robots 2] [--first 0] [--quick]

Each meeting is drawn. In three of four a robot is to leave a room of a made-up office that another
one is to enter, each somewhere near the door; a third one may stand behind either. In the fourth
two rooms are joined by a corridor of 0.8 to 1.0 m, 2 to 8 m long, in which they meet. Robots know
where they are. Each meeting is gone through twice: told by the fleet who makes way, and untold, as
each robot would do alone. A meeting is resolved if all arrive, and nobody was asked for anything.
The exit code is 1 if robots touch each other, or more are resolved untold than told.
"""

# ruff: noqa: T201
import argparse
import math
import sys
from dataclasses import dataclass
from pathlib import Path
from random import Random

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "doubles"))

from building_bench import BuildingBench
from met_robots import MetRobots

from mend.maps.building.building import (
    Building,
    BuildingDocument,
    Floor,
    FloorPlace,
    Lane,
    PlaceKind,
)
from mend.maps.building.random_building import random_building
from mend.robots.link.messages import Finished, IssueDetected
from mend.sim.building.floor_pose import FloorPose
from mend.sim.building.scene import scene_of

LONGEST_S = 180.0
Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Meeting:
    """Where robots stand and go, in one building."""

    building: Building
    stand: list[Point]
    goals: list[str]


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of it; `took_s` until the last had arrived or asked."""

    resolved: bool
    took_s: float
    made_way: int
    touched: bool


def drawn(seed: int, robots: int) -> Meeting:
    """One meeting; the same for the same seed."""
    chance = Random(seed)
    return in_corridor(chance) if chance.random() < 0.25 else at_door(chance, seed, robots)


def at_door(chance: Random, seed: int, robots: int) -> Meeting:
    """One leaves a room that another one enters; a third one stands behind one of them."""
    building = Building(random_building(seed, 1, chance.choice([4, 8, 12])))
    floor = building.floors["F1"]
    rooms = sorted(set(floor.doors) & set(floor.places))
    goals = chance.sample(rooms, robots)
    room, (a, b) = floor.places[goals[0]], floor.doors[goals[0]].posts
    door = (a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0
    away_m = math.dist(door, (room.x, room.y))
    inwards = (room.x - door[0]) / away_m, (room.y - door[1]) / away_m
    inside_m, outside_m = chance.uniform(0.8, away_m), chance.uniform(0.8, 1.2)
    aside = -inwards[1] * 0.75, inwards[0] * 0.75

    def at(metres: float, off: Point = (0.0, 0.0)) -> Point:
        return door[0] + metres * inwards[0] + off[0], door[1] + metres * inwards[1] + off[1]

    stand = [at(-outside_m), at(inside_m), at(-outside_m, aside)][:robots]
    return Meeting(building, stand, [f"F1/{each}" for each in goals])


def in_corridor(chance: Random) -> Meeting:
    """Two rooms with a narrow corridor between them, and a robot in each end of that."""
    long_m, half_m = chance.uniform(2.0, 8.0), chance.uniform(0.4, 0.5)
    start, end = 4.0, 4.0 + long_m
    walls = [(x, y, x, -y) for x in (0.0, end + 4.0) for y in (2.0,)]
    for side in (-1.0, 1.0):
        y, edge = side * 2.0, side * half_m
        walls += [(0.0, y, start, y), (end, y, end + 4.0, y), (start, edge, end, edge)]
        walls += [(start, edge, start, y), (end, edge, end, y)]
    places = {
        "left": FloorPlace(x=1.0, y=1.0, kind=PlaceKind.ROOM),
        "west": FloorPlace(x=start - 1.0, y=0.0),
        "east": FloorPlace(x=end + 1.0, y=0.0),
        "right": FloorPlace(x=end + 3.0, y=1.0, kind=PlaceKind.ROOM),
    }
    lanes = [Lane(between=each) for each in (("left", "west"), ("west", "east"), ("east", "right"))]
    floor = Floor(places=places, lanes=tuple(lanes), walls=tuple(walls))
    document = BuildingDocument(building="corridor", floors={"F1": floor})
    meet_m = chance.uniform(start, end)
    stand = [(max(3.0, meet_m - 1.0), 0.0), (min(end + 1.0, meet_m + 1.0), 0.0)]
    return Meeting(Building(document), stand, ["F1/right", "F1/left"])


def go_through(meeting: Meeting, seed: int, *, told: bool) -> Outcome:
    """Let them meet."""
    scene = scene_of(meeting.building, "meeting", len(meeting.stand))
    bench = BuildingBench(scene, seed=seed)
    names = list(scene.robots)
    for robot, (x, y) in zip(bench.world.robots, meeting.stand, strict=True):
        robot.stand(FloorPose("F1", x, y, 0.0))
    met = MetRobots(bench, dict(zip(names, meeting.goals, strict=True)))
    for name, goal in zip(names, meeting.goals, strict=True):
        bench.go(name, goal.replace("/", "-"))
    before = bench.world.touches
    while (met.advance(0.5) if told else bench.group.advance(0.5)) and not bench.of(IssueDetected):
        if bench.group.time_s() > LONGEST_S:
            break
    resolved = len(bench.of(Finished)) == len(names) and not bench.of(IssueDetected)
    touched = bench.world.touches > before
    return Outcome(resolved, bench.group.time_s(), len(met.told) // 2, touched)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--meetings", type=int, default=40)
    parser.add_argument("--robots", type=int, choices=(2, 3), default=2, help="at doors")
    parser.add_argument("--first", type=int, default=0, help="the first seed")
    parser.add_argument("--quick", action="store_true", help="two meetings")
    options = parser.parse_args()
    count = 2 if options.quick else options.meetings
    found: dict[bool, list[Outcome]] = {True: [], False: []}
    for seed in range(options.first, options.first + count):
        for told in found:
            outcome = go_through(drawn(seed, options.robots), seed, told=told)
            found[told].append(outcome)
            if told and not outcome.resolved:
                print(f"seed {seed}: not resolved, {outcome.made_way} times made way", flush=True)
    for told, outcomes in found.items():
        resolved = [each for each in outcomes if each.resolved]
        took_s = sum(each.took_s for each in resolved) / max(1, len(resolved))
        print(
            f"{'told' if told else 'untold':7}{len(resolved):4} of {count} meetings resolved, in "
            f"{took_s:.1f} s on average; {sum(each.made_way for each in outcomes)} times one made "
            f"way; robots touched something in {sum(each.touched for each in outcomes)}"
        )
    ratio = [sum(each.resolved for each in found[told]) for told in (True, False)]
    print(f"{ratio[0] / max(1, ratio[1]):.2f} x as many are resolved where robots are told")
    touched = any(each.touched for each in found[True])
    return 1 if touched or ratio[0] < ratio[1] else 0


if __name__ == "__main__":
    sys.exit(main())
