"""Robots that share a run: who can do what, and who may be where.

A robot asks for all the space that a leaf needs at once, while its arm rests, and has it until its
arm rests again. So nobody has space and waits for more, and there is no deadlock. Where an arm
rests is its own all the time, and where one has stopped that is given up. A robot that does not say
what room it takes, or of which the scene does not say where it stands, may be anywhere while its
arm does not rest, so that nobody else works then; at rest it is trusted to be out of the others'
way.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from math import dist, hypot
from typing import TYPE_CHECKING, Protocol

from shapely import MultiPoint, Point, box
from shapely.geometry.base import BaseGeometry

from mend.tasks.scene import Scene

if TYPE_CHECKING:
    from mend.server.runtime.robot_side import RobotSide
    from mend.tasks.definition import BehaviorNode

Flat = tuple[float, float]
"""A point of the scene's plane."""


EVERYWHERE = box(-1e6, -1e6, 1e6, 1e6)
"""The space of an arm of which nobody knows where it is: all that a robot can name."""


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

    def join(self, sides: Mapping[str, "RobotSide"], executing: Collection[str] = ()) -> None:
        """These are all the robots of the run.

        Of those `executing` something nobody knows where they are.
        """
        self._sides = tuple(sides.values())
        for side in self._sides:
            side.team = self
            side.stands_somewhere = bool(self._scene.robots)
            side.area = EVERYWHERE if side.robot in executing else None

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
        return not any(_not_known_yet(each) or _meets(wanted, each) for each in self._others(side))

    def take(self, side: "RobotSide", leaf: "BehaviorNode", *, handed_over: bool = False) -> None:
        """Have the space for a leaf, until `RobotSide` gives it back."""
        if self.shares:
            area = self._area(side, leaf, handed_over)
            side.area = area if side.area is None else area.union(side.area)

    def take_up_again(self, side: "RobotSide", leaf: "BehaviorNode") -> None:
        """A robot that may have been anywhere is still at a leaf."""
        if side.area is EVERYWHERE:
            side.area = None
            self.take(side, leaf, handed_over=True)

    def given_up_in_the_way(self, leaf: "BehaviorNode") -> list[str]:
        """The robots that were given up and whose arms may be where a leaf needs space."""
        stopped = [each for each in self._sides if each.gone_for_good and each.area is not None]
        areas = [self._area(each, leaf) for each in self._sides if not each.gone_for_good]
        return [
            each.robot for each in stopped if areas and all(_meets(area, each) for area in areas)
        ]

    def _partners(self, side: "RobotSide") -> list["RobotSide"]:
        return [each for each in self._sides if each is not side]

    def _others(self, side: "RobotSide") -> list["RobotSide"]:
        """Whoever may be in its way, of this run or not."""
        near = (each for of in self._neighbours() for each in of.sides.values())
        # Who has not come yet and was about nothing is at rest in a world that is being started.
        there = (each for each in near if each.hello is not None or each.area is not None)
        return [*self._partners(side), *there]

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
            _meets(wanted, each)
            if each.gone_for_good
            else wanted is not EVERYWHERE and wanted.intersects(_home(each))
            for each in self._others(side)
        )

    def _area(
        self, side: "RobotSide", leaf: "BehaviorNode", handed_over: bool = False
    ) -> BaseGeometry:
        if side.room is None:
            return EVERYWHERE
        part = self._scene.objects.get(leaf.object or "")
        around_m = side.room.around_m
        around_m += 0.0 if part is None else hypot(*part.size[:2]) / 2
        corners = [*_home_points(side), *self._ends(leaf)]
        if handed_over:
            corners.append(side.frame.to_scene(*side.room.hand_over))
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


def _not_known_yet(side: "RobotSide") -> bool:
    """Whether a robot still has to come and say where its arm is."""
    return side.hello is None and not side.gone_for_good


def _meets(wanted: BaseGeometry, other: "RobotSide") -> bool:
    """Whether another robot has some of the space that one wants."""
    if wanted is EVERYWHERE:
        # Where others rest it is not, though nobody can say where it is.
        return other.area is not None
    return wanted.intersects(held_by(other))


def _could(side: "RobotSide", behavior: str) -> bool:
    return side.suitability(behavior) > 0.0


def held_by(side: "RobotSide") -> BaseGeometry:
    """The space that a robot has now."""
    return _home(side) if side.area is None else side.area


def _home_points(side: "RobotSide") -> list[Flat]:
    assert side.room is not None
    return [side.frame.to_scene(*each) for each in side.room.resting]


def _home(side: "RobotSide") -> BaseGeometry:
    """Where an arm is that rests."""
    if side.room is None:
        return Point()
    return MultiPoint(_home_points(side)).convex_hull.buffer(side.room.around_m)
