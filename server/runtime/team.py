"""Robots that share a run: who can do what, and who may be where.

A robot asks for all the space that a leaf needs at once, while its arm rests, and has it until its
arm rests again. So nobody has space and waits for more, and there is no deadlock. Where an arm
rests is its own all the time, and where one has stopped that is given up. A robot that does not say
what room it takes is trusted to keep out of the others' way itself.
"""

from collections.abc import Callable, Mapping, Sequence
from math import dist, hypot
from typing import TYPE_CHECKING, Protocol

from shapely import MultiPoint, Point
from shapely.geometry.base import BaseGeometry

from mend.tasks.scene import Scene

if TYPE_CHECKING:
    from mend.server.runtime.robot_side import RobotSide
    from mend.tasks.definition import BehaviorNode

Flat = tuple[float, float]
"""A point of the scene's plane."""


class Neighbour(Protocol):
    """Who else has robots where a run's robots work: another run, or the site itself."""

    @property
    def sides(self) -> Mapping[str, "RobotSide"]: ...

    def handled(self) -> set[str]:
        """The parts and places that its robots are about."""
        ...


class Team:
    """The robots of one run, the scene that they work in, and who else works there."""

    def __init__(self, scene: Scene, neighbours: Callable[[], Sequence[Neighbour]]) -> None:
        self._scene = scene
        self._neighbours = neighbours
        self._sides: Sequence[RobotSide] = ()

    def join(self, sides: Mapping[str, "RobotSide"]) -> None:
        """These are all the robots of the run."""
        self._sides = tuple(sides.values())
        for side in self._sides:
            side.team = self

    @property
    def shares(self) -> bool:
        """Whether there are several robots, of whomever."""
        return len(self._sides) > 1 or any(each.sides for each in self._neighbours())

    def handled_by_neighbours(self) -> set[str]:
        """The parts and places that others than this run are about."""
        return {name for each in self._neighbours() for name in each.handled()}

    def leaves_to_others(self, side: "RobotSide", leaf: "BehaviorNode") -> bool:
        """Whether a leaf is not for this robot, as it is out of its reach or in another's home.

        What is out of everybody's reach is left to nobody: the robot that tries it asks people.
        """
        if not self.shares:
            return False
        if self._meets_a_home(side, leaf):
            return True
        others = (each for each in self._partners(side) if _could(each, leaf.behavior))
        return not self._reaches(side, leaf) and any(
            self._reaches(each, leaf) and not self._meets_a_home(each, leaf) for each in others
        )

    def may_begin(
        self, side: "RobotSide", leaf: "BehaviorNode", *, handed_over: bool = False
    ) -> bool:
        """Whether nobody else has the space that a leaf needs.

        `handed_over`: also that in which people hold its object out.
        """
        if not self.shares:
            return True
        wanted = self._area(side, leaf, handed_over)
        return not any(wanted.intersects(held_by(each)) for each in self._others(side))

    def take(self, side: "RobotSide", leaf: "BehaviorNode", *, handed_over: bool = False) -> None:
        """Have the space for a leaf, until `RobotSide` gives it back."""
        if self.shares and side.hello is not None and side.hello.room is not None:
            area = self._area(side, leaf, handed_over)
            side.area = area if side.area is None else area.union(side.area)

    def _partners(self, side: "RobotSide") -> list["RobotSide"]:
        return [each for each in self._sides if each is not side and each.hello is not None]

    def _others(self, side: "RobotSide") -> list["RobotSide"]:
        """Whoever may be in its way, of this run or not."""
        near = (each for of in self._neighbours() for each in of.sides.values())
        return [*self._partners(side), *(each for each in near if each.hello is not None)]

    def _reaches(self, side: "RobotSide", leaf: "BehaviorNode") -> bool:
        """Whether a leaf's object, where it was seen, and its place are in a robot's ring."""
        assert side.hello is not None
        reach = side.hello.reach
        middle = side.frame.to_scene(reach.x, reach.y)
        ends = self._ends(leaf)
        return all(reach.min_m <= dist(middle, each) <= reach.max_m for each in ends)

    def _meets_a_home(self, side: "RobotSide", leaf: "BehaviorNode") -> bool:
        wanted = self._area(side, leaf)
        return any(
            wanted.intersects(held_by(each) if each.gone_for_good else _home(each))
            for each in self._others(side)
        )

    def _area(
        self, side: "RobotSide", leaf: "BehaviorNode", handed_over: bool = False
    ) -> BaseGeometry:
        if side.hello is None or side.hello.room is None:
            return Point()
        part = self._scene.objects.get(leaf.object or "")
        around_m = side.hello.room.around_m
        around_m += 0.0 if part is None else hypot(*part.size[:2]) / 2
        corners = [*_home_points(side), *self._ends(leaf)]
        if handed_over:
            corners.append(side.frame.to_scene(*side.hello.room.hand_over))
        hull = MultiPoint(corners).convex_hull
        return hull.buffer(around_m)

    def _ends(self, leaf: "BehaviorNode") -> list[Flat]:
        """Where a leaf's object was seen, by whom it was seen last, and where it is to be."""
        ends: list[Flat] = []
        seen = [
            (each.seen_at, sighting)
            for each in self._sides
            if (sighting := each.seen.get(leaf.object or "")) is not None
        ]
        if seen:
            _, sighting = max(seen, key=lambda each: each[0])
            ends.append((sighting.x, sighting.y))
        elif (part := self._scene.objects.get(leaf.object or "")) is not None:
            ends.append((part.pose.x, part.pose.y))
        if (place := self._scene.places.get(leaf.place or "")) is not None:
            ends.append((place.pose.x, place.pose.y))
        return ends


def _could(side: "RobotSide", behavior: str) -> bool:
    return side.suitability(behavior) > 0.0


def held_by(side: "RobotSide") -> BaseGeometry:
    """The space that a robot has now."""
    return _home(side) if side.area is None else side.area


def _home_points(side: "RobotSide") -> list[Flat]:
    assert side.hello is not None
    assert side.hello.room is not None
    return [side.frame.to_scene(*each) for each in side.hello.room.resting]


def _home(side: "RobotSide") -> BaseGeometry:
    """Where an arm is that rests."""
    if side.hello is None or side.hello.room is None:
        return Point()
    return MultiPoint(_home_points(side)).convex_hull.buffer(side.hello.room.around_m)
