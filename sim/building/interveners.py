"""People who do something: they step in the way, make way, and handle what robots carry."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from mend.maps.building.building import Building
from mend.robots.base.battery import LOW
from mend.sim.building.barriers import Barriers
from mend.sim.building.building_robot import BuildingRobot
from mend.sim.building.bystander import RADIUS_M, Bystander
from mend.sim.building.cabin import Cabin, Call
from mend.sim.building.crowd import Crowd
from mend.sim.building.doors import WorldDoors
from mend.sim.building.elevator_bank import ElevatorBank
from mend.sim.building.floor_pose import FloorPose
from mend.sim.building.goods import Goods
from mend.sim.building.guests import Surroundings
from mend.sim.building.robot_battery import RobotBattery
from mend.sim.building.space import Space
from mend.tasks.intervention import Act, Intervention

IN_FRONT_M = 0.6
"""So far from a robot's rim somebody stands who steps in its way."""
_AT_DOOR_M = 1.0
"""Who is asked to open a door opens one that a robot stands so near to."""
_BEFORE_PERSON_M = 1.5
"""Who is at a place reaches the basket of a robot that stands so near to it."""
_ASKED_M = 2.5
"""Who stands so near to a robot that stands is meant by what it asks."""
_HELD_OPEN_S = 30.0
"""What people opened for a robot falls shut after so long, once nobody is there."""


