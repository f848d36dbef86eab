"""A building as it really is: its doors, the people in it, and robots that drive."""

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from mend.maps.building.building import Building, DoorOpening
from mend.sim.building.barriers import Barriers
from mend.sim.building.belief import Belief, FloorMap
from mend.sim.building.building_robot import PERIOD_S, RADIUS_M, BuildingRobot, Senses
from mend.sim.building.bystander import Bystander
from mend.sim.building.carrying import Carrying
from mend.sim.building.chargers import is_at_charger
from mend.sim.building.crowd import Crowd
from mend.sim.building.cycles import Cycles
from mend.sim.building.doors import WorldDoors
from mend.sim.building.draws import read_draws, written_draws
from mend.sim.building.elevator_bank import ElevatorBank
from mend.sim.building.floor_pose import FloorPose
from mend.sim.building.furniture import Furniture
from mend.sim.building.gatherings import gatherings
from mend.sim.building.goods import Goods
from mend.sim.building.guests import Guests, Surroundings
from mend.sim.building.interveners import Interveners
from mend.sim.building.lasers import Lasers
from mend.sim.building.odometry import Odometer
from mend.sim.building.options import BuildingOptions
from mend.sim.building.robot_basket import RobotBasket
from mend.sim.building.robot_battery import RobotBattery
from mend.sim.building.robot_companion import RobotCompanion
from mend.sim.building.space import Space
from mend.sim.building.stillness import Stillness
from mend.sim.building.walkers import Walkers
from mend.sim.building.world_snapshot import WorldSnapshot
from mend.tasks.frames import Frame
from mend.tasks.intervention import Intervention

_FURNITURE_MOVES_EVERY_S = 60.0
"""So often somebody puts a piece of furniture elsewhere, on each floor."""
_FURNITURE_FROM_ROBOTS_M = 1.0


