"""A building as it really is: its doors, the people in it, and robots that drive."""

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mend.documents.strict_model import StrictModel
from mend.maps.building.building import Building, DoorOpening
from mend.maps.building.clearance import clearance_m, distances_m
from mend.maps.building.crossing import crossed_by
from mend.robots.base.battery import LOW
from mend.robots.base.body import RangeScan
from mend.sim.building import laser
from mend.sim.building.barriers import Barriers
from mend.sim.building.belief import Belief, BeliefSnapshot, FloorMap
from mend.sim.building.building_robot import PERIOD_S, RADIUS_M, BuildingRobot, Senses
from mend.sim.building.bystander import RADIUS_M as PERSON_RADIUS_M
from mend.sim.building.bystander import Bystander
from mend.sim.building.cabin import Cabin, Call
from mend.sim.building.carrying import Carrying
from mend.sim.building.chargers import is_at_charger
from mend.sim.building.doors import WorldDoors
from mend.sim.building.draws import read_draws, written_draws
from mend.sim.building.elevator_bank import CabinSnapshot, ElevatorBank
from mend.sim.building.floor_pose import FloorPose
from mend.sim.building.furniture import Furniture, Row
from mend.sim.building.gatherings import gatherings
from mend.sim.building.goods import Goods, ItemSnapshot, WishSnapshot
from mend.sim.building.guests import Guest, Guests, GuestSnapshot, Surroundings
from mend.sim.building.laser_noise import measured_m
from mend.sim.building.odometry import Odometer, OdometerSnapshot
from mend.sim.building.options import BuildingOptions
from mend.sim.building.robot_basket import BasketSnapshot, RobotBasket
from mend.sim.building.robot_battery import BatterySnapshot, RobotBattery
from mend.sim.building.robot_companion import RobotCompanion
from mend.sim.building.social_force import KEEP_M
from mend.sim.building.walkers import Walker, Walkers, WalkerSnapshot
from mend.tasks.frames import Frame
from mend.tasks.intervention import Act, Intervention

Circle = tuple[float, float, float]

_IN_FRONT_M = 0.6
"""So far from a robot's rim somebody stands who steps in its way."""
_AT_DOOR_M = 1.0
"""Who is asked to open a door opens one that a robot stands so near to."""
_FURNITURE_MOVES_EVERY_S = 60.0
"""So often somebody puts a piece of furniture elsewhere, on each floor."""
_FURNITURE_FROM_ROBOTS_M = 1.0
_TRIES_TO_PUT_DOWN = 20
_BEFORE_PERSON_M = 1.5
"""Who is at a place reaches the basket of a robot that stands so near to it."""
_AT_HAND_M = 10.0
"""People go so far for what is in the basket of a robot that does not get on."""
_ASKED_M = 2.5
"""Who stands so near to a robot that stands is meant by what it asks."""
_BESIDE_M, _DIRECTIONS = (1.0, 1.3, 1.6), 16
_OFF_LANES_M = 0.8
"""So far from a place, and from lanes where there is room, stands who waits for a robot."""
_HELD_OPEN_S = 30.0
"""What people opened for a robot falls shut after so long, once nobody is there."""


class WorldSnapshot(StrictModel):
    """What a building is rebuilt from. Poses are floor, x, y, and of robots yaw."""

    time_s: float
    robots: list[tuple[str, float, float, float]]
    doors: dict[str, tuple[bool, float | None]]
    bystanders: list[tuple[str, float, float]]
    cabins: dict[str, CabinSnapshot]
    odometers: list[OdometerSnapshot]
    beliefs: list[BeliefSnapshot | None]
    # Older ones have none of these.
    barred: list[tuple[str, str]] = []
    items: dict[str, ItemSnapshot] = {}
    wishes: dict[int, WishSnapshot] = {}
    baskets: list[BasketSnapshot] = []
    batteries: list[BatterySnapshot] = []
    walkers: list[WalkerSnapshot] = []
    walkers_draws: str | None = None
    guests: dict[int, GuestSnapshot] = {}
    guests_draws: str | None = None
    companions: list[str] = []
    furniture: dict[str, list[Row]]
    furniture_moves_s: float
    carries_s: float | None
    draws: str