@dataclass(slots=True)
class Interveners:
    """What they act on; `places`: where people are, by the names that robots know.

    `names`: those of the robots, by which people tell them apart.
    """

    building: Building
    space: Space
    crowd: Crowd
    doors: WorldDoors
    barriers: Barriers
    elevators: ElevatorBank
    goods: Goods
    batteries: list[RobotBattery]
    around: Surroundings
    places: Mapping[str, FloorPose]
    names: Sequence[str]
    wrong_floors: float
    rng: np.random.Generator
    time_s: Callable[[], float]

    def intervene(self, intervention: Intervention) -> str:
        """Somebody blocks the first robot that drives, makes way, or handles what robots carry."""
        match intervention.act:
            case Act.BLOCK:
                return self._step_in_the_way()
            case Act.RELEASE if intervention.object in self.names:
                return self._release(self.crowd.robots[self.names.index(intervention.object)])
            case Act.RELEASE:
                return self._make_way()
            case Act.PUT_IN:
                at_hand = self._stands_at_hand
                return self.goods.put_in(intervention.object, self._stands_at, at_hand)
            case Act.TAKE_OUT:
                return self.goods.take_out(intervention.object, self._stands_at)
            case Act.CHARGE:
                return self._plug_in(intervention.object)
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

    # --- Ways ---------------------------------------------------------------------------------

    def _bar_or_clear(self, act: Act, lane: tuple[str, str]) -> str:
        try:
            if act is Act.CLEAR:
                self.barriers.clear(lane)
            elif (put := self.barriers.bar(lane)) is not None and self.space.stands_in(*put):
                self.barriers.clear(lane)
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

    def _step_in_the_way(self) -> str:
        driving = next((each for each in self.crowd.robots if each.moving), None)
        if driving is None:
            return "nobody stands in the way of robots that stand"
        at, ahead_m = driving.at, driving.radius_m + RADIUS_M + IN_FRONT_M
        now = driving.velocity()
        heading = at.yaw + math.atan2(now.left_m_s, now.forward_m_s)
        x, y = at.x + ahead_m * math.cos(heading), at.y + ahead_m * math.sin(heading)
        there = FloorPose(at.floor, x, y)
        in_cabin = self.elevators.is_in_a_cabin(at.floor, x, y, RADIUS_M)
        if in_cabin or self.space.touches(there, RADIUS_M):
            return "there is no room to stand in the robot's way"
        self.crowd.bystanders.append(Bystander(there))
        return ""

    def _make_way(self) -> str:
        standing = self.crowd.bystanders
        asked = [each for each in standing if self._is_asked(each)]
        stepped_aside = asked or standing
        self.crowd.bystanders = [each for each in standing if each not in stepped_aside]
        opened = self._open_for_who_waits()
        pressed = self._press_for_who_waits()
        done = bool(stepped_aside) or opened or pressed or self._push_apart()
        return "" if done or self._push_out() else self._why_in_vain()

    def _why_in_vain(self) -> str:
        """Why whoever wants to help a robot on has done nothing."""
        standing = [(e.at.floor, e.at.x, e.at.y) for e in self.crowd.robots if self._stands(e)]
        if any(self.doors.is_kept_shut(*at, _AT_DOOR_M, self.time_s()) for at in standing):
            return "the door that a robot stands before is locked, or not to be opened by now"
        if any(self.barriers.is_near(*at, _ASKED_M) for at in standing):
            return "what is right across a robot's way is not to be taken away yet"
        return "nothing is in the way of any robot"

    def _push_out(self) -> bool:
        """Push robots out of cabins in which they stand, and want to ride nowhere."""
        return any(
            self.elevators.stop_around(robot) is not None
            and not self.elevators.wants_ride(number)
            and not self._push_aside(robot)
            for number, robot in enumerate(self.crowd.robots)
        )

    def _release(self, robot: BuildingRobot) -> str:
        """Somebody pushes a robot aside; out of a cabin, they press the buttons there as well."""
        in_cabin = self.elevators.stop_around(robot) is not None
        problem = self._push_aside(robot)
        if not problem and in_cabin:
            self._press_for_who_waits()
        return problem

    def _push_apart(self) -> bool:
        """Of two robots that stand before each other, and want nothing there, push one aside."""
        standing = [
            each
            for number, each in enumerate(self.crowd.robots)
            if self._stands(each) and number not in self.goods.wishes
        ]
        return any(
            one.at.floor == other.at.floor
            and math.hypot(one.at.x - other.at.x, one.at.y - other.at.y) < _ASKED_M
            and not (self._push_aside(other) and self._push_aside(one))
            for one, other in combinations(standing, 2)
        )

    def _push_aside(self, robot: BuildingRobot) -> str:
        """Somebody pushes a robot that stands off the lane, where there is room."""
        if not self._stands(robot):
            return "the robot does not stand where anybody could push it aside"
        to = self.space.room_beside(robot.at, robot.radius_m, robot)
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
            for robot in self.crowd.robots
        )

    def _press_for_who_waits(self) -> bool:
        """Somebody calls the elevator that a robot needs, and presses a button in it."""
        pressed = False
        for number, robot in enumerate(self.crowd.robots):
            for cabin in self.elevators.waits(number, robot):
                call = cabin.call_of(number)
                assert call is not None, "it waits"
                call.to = self._pressed(call, cabin)
                pressed = True
        return pressed

    def _pressed(self, call: Call, cabin: Cabin) -> str:
        """The button for where it wants to go, or now and then another one."""
        others = [each for each in cabin.plan.stops if each not in (call.wants, cabin.floor)]
        if others and self.rng.random() < self.wrong_floors:
            return others[int(self.rng.integers(len(others)))]
        return call.wants

    def _open_for_who_waits(self) -> bool:
        opened, now_s = False, self.time_s()
        for robot in self.crowd.robots:
            at = robot.at
            nearest = self.doors.nearest_shut(at.floor, at.x, at.y, now_s)
            if nearest is not None and nearest[0] < _AT_DOOR_M and not robot.moving:
                nearest[1].hold_open(now_s + _HELD_OPEN_S)
                opened = True
        return opened

    # --- Robots that stand --------------------------------------------------------------------

    def _stands(self, robot: BuildingRobot) -> bool:
        return not robot.moving and robot.at.floor in self.building.floors

    def _stands_at(self, number: int, place: str | None) -> bool:
        """Whether a robot really stands, and before who is at a place, where one is named."""
        robot = self.crowd.robots[number]
        if robot.moving or place is None:
            return not robot.moving
        at = self.places.get(place)
        if at is None or robot.at.floor != at.floor:
            return False
        return math.hypot(robot.at.x - at.x, robot.at.y - at.y) <= _BEFORE_PERSON_M

    def _stands_at_hand(self, number: int, other: int) -> bool:
        """Whether another robot stands where people bring a robot from what that one has."""
        there = self.crowd.robots[other]
        return self.crowd.robots[number].at.floor == there.at.floor and not there.moving

    def _send_people(self) -> str:
        """Somebody tells those to come for whom robots stand and wait."""
        guests, robots = self.crowd.guests, self.crowd.robots
        waiting = [number for number in guests.of_robots if self._stands(robots[number])]
        told = [guests.send(each, self.time_s(), robots[each].at, self.around) for each in waiting]
        if not told:
            return "no robot that stands waits for anybody"
        return next((each for each in told if each), "")

    def _plug_in(self, named: str | None) -> str:
        """Somebody plugs in the robot that is named, or all, that stand with little left."""
        if named is not None and named not in self.names:
            return f"there is no robot '{named}'"
        low = [
            battery
            for name, robot, battery in zip(
                self.names, self.crowd.robots, self.batteries, strict=True
            )
            if named in (None, name) and battery.share < LOW and self._stands(robot)
        ]
        for each in low:
            each.plugged = True
        if low:
            return ""
        if named is None:
            return "no robot that stands has little left in its battery"
        return "the robot does not stand with little left in its battery"
