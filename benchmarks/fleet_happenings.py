"""What happens to a fleet at work, drawn at random: everything that makes sense at the moment."""

from collections.abc import Callable, Sequence
from random import Random

from mend.fleet.scheduling.problem import Item, Visit, Window
from mend.fleet.scheduling.replanning.events import (
    Cancelled,
    DoorClosed,
    Event,
    NewItem,
    RobotBack,
    RobotDelayed,
    RobotFailed,
    TimePassed,
    WayBlocked,
    WayOpen,
)
from mend.fleet.scheduling.replanning.running_fleet import RunningFleet
from mend.maps.navigation import NavigationGraph

LONGEST_DELAY_S = 90.0
RETRY_S = 120.0
LONGEST_WAIT_S = 1200.0
"""The longest time that an item's delivery may have."""
LOST = 0.1
"""The share of items on board of a robot that fails that is lost with it."""


class Happenings:
    """Draws events, and knows which ways it has closed.

    `busy`: how many items there should be open at a time; `places`: where items come from and go.
    """

    def __init__(
        self, graph: NavigationGraph, places: Sequence[int], busy: int, chance: Random
    ) -> None:
        self._ways = [(way.a, way.b) for way in graph.ways]
        self._names = [place.name for place in graph.places]
        self._places = places
        self._busy = busy
        self._chance = chance
        self._closed: list[tuple[str, str]] = []
        self._count = 0

    def next_event(self, fleet: RunningFleet) -> Event:
        """Something that could happen to the fleet right now."""
        draw = self._chance.choices(
            [
                self._item,
                self._cancel,
                self._delay,
                self._fail,
                self._back,
                self._close,
                self._open,
            ],
            weights=[8, 2, 6, 1, 2, 1, 2],
        )[0]
        return draw(fleet) or TimePassed()

    def _item(self, fleet: RunningFleet) -> Event | None:
        open_items = sum(item.open for item in fleet.items.values())
        if open_items >= self._busy:
            return None
        chance, now_s = self._chance, fleet.now_s
        self._count += 1
        origin, destination = chance.sample(self._places, 2)
        window, due_s = Window(now_s), now_s + chance.uniform(0.3, 1.0) * LONGEST_WAIT_S
        if chance.random() < 0.5:
            window = Window(now_s, due_s)
        delivery = Visit(destination, window, due_s, float(chance.randrange(0, 10)))
        pickup = Visit(origin, Window(now_s + chance.choice((0.0, 60.0))), service_s=5.0)
        item = Item(f"new{self._count}", float(chance.choice((1, 1, 2))), pickup, delivery)
        return NewItem(item)

    def _cancel(self, fleet: RunningFleet) -> Event | None:
        return self._one(
            [name for name, item in fleet.items.items() if item.open and not item.returns],
            Cancelled,
        )

    def _delay(self, fleet: RunningFleet) -> Event | None:
        by_s = self._chance.uniform(1.0, LONGEST_DELAY_S)
        working = [name for name, robot in fleet.robots.items() if robot.works]
        return self._one(working, lambda name: RobotDelayed(name, by_s))

    def _fail(self, fleet: RunningFleet) -> Event | None:
        working = [name for name, robot in fleet.robots.items() if robot.works]
        if len(working) < 2:
            return None
        name = self._chance.choice(working)
        number = list(fleet.robots).index(name)
        aboard = [n for n, item in fleet.items.items() if item.robot == number]
        return RobotFailed(name, frozenset(n for n in aboard if self._chance.random() < LOST))

    def _back(self, fleet: RunningFleet) -> Event | None:
        place = self._names[self._chance.choice(self._places)]
        failed = [name for name, robot in fleet.robots.items() if not robot.works]
        return self._one(failed, lambda name: RobotBack(name, place))

    def _close(self, fleet: RunningFleet) -> Event | None:  # noqa: ARG002 - all draw alike
        way = self._chance.choice(self._ways)
        if self._chance.random() < 0.5:
            return DoorClosed(way, RETRY_S)
        self._closed.append(way)
        return WayBlocked(way)

    def _open(self, fleet: RunningFleet) -> Event | None:  # noqa: ARG002 - all draw alike
        if not self._closed:
            return None
        return WayOpen(self._closed.pop(self._chance.randrange(len(self._closed))))

    def _one(self, names: Sequence[str], event: Callable[[str], Event]) -> Event | None:
        return event(self._chance.choice(names)) if names else None
