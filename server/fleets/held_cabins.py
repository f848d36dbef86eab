"""Elevators that nobody can ride, as a robot that has nothing to do stays in the cabin."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.dispatch.leg import Finding, Found
from mend.maps.building.cabin import elevator_around
from mend.server.fleets.closed_ways import ClosedWays
from mend.tasks.potential import Point

STAYS_S = 90.0
"""Who breaks off gets out by itself within a minute where it can; who stays for longer cannot."""
AGAIN_S = 300.0
"""Who was sent out of a cabin and is still in it is sent again after so long."""


@dataclass(frozen=True, slots=True)
class HeldCabin:
    """Since `since_s` of the site's clock a robot has had nothing to do in an elevator's cabin."""

    elevator: str
    since_s: float


class HeldCabins:
    """Follows in which cabins robots of one fleet stay, so that nobody is to ride there.

    `whereabouts`: where a robot says that it is; `around`: the places to which one is sent from
    there, the nearest first; `is_idle`: whether it does nothing for anybody; `kept`: the elevators
    whose cabins were held when the service stopped, by robot.
    """

    def __init__(
        self,
        dispatcher: Dispatcher,
        closed: ClosedWays,
        whereabouts: Callable[[str], Point | None],
        around: Callable[[float, float, float], Sequence[str]],
        is_idle: Callable[[str], bool],
        kept: Mapping[str, str],
    ) -> None:
        self._dispatcher, self._closed = dispatcher, closed
        self._whereabouts, self._around, self._is_idle = whereabouts, around, is_idle
        self._in: dict[str, HeldCabin] = {}
        self._held = dict(kept)
        self._again_s: dict[str, float] = {}

    @property
    def held(self) -> Mapping[str, str]:
        """The elevators in whose cabins robots stay, by robot."""
        return self._held

    def saw(self, robot: str, here: Point, now_s: float) -> bool:
        """A robot says where it is; whether that is news, as one with nothing to do has come into a
        cabin, or out of it, or has stayed there for too long."""
        before = self._in.get(robot)
        self._look(robot, here, now_s)
        after, due = self._in.get(robot), self._due(robot, now_s)
        if due != self._held.get(robot):
            return True
        return (before is None) != (after is None) and self._stays(robot)

    def found(self, now_s: float) -> Iterator[tuple[str, Found]]:
        """What plans are to know by now of which elevators, each once.

        One that is closed counts as such until its robot is out of it, and is closed again where
        that is forgotten before.
        """
        for robot in self._dispatcher.fleet.robots:
            here, before = self._whereabouts(robot), self._held.get(robot)
            if before is not None and here is None:
                # It has not said anything yet since the service began anew.
                continue
            self._look(robot, here, now_s)
            elevator = self._due(robot, now_s)
            if before is not None and elevator != before:
                del self._held[robot]
                self._again_s.pop(robot, None)
                if self._closed_for(robot, before):
                    yield before, self._told(robot, before, Finding.OPEN)
            if elevator is not None:
                self._held[robot] = elevator
                if not self._is_closed(elevator, now_s):
                    yield elevator, self._told(robot, elevator, Finding.ELEVATOR_DEAD)

    def take(self, found: Found, now_s: float) -> None:
        """Have plans know of it. Raises as `Dispatcher.found`."""
        self._dispatcher.found(found, now_s)
        self._closed.note(found, found.by)

    def to_send_out(self, free: Sequence[str], now_s: float) -> Iterator[tuple[str, str]]:
        """Which of the robots that nobody has now are to get out of cabins, if they can, and where
        to: the nearest place at which nobody stands, or is to come to."""
        fleet, places = self._dispatcher.fleet, self._dispatcher.building.graph.places
        due = [e for e in free if e in self._held and now_s >= self._again_s.get(e, 0.0)]
        taken = {stop.place for stops in fleet.stops().values() for stop in stops} if due else set()
        for robot in due:
            others = {places[e.place].name for n, e in fleet.robots.items() if n != robot}
            here = self._whereabouts(robot)
            around = [] if here is None else self._around(*here)
            to = next((each for each in around if each not in taken | others), None)
            if to is not None:
                self._again_s[robot] = now_s + AGAIN_S
                taken.add(to)
                yield robot, to

    # --- Within -------------------------------------------------------------------------------

    def _look(self, robot: str, here: Point | None, now_s: float) -> None:
        elevator = None if here is None else elevator_around(self._dispatcher.building, *here)
        known = self._in.get(robot)
        if elevator is None:
            self._in.pop(robot, None)
        elif known is None or known.elevator != elevator or not self._stays(robot):
            self._in[robot] = HeldCabin(elevator, now_s)

    def _stays(self, robot: str) -> bool:
        """Whether it has nothing to do; who is sent out of a cabin holds it until it is out."""
        return robot in self._held or self._is_idle(robot)

    def _due(self, robot: str, now_s: float) -> str | None:
        """The elevator whose cabin a robot holds."""
        known = self._in.get(robot)
        if known is None:
            return None
        is_held = self._held.get(robot) == known.elevator
        return known.elevator if is_held or now_s >= known.since_s + STAYS_S else None

    def _told(self, robot: str, elevator: str, finding: Finding) -> Found:
        a, b = self._stops(elevator)
        return Found(finding=finding, between=(a, b), by=robot)

    def _stops(self, elevator: str) -> list[str]:
        """Two of the places at which it stops."""
        stops = self._dispatcher.building.document.elevators[elevator].stops
        return [f"{floor}/{at}" for floor, at in stops.items()][:2]

    def _is_closed(self, elevator: str, now_s: float) -> bool:
        closed_until_s = self._dispatcher.closed_until_s()
        return closed_until_s.get(frozenset(self._stops(elevator)), 0.0) > now_s

    def _closed_for(self, robot: str, elevator: str) -> bool:
        """Whether it is closed as this robot was in its cabin, and for nothing else."""
        stops = frozenset(self._stops(elevator))
        told = (each.told for each in self._closed.now() if frozenset(each.between) == stops)
        return any(each is not None and each.by == robot for each in told)