class BuildingWorld:
    """Implements `mend.sim.world.World`.

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
        self._names = names
        self.elevators = ElevatorBank(building)
        self.wrong_floors = options.wrong_floors
        self.touches = self.carried = 0
        self._time_s = 0.0
        self.bystanders: list[Bystander] = []
        starts = list(starts)
        stand = [at for _, at in starts]
        if options.blocked_hallways:
            self.bystanders = gatherings(building, options.blocked_hallways, goods.seed, stand)
        self.doors = WorldDoors(
            building,
            lambda door: (
                door.opens is DoorOpening.ITSELF or bool(rng.random() < options.shut_doors)
            ),
        )
        self._barriers = Barriers(building, self.doors)
        self._rng = rng
        self._furniture = furniture
        self._furniture_moves_s = _FURNITURE_MOVES_EVERY_S
        self._carrying = carrying
        self.goods = goods
        self._places = places
        self._scans: dict[BuildingRobot, RangeScan] = {}
        senses = Senses(self.time_s, self._height_m, self._scan, self.advance_cycle)
        self.robots = [self._robot(*start, senses, maps) for start in starts]
        self.batteries = [RobotBattery(options.battery_wh) for _ in self.robots]
        self.walkers = Walkers(building, options.people, self.doors.values(), goods.seed)
        self.walkers.leave_room_for((each.at for each in self.robots), RADIUS_M)
        self.baskets = [RobotBasket(goods, each, goods.seed) for each in range(len(self.robots))]
        goods.passed_on = lambda robot, item: self.baskets[robot].memory.note_passed_on(item)
        self.guests = Guests(options.no_shows, options.dawdling, places, goods.seed)
        self._around = Surroundings(
            segments=self._segments,
            people=self._people,
            robots=self.robots,
            room_beside=self._room_beside,
            stop_around=self.elevators.stop_around,
            doors=[e for e in self.doors.values() if e.plan.opens is DoorOpening.PEOPLE],
        )
        self.companions = [
            RobotCompanion(self.guests, each, number, goods.seed, self._sees)
            for number, each in enumerate(self.robots)
        ]

    def _robot(
        self,
        frame: Frame,
        at: FloorPose,
        senses: Senses,
        maps: Mapping[str, FloorMap] | None,
    ) -> BuildingRobot:
        odometer = Odometer(self._rng)
        belief = None if maps is None else Belief(maps, at, odometer)
        return BuildingRobot(frame, at, senses, odometer, belief)

    # --- Time ---

    def time_s(self) -> float:
        return self._time_s

    def advance_cycle(self) -> None:
        self._time_s += PERIOD_S
        self.doors.let_pass(self._time_s, self._circles)
        standing = [each.at for each in self.bystanders]
        standing += [each.at for each in self.guests.there.values()]
        self.walkers.walk(self._time_s, self.robots, standing, self._segments)
        self.guests.walk(self._time_s, self.robots, self._around)
        self._move_furniture()
        if self._carrying.is_due(self._time_s):
            self._carry_one()
        for robot, battery in zip(self.robots, self.batteries, strict=True):
            self._use_battery(robot, battery)
        self.elevators.pass_time(self._time_s, self.robots, self.guests.there, self._circles)
        for robot in self.robots:
            self._scan(robot)

    def _move_furniture(self) -> None:
        if self._time_s < self._furniture_moves_s:
            return
        self._furniture_moves_s += _FURNITURE_MOVES_EVERY_S
        for floor in self.building.floors:
            stand = [(x, y) for x, y, _ in self._circles(floor)]
            self._furniture.move_one(floor, stand, _FURNITURE_FROM_ROBOTS_M)

    def _use_battery(self, robot: BuildingRobot, battery: RobotBattery) -> None:
        """Drive as far as the battery allows it."""
        before = robot.at
        if battery.empty:
            robot.bump()
        else:
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
        if self._touches(wanted, robot.radius_m, robot):
            self.touches += 1
            robot.bump()
        else:
            robot.drive_to(wanted)

    def _touches(self, at: FloorPose, radius_m: float, but: BuildingRobot | None = None) -> bool:
        """Whether something round would touch anything there."""
        around = self._circles(at.floor, but)
        if any(math.hypot(x - at.x, y - at.y) < radius + radius_m for x, y, radius in around):
            return True
        away_m = distances_m(np.array([[at.x, at.y]]), self._segments(at.floor))
        return bool(away_m[0] < radius_m)

    # --- What there is ---

    def _height_m(self, floor: str) -> float:
        return self.elevators.height_m(floor, self._time_s)

    def _circles(self, floor: str, but: BuildingRobot | None = None) -> list[Circle]:
        """Robots and people on a floor."""
        there: list[tuple[object, FloorPose, float]] = [
            *((each, each.at, each.radius_m) for each in self.robots),
            *((each, each.at, PERSON_RADIUS_M) for each in self.bystanders),
            *((each, each.at, PERSON_RADIUS_M) for each in self.walkers.people),
            *((each, each.at, PERSON_RADIUS_M) for each in self.guests.there.values()),
        ]
        return [
            (at.x, at.y, radius)
            for each, at, radius in there
            if each is not but and at.floor == floor
        ]

    def _people(self, floor: str, but: Guest) -> list[FloorPose]:
        """Where people are on a floor."""
        people: list[Bystander | Walker | Guest] = [*self.bystanders, *self.walkers.people]
        people += self.guests.there.values()
        return [each.at for each in people if each is not but and each.at.floor == floor]

    def _room_beside(
        self,
        place: FloorPose,
        radius_m: float = PERSON_RADIUS_M,
        who: BuildingRobot | None = None,
    ) -> FloorPose | None:
        """Where somebody may stand who is at a place, off the lanes if there is room."""
        walls, lanes = self._segments(place.floor), self._lanes(place.floor)
        free = []
        for away_m in _BESIDE_M:
            for turn in np.arange(_DIRECTIONS) * math.tau / _DIRECTIONS:
                x, y = place.x + away_m * math.cos(turn), place.y + away_m * math.sin(turn)
                at = FloorPose(place.floor, x, y)
                seen = clearance_m((place.x, place.y), (x, y), walls) > 2.0 * KEEP_M
                in_cabin = self.elevators.is_in_a_cabin(place.floor, x, y, radius_m)
                if seen and not in_cabin and not self._touches(at, radius_m + KEEP_M, who):
                    free.append(at)
        points = np.array([(at.x, at.y) for at in free]).reshape(-1, 2)
        off_m = np.minimum(distances_m(points, lanes), _OFF_LANES_M)
        return free[int(np.argmax(off_m))] if free else None

    def _lanes(self, floor: str) -> NDArray[np.float64]:
        places, lanes = self.building.floors[floor].places, self.building.floors[floor].lanes
        ends = [(places[a], places[b]) for a, b in (each.between for each in lanes)]
        return np.array([(a.x, a.y, b.x, b.y) for a, b in ends], np.float64).reshape(-1, 4)

    def _sees(self, a: FloorPose, b: FloorPose) -> bool:
        return not len(crossed_by(np.array([a.x, a.y, b.x, b.y]), self._segments(a.floor)))

    def _segments(self, floor: str) -> NDArray[np.float64]:
        """Walls, shut doors, cabins and furniture."""
        cabins = self.elevators.walls(floor)
        if floor not in self.building.floors:
            return cabins
        return np.vstack(
            [
                self.building.floors[floor].wall_segments,
                self.doors.shut(floor),
                cabins,
                self._furniture.segments(floor),
                self._barriers.segments(floor),
            ]
        )

    def _scan(self, robot: BuildingRobot) -> RangeScan:
        """The newest, at the laser's period."""
        kept = self._scans.get(robot)
        if kept is not None and self._time_s - kept.time < laser.PERIOD_S - 1e-9:
            return kept
        at = robot.at
        ranges = laser.ranges_m(
            self._segments(at.floor), self._circles(at.floor, robot), at.x, at.y, at.yaw
        )
        scan = RangeScan(measured_m(ranges, self._rng), laser.ANGLES_RAD, self._time_s)
        self._scans[robot] = scan
        if robot.belief is not None and at.floor in self.building.floors:
            robot.belief.see(scan)
        return scan

    # --- People who act ---

    def _carry_one(self) -> None:
        """Somebody lifts a robot that drives, and puts it down elsewhere, where there is room."""
        driving = [e for e in self.robots if e.moving and e.at.floor in self.building.floors]
        if not driving:
            return
        robot = driving[self._carrying.choose(len(driving))]
        for _ in range(_TRIES_TO_PUT_DOWN):
            to = self._carrying.draw(robot.at.floor, self.building.floors[robot.at.floor])
            if not self._touches(to, robot.radius_m + _IN_FRONT_M / 2.0, robot):
                robot.stand(to)
                self.carried += 1
                return

    def intervene(self, intervention: Intervention) -> str:
        """Somebody blocks the first robot that drives, makes way, or handles what robots carry."""
        match intervention.act:
            case Act.BLOCK:
                return self._step_in_the_way()
            case Act.RELEASE if intervention.object in self._names:
                return self._push_aside(self.robots[self._names.index(intervention.object)])
            case Act.RELEASE:
                return self._make_way()
            case Act.PUT_IN:
                at_hand = self._stands_at_hand
                return self.goods.put_in(intervention.object, self._stands_at, at_hand)
            case Act.TAKE_OUT:
                return self.goods.take_out(intervention.object, self._stands_at)
            case Act.CHARGE:
                return self._plug_in()
            case Act.BAR | Act.CLEAR as act:
                assert intervention.between is not None, "checked before"
                return self._bar_or_clear(act, intervention.between)
            case Act.MISDIRECT:
                return self._misdirect(intervention.elevator)
            case Act.SEND_PERSON:
                return self._send_people()
            case Act.STEAL:
                return self.goods.steal(intervention.object)
            case act:
                return f"there is nothing in a building for which anybody could do '{act}'"

    def _bar_or_clear(self, act: Act, lane: tuple[str, str]) -> str:
        try:
            if act is Act.CLEAR:
                self._barriers.clear(lane)
            elif (put := self._barriers.bar(lane)) is not None and self._stands_in(*put):
                self._barriers.clear(lane)
                return f"somebody is in the way between {lane[0]} and {lane[1]}"
        except ValueError as error:
            return str(error)
        return ""

    def _misdirect(self, elevator: str | None) -> str:
        cabin = self.elevators.cabins.get(elevator or "")
        if cabin is None:
            return f"there is no elevator '{elevator}'"
        cabin.misdirected = True
        return ""

    def _stands_in(self, floor: str, segments: NDArray[np.float64]) -> bool:
        """Whether a robot or a person is where something is to be put."""
        return any(
            distances_m(np.array([[x, y]]), segments)[0] < radius_m
            for x, y, radius_m in self._circles(floor)
        )

    def _send_people(self) -> str:
        """Somebody tells those to come for whom robots stand and wait."""
        waiting = [
            number
            for number in self.guests.of_robots
            if not self.robots[number].moving
            and self.robots[number].at.floor in self.building.floors
        ]
        told = [
            self.guests.send(each, self._time_s, self.robots[each].at, self._around)
            for each in waiting
        ]
        if not told:
            return "no robot that stands waits for anybody"
        return next((each for each in told if each), "")

    def _stands_at(self, number: int, place: str | None) -> bool:
        """Whether a robot really stands, and before who is at a place, where one is named."""
        robot = self.robots[number]
        if robot.moving or place is None:
            return not robot.moving
        at = self._places.get(place)
        if at is None or robot.at.floor != at.floor:
            return False
        return math.hypot(robot.at.x - at.x, robot.at.y - at.y) <= _BEFORE_PERSON_M

    def _stands_at_hand(self, number: int, other: int) -> bool:
        """Whether another robot stands so near that people bring a robot what that one has."""
        here, there = self.robots[number].at, self.robots[other]
        near = math.hypot(here.x - there.at.x, here.y - there.at.y) <= _AT_HAND_M
        return near and here.floor == there.at.floor and not there.moving

    def _plug_in(self) -> str:
        """Somebody plugs in all robots that stand with little left."""
        low = [
            battery
            for robot, battery in zip(self.robots, self.batteries, strict=True)
            if battery.share < LOW and not robot.moving and robot.at.floor in self.building.floors
        ]
        for each in low:
            each.plugged = True
        return "" if low else "no robot that stands has little left in its battery"

    def _step_in_the_way(self) -> str:
        driving = next((each for each in self.robots if each.moving), None)
        if driving is None:
            return "nobody stands in the way of robots that stand"
        at, ahead_m = driving.at, driving.radius_m + PERSON_RADIUS_M + _IN_FRONT_M
        now = driving.velocity()
        heading = at.yaw + math.atan2(now.left_m_s, now.forward_m_s)
        x, y = at.x + ahead_m * math.cos(heading), at.y + ahead_m * math.sin(heading)
        there = FloorPose(at.floor, x, y)
        in_cabin = self.elevators.is_in_a_cabin(at.floor, x, y, PERSON_RADIUS_M)
        if in_cabin or self._touches(there, PERSON_RADIUS_M):
            return "there is no room to stand in the robot's way"
        self.bystanders.append(Bystander(there))
        return ""

    def _make_way(self) -> str:
        asked = [each for each in self.bystanders if self._is_asked(each)]
        stepped_aside = asked or self.bystanders
        self.bystanders = [each for each in self.bystanders if each not in stepped_aside]
        opened = self._open_for_who_waits()
        pressed = self._press_for_who_waits()
        done = bool(stepped_aside) or opened or pressed
        return "" if done else "nothing is in the way of any robot"

    def _push_aside(self, robot: BuildingRobot) -> str:
        """Somebody pushes a robot that stands off the lane, where there is room."""
        on_floor = robot.at.floor in self.building.floors
        if robot.moving or not on_floor:
            return "the robot does not stand where anybody could push it aside"
        to = self._room_beside(robot.at, robot.radius_m, robot)
        if to is None:
            return "there is no room to push the robot aside"
        robot.stand(replace(to, yaw=robot.at.yaw))
        return ""

    def _is_asked(self, bystander: Bystander) -> bool:
        """Whether a robot stands before them; where none does, everybody is meant."""
        at = bystander.at
        return any(
            robot.at.floor == at.floor
            and not robot.moving
            and math.hypot(robot.at.x - at.x, robot.at.y - at.y) < _ASKED_M
            for robot in self.robots
        )

    def _press_for_who_waits(self) -> bool:
        """Somebody calls the elevator that a robot needs, and presses a button in it."""
        pressed = False
        for number, robot in enumerate(self.robots):
            for cabin in self.elevators.waits(number, robot):
                call = cabin.call_of(number)
                assert call is not None, "it waits"
                call.to = self._pressed(call, cabin)
                pressed = True
        return pressed

    def _pressed(self, call: Call, cabin: Cabin) -> str:
        """The button for where it wants to go, or now and then another one."""
        others = [each for each in cabin.plan.stops if each not in (call.wants, cabin.floor)]
        if others and self._rng.random() < self.wrong_floors:
            return others[int(self._rng.integers(len(others)))]
        return call.wants

    def _open_for_who_waits(self) -> bool:
        opened = False
        for robot in self.robots:
            at = robot.at
            nearest = self.doors.nearest_shut(at.floor, at.x, at.y, self._time_s)
            if nearest is not None and nearest[0] < _AT_DOOR_M and not robot.moving:
                nearest[1].hold_open(self._time_s + _HELD_OPEN_S)
                opened = True
        return opened

    # --- What it is rebuilt from ---

    def snapshot(self) -> dict[str, Any]:
        items, wishes = self.goods.snapshot()
        kept = WorldSnapshot(
            time_s=self._time_s,
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
        self._time_s = kept.time_s
        self._scans.clear()
        known = zip(kept.robots, kept.odometers, kept.beliefs, strict=True)
        for robot, (at, odometer, belief) in zip(self.robots, known, strict=True):
            robot.stand(FloorPose(*at))
            robot.odometer.restore(odometer)
            if robot.belief is not None and belief is not None:
                robot.belief.restore(belief)
        for name, (is_shut, shuts_s) in kept.doors.items():
            self.doors[name].is_shut, self.doors[name].shuts_s = is_shut, shuts_s
        self.bystanders = [Bystander(FloorPose(*each)) for each in kept.bystanders]

    def close(self) -> None:
        """Nothing is open."""
