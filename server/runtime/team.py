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

from mend.robots.arm.shared_space import Flat, home, leaf_space
from mend.tasks.scene import Scene

if TYPE_CHECKING:
    from mend.server.runtime.robot_proxy import RobotProxy
    from mend.tasks.definition import BehaviorNode

EVERYWHERE = box(-1e6, -1e6, 1e6, 1e6)
"""The space of an arm of which nobody knows where it is: all that a robot can name."""


AROUND_PERSON_M = 0.15
"""So far around what a person handles their hands and arms may be."""


class Neighbour(Protocol):
    """Who else has robots where a run's robots work: another run, or the site itself."""

    @property
    def proxies(self) -> Mapping[str, "RobotProxy"]: ...

    def handled(self) -> set[str]:
        """The parts and places that its robots are about."""
        ...


class Team:
    """The robots of one run, the scene that they work in, and who else works there."""

    def __init__(
        self,
        scene: Scene,
        neighbours: Callable[[], Sequence[Neighbour]],
        taken: Callable[[], Collection["BehaviorNode"]] = tuple,
    ) -> None:
        """`taken`: the leaves that people do themselves now."""
        self._scene = scene
        self._taken = taken
        self._neighbours = neighbours
        self._proxies: Sequence[RobotProxy] = ()

    def join(self, proxies: Mapping[str, "RobotProxy"], executing: Collection[str] = ()) -> None:
        """These are all the robots of the run.

        Of those `executing` something nobody knows where they are.
        """
        self._proxies = tuple(proxies.values())
        for proxy in self._proxies:
            proxy.team = self
            proxy.stands_somewhere = len(self._proxies) == 1 or bool(self._scene.robots)
            proxy.area = EVERYWHERE if proxy.robot in executing else None

    @property
    def shares(self) -> bool:
        """Whether there are several robots, of whomever."""
        return len(self._proxies) > 1 or any(each.proxies for each in self._neighbours())

    @property
    def has_company(self) -> bool:
        """Whether anybody else may be at the table: another robot, or a person who took a leaf."""
        return self.shares or bool(self._taken())

    def at_work_where(self, leaf: "BehaviorNode") -> str | None:
        """A robot that has some of the space now that a person needs for a leaf; None if none."""
        wanted = self._of_person(leaf)
        near = (each for of in self._neighbours() for each in of.proxies.values())
        at_work = (each for each in (*self._proxies, *near) if each.area is not None)
        return next((each.robot for each in at_work if wanted.intersects(held_by(each))), None)

    def _of_person(self, leaf: "BehaviorNode") -> BaseGeometry:
        """Where a person is who does a leaf: at its object, at its place and between them."""
        part = self._scene.objects.get(leaf.object or "")
        around_m = AROUND_PERSON_M + (0.0 if part is None else hypot(*part.size[:2]) / 2)
        return MultiPoint(self._ends(leaf)).convex_hull.buffer(around_m)

    def handled_by_neighbours(self) -> set[str]:
        """The parts and places that others than this run are about."""
        return {name for each in self._neighbours() for name in each.handled()}

    def leaves_to_others(self, proxy: "RobotProxy", leaf: "BehaviorNode") -> bool:
        """Whether a leaf is not for this robot, as it is out of its reach or in another's home.

        What is out of everybody's reach is left to nobody: the robot that tries it asks people.
        """
        if not self.shares:
            return False
        if self._meets_a_home(proxy, leaf):
            return True
        others = (each for each in self._partners(proxy) if _could(each, leaf.behavior))
        return not self._reaches(proxy, leaf) and any(
            self._reaches(each, leaf) and not self._meets_a_home(each, leaf) for each in others
        )

    def may_begin(
        self, proxy: "RobotProxy", leaf: "BehaviorNode", *, handed_over: bool = False
    ) -> bool:
        """Whether nobody else has the space that a leaf needs.

        `handed_over`: also that in which people hold its object out.
        """
        wanted = self._area(proxy, leaf, handed_over)
        if any(wanted.intersects(self._of_person(each)) for each in self._taken()):
            return False
        return not any(_not_known_yet(each) or _meets(wanted, each) for each in self._others(proxy))

    def take(self, proxy: "RobotProxy", leaf: "BehaviorNode", *, handed_over: bool = False) -> None:
        """Have the space for a leaf, until `RobotProxy` gives it back."""
        if self.shares:
            area = self._area(proxy, leaf, handed_over)
            proxy.area = area if proxy.area is None else area.union(proxy.area)

    def expected_at(self, proxy: "RobotProxy", leaf: "BehaviorNode") -> Flat | None:
        """Where a robot is to find a leaf's object; None if it may be anywhere.

        Elsewhere the space for the leaf does not reach.
        """
        bounded = proxy.room is not None and not proxy.keeps_clear
        return self._object_at(leaf) if self.has_company and bounded else None

    def take_up_again(self, proxy: "RobotProxy", leaf: "BehaviorNode") -> None:
        """A robot that may have been anywhere is still at a leaf."""
        if proxy.area is EVERYWHERE:
            proxy.area = None
            self.take(proxy, leaf, handed_over=True)

    def given_up_in_the_way(self, leaf: "BehaviorNode") -> list[str]:
        """The robots that were given up and whose arms may be where a leaf needs space."""
        stopped = [each for each in self._proxies if each.gone_for_good and each.area is not None]
        areas = [self._area(each, leaf) for each in self._proxies if not each.gone_for_good]
        return [
            each.robot for each in stopped if areas and all(_meets(area, each) for area in areas)
        ]

    def _partners(self, proxy: "RobotProxy") -> list["RobotProxy"]:
        return [each for each in self._proxies if each is not proxy]

    def _others(self, proxy: "RobotProxy") -> list["RobotProxy"]:
        """Whoever may be in its way, of this run or not."""
        near = (each for of in self._neighbours() for each in of.proxies.values())
        # Who has not come yet and was about nothing is at rest in a world that is being started.
        there = (each for each in near if each.hello is not None or each.area is not None)
        return [*self._partners(proxy), *there]

    def _reaches(self, proxy: "RobotProxy", leaf: "BehaviorNode") -> bool:
        """Whether a leaf's object, where it was seen, and its place are in a robot's ring."""
        assert proxy.hello is not None
        reach = proxy.hello.reach
        if reach is None:
            return True
        middle = proxy.frame.to_scene(reach.x, reach.y)
        ends = self._ends(leaf)
        return all(reach.min_m <= dist(middle, each) <= reach.max_m for each in ends)

    def _meets_a_home(self, proxy: "RobotProxy", leaf: "BehaviorNode") -> bool:
        wanted = self._area(proxy, leaf)
        return any(
            _meets(wanted, each)
            if each.gone_for_good
            else wanted is not EVERYWHERE and wanted.intersects(_home(each))
            for each in self._others(proxy)
        )

    def _area(
        self, proxy: "RobotProxy", leaf: "BehaviorNode", handed_over: bool = False
    ) -> BaseGeometry:
        if proxy.keeps_clear:
            return Point()
        if proxy.room is None:
            return EVERYWHERE
        part = self._scene.objects.get(leaf.object or "")
        ends = self._ends(leaf)
        return leaf_space(proxy.frame, proxy.room, ends, part, handed_over=handed_over)

    def _ends(self, leaf: "BehaviorNode") -> list[Flat]:
        """Where a leaf's object was seen, by whom it was seen last, and where it is to be."""
        start = self._object_at(leaf)
        ends = [] if start is None else [start]
        if (place := self._scene.places.get(leaf.place or "")) is not None:
            ends.append((place.pose.x, place.pose.y))
        return ends

    def _object_at(self, leaf: "BehaviorNode") -> Flat | None:
        seen = [
            known
            for each in self._proxies
            if (known := each.last_seen.get(leaf.object or "")) is not None
        ]
        if seen:
            _, at = max(seen, key=lambda each: each[0])
            return at.x, at.y
        part = self._scene.objects.get(leaf.object or "")
        return None if part is None else (part.pose.x, part.pose.y)


def _not_known_yet(proxy: "RobotProxy") -> bool:
    """Whether a robot still has to come and say where its arm is."""
    return proxy.hello is None and not proxy.gone_for_good


def _meets(wanted: BaseGeometry, other: "RobotProxy") -> bool:
    """Whether another robot has some of the space that one wants."""
    if wanted is EVERYWHERE:
        # Where others rest it is not, though nobody can say where it is.
        return other.area is not None
    return wanted.intersects(held_by(other))


def _could(proxy: "RobotProxy", behavior: str) -> bool:
    return proxy.suitability(behavior) > 0.0


def held_by(proxy: "RobotProxy") -> BaseGeometry:
    """The space that a robot has now."""
    return _home(proxy) if proxy.area is None else proxy.area


def _home(proxy: "RobotProxy") -> BaseGeometry:
    """Where an arm is that rests."""
    return Point() if proxy.room is None else home(proxy.frame, proxy.room)