class BuildingWorld:
    """Implements `mend.sim.world.World`, and `LeapingWorld`.

    `touches` counts the cycles in which a robot drove against something, or somebody, `carried`
    how often one was carried elsewhere.
    """

    def __init__(
        self,
        building: Building,
        starts: Iterable[tuple[Frame, FloorPose]],
        options: BuildingOptions,
        rng: np.random.Generator,
        furniture: Furniture,
        carrying: Carrying,
        goods: Goods,
        places: Mapping[str, FloorPose],
        maps: Mapping[str, FloorMap] | None = None,
        names: Sequence[str] = (),
    ) -> None:
        """Robots find their way by `maps`; without, they know where they are.

        `places`: where people are, by the names that robots know. `names`: those of the robots, by
        which people tell them apart.
        """
        self.building = building
        self.elevators = ElevatorBank(building)
        self.touches = self.carried = 0
        self.goods = goods
        self._rng, self._furniture, self._carrying = rng, furniture, carrying
        self._furniture_moves_s = _FURNITURE_MOVES_EVERY_S
        self._cycles = Cycles()
        self.time_s = self._cycles.time_s
        self.doors = WorldDoors(
            building,
            lambda door: (
                door.opens is DoorOpening.ITSELF or bool(rng.random() < options.shut_doors)
            ),
        )
        self._barriers = Barriers(building, self.doors)
        self._crowd = crowd = Crowd(
            Walkers(building, options.people, self.doors.values(), goods.seed),
            Guests(options.no_shows, options.dawdling, places, goods.seed),
        )
        self._space = space = Space(
            building, self.doors, self._barriers, self.elevators, furniture, crowd
        )
        self._lasers = Lasers(building, space, crowd, rng, self.time_s)
        senses = Senses(self.time_s, self._height_m, self._lasers.newest, self.advance_cycle)
        starts = list(starts)
        crowd.robots += [_robot(*start, senses, rng, maps) for start in starts]
        if options.blocked_hallways:
            stand = [at for _, at in starts]
            crowd.bystanders = gatherings(building, options.blocked_hallways, goods.seed, stand)
        crowd.walkers.leave_room_for((at for _, at in starts), RADIUS_M)
        self.batteries = [RobotBattery(options.battery_wh) for _ in starts]
        self.baskets = [RobotBasket(goods, each, goods.seed) for each in range(len(starts))]
        self._around = Surroundings(
            segments=space.segments,
            people=crowd.people,
            robots=crowd.robots,
            room_beside=space.room_beside,
            stop_around=self.elevators.stop_around,
            doors=[e for e in self.doors.values() if e.plan.opens is DoorOpening.PEOPLE],
        )
        self.companions = [
            RobotCompanion(crowd.guests, each, number, goods.seed, space.sees)
            for number, each in enumerate(crowd.robots)
        ]
        self._stillness = Stillness(crowd, self.doors, self.elevators, self._lasers, carrying)
        self.interveners = Interveners(
            building=building,
            space=space,
            crowd=crowd,
            doors=self.doors,
            barriers=self._barriers,
            elevators=self.elevators,
            goods=goods,
            batteries=self.batteries,
            around=self._around,
            places=places,
            names=names,
            wrong_floors=options.wrong_floors,
            rng=rng,
            time_s=self.time_s,
        )

    # --- Who is there ---

    @property
    def robots(self) -> Sequence[BuildingRobot]:
        return self._crowd.robots

    @property
    def bystanders(self) -> list[Bystander]:
        """People who stand in a way until they are asked."""
        return self._crowd.bystanders

    @property
    def walkers(self) -> Walkers:
        return self._crowd.walkers

    @property
    def guests(self) -> Guests:
        return self._crowd.guests

    # --- Time ---

    def advance_cycle(self) -> None:
        self._cycles.passed += 1
        now_s, crowd = self.time_s(), self._crowd
        self.doors.let_pass(now_s, crowd.circles)
        crowd.walkers.walk(now_s, crowd.robots, crowd.standing(), self._space.segments)
        crowd.guests.walk(now_s, crowd.robots, self._around)
        self._move_furniture()
        if self._carrying.is_due(now_s):
            touches = self._space.touches
            self.carried += self._carrying.carry_one(crowd.robots, self.building, touches)
        for robot, battery in zip(crowd.robots, self.batteries, strict=True):
            self._use_battery(robot, battery)
        self.elevators.pass_time(now_s, crowd.robots, crowd.guests.there, crowd.circles)
        self._lasers.pass_time()

    def leap(self, until_s: float) -> None:
        """Let cycles that end before a time pass at once, as far as nothing happens in them."""
        now_s = self.time_s()
        ends_s = min(self._stillness.ends_s(self._cycles.passed, now_s), self._furniture_moves_s)
        cycles = self._cycles.before(min(until_s, ends_s))
        if cycles:
            self._cycles.passed += cycles
            self._stillness.skip(cycles)
            for battery in self.batteries:
                battery.stand(PERIOD_S, cycles)

    def _move_furniture(self) -> None:
        if self.time_s() < self._furniture_moves_s:
            return
        self._furniture_moves_s += _FURNITURE_MOVES_EVERY_S
        for floor in self.building.floors:
            stand = [(x, y) for x, y, _ in self._crowd.circles(floor)]
            self._furniture.move_one(floor, stand, _FURNITURE_FROM_ROBOTS_M)

    def _use_battery(self, robot: BuildingRobot, battery: RobotBattery) -> None:
        """Drive as far as the battery allows it."""
        before = robot.at
        if battery.empty:
            robot.bump()
        elif robot.moving:
            self._drive(robot)
        if not battery.endless:
            battery.docked = not robot.moving and is_at_charger(
                self.building, robot.at.floor, robot.at.x, robot.at.y
            )
            driven_m = math.hypot(robot.at.x - before.x, robot.at.y - before.y)
            battery.pass_time(PERIOD_S, driven_m)

    def _drive(self, robot: BuildingRobot) -> None:
        wanted = robot.next_pose()
        if wanted == robot.at:
            return
        if self._space.touches(wanted, robot.radius_m, robot):
            self.touches += 1
            robot.bump()
        else:
            robot.drive_to(wanted)

    def _height_m(self, floor: str) -> float:
        return self.elevators.height_m(floor, self.time_s())

    # --- People who act ---

    def intervene(self, intervention: Intervention) -> str:
        """Somebody blocks the first robot that drives, makes way, or handles what robots carry."""
        self._stillness.disturb()
        return self.interveners.intervene(intervention)

    # --- What it is rebuilt from ---

    def snapshot(self) -> dict[str, Any]:
        items, wishes = self.goods.snapshot()
        kept = WorldSnapshot(
            time_s=self.time_s(),
            robots=[(e.at.floor, e.at.x, e.at.y, e.at.yaw) for e in self.robots],
            doors={name: (each.is_shut, each.shuts_s) for name, each in self.doors.items()},
            bystanders=[(e.at.floor, e.at.x, e.at.y) for e in self.bystanders],
            cabins=self.elevators.snapshot(),
            odometers=[each.odometer.snapshot() for each in self.robots],
            beliefs=[
                None if each.belief is None else each.belief.snapshot() for each in self.robots
            ],
            barred=self._barriers.snapshot(),
            items=items,
            wishes=wishes,
            baskets=[each.snapshot() for each in self.baskets],
            batteries=[each.snapshot() for each in self.batteries],
            walkers=self.walkers.snapshot(),
            walkers_draws=self.walkers.draws(),
            guests=self.guests.snapshot(),
            guests_draws=self.guests.draws(),
            companions=[each.snapshot() for each in self.companions],
            furniture=self._furniture.rows(),
            furniture_moves_s=self._furniture_moves_s,
            carries_s=self._carrying.due_s,
            draws=written_draws(self._rng),
        )
        return kept.model_dump(mode="json")

    def restore(self, snapshot: dict[str, Any]) -> None:
        """Raises `ValueError` for one that does not fit."""
        kept = WorldSnapshot.model_validate_json(json.dumps(snapshot))
        if len(kept.robots) != len(self.robots):
            raise ValueError(f"expected {len(self.robots)} robots, got {len(kept.robots)}")
        if kept.doors.keys() != self.doors.keys():
            raise ValueError("the snapshot has other doors than the building")
        self._barriers.restore(kept.barred)
        self.elevators.restore(kept.cabins)
        self.goods.restore(kept.items, kept.wishes)
        if kept.baskets:
            for basket, was in zip(self.baskets, kept.baskets, strict=True):
                basket.restore(was)
        if kept.batteries:
            for battery, held in zip(self.batteries, kept.batteries, strict=True):
                battery.restore(held)
        if kept.walkers_draws is not None:
            self.walkers.restore(kept.walkers, kept.walkers_draws)
        if kept.guests_draws is not None:
            self.guests.restore(kept.guests, kept.guests_draws)
            for companion, draws in zip(self.companions, kept.companions, strict=True):
                companion.restore(draws)
        self._furniture.restore(kept.furniture)
        self._furniture_moves_s = kept.furniture_moves_s
        self._carrying.due_s = kept.carries_s
        read_draws(self._rng, kept.draws)
        self._cycles.set_s(kept.time_s)
        self._stillness.disturb()
        self._lasers.forget()
        known = zip(kept.robots, kept.odometers, kept.beliefs, strict=True)
        for robot, (at, odometer, belief) in zip(self.robots, known, strict=True):
            robot.stand(FloorPose(*at))
            robot.odometer.restore(odometer)
            if robot.belief is not None and belief is not None:
                robot.belief.restore(belief)
        for name, (is_shut, shuts_s) in kept.doors.items():
            self.doors[name].is_shut, self.doors[name].shuts_s = is_shut, shuts_s
        self._crowd.bystanders = [Bystander(FloorPose(*each)) for each in kept.bystanders]

    def close(self) -> None:
        """Nothing is open."""


def _robot(
    frame: Frame,
    at: FloorPose,
    senses: Senses,
    rng: np.random.Generator,
    maps: Mapping[str, FloorMap] | None,
) -> BuildingRobot:
    odometer = Odometer(rng)
    belief = None if maps is None else Belief(maps, at, odometer)
    return BuildingRobot(frame, at, senses, odometer, belief)
