"""Robots that charge by themselves, before their batteries are so low that they ask people."""

from collections.abc import Callable, Container, Iterable, Iterator, Mapping
from math import inf

from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.maps.building.building import PlaceKind
from mend.server.fleets.fleet_record import Errand

IDLE_BELOW = 0.4
"""Who has nothing to do charges if its battery holds less of what it can."""
BUSY_BELOW = 0.2
"""Who has something to do charges first if it holds less; robots ask for current at 0.15."""
LEAVES_AT = 0.5
"""Who is to do something leaves its charger once it holds as much."""

LOOKS_AGAIN_S = 10.0
"""So often it is looked whether who charges and holds enough has something to do by then, and
whether a charger is free for who holds little."""
AGAIN_S = 600.0
"""Who could not charge, or had something to do instead, does not try again for so long."""


class Charging:
    """Which robots of a fleet are to charge, and which have charged enough.

    `battery`: what a robot's battery holds, in [0, 1], where it is known. `reachable`: the places
    that robots can be sent to, as `FLOOR/PLACE`.
    """

    def __init__(
        self,
        dispatcher: Dispatcher,
        battery: Callable[[str], float | None],
        reachable: Container[str],
    ) -> None:
        self._dispatcher, self._battery, self._reachable = dispatcher, battery, reachable
        self._again_s: dict[str, float] = {}
        self._looks_s: dict[str, float] = {}

    def to_send(
        self, free: Iterable[str], errands: Iterable[Errand], now_s: float
    ) -> list[tuple[str, str]]:
        """Which of the robots that nobody has now are to go to which charger, if no other one is on
        its way there in one of the `errands`."""
        shares = self._shares(free, now_s)
        if not shares:
            return []
        taken = {errand.place for errand in errands}
        return list(who_charges(self._dispatcher, shares, self._reachable, taken))

    def wanted(self, free: Iterable[str], now_s: float) -> list[tuple[str, str]]:
        """Which of the robots that nobody has now, and that nobody has sent to a charger, would
        charge where another one stands that is to make way."""
        shares = self._shares(free, now_s)
        return list(who_wants_another_away(self._dispatcher, shares, self._reachable))

    def _shares(self, free: Iterable[str], now_s: float) -> dict[str, float]:
        """What robots hold that nobody has, and that may try to charge by now."""
        return {
            robot: share
            for robot in free
            if now_s >= self._again_s.get(robot, 0.0)
            if (share := self._battery(robot)) is not None
        }

    def enough(self, going: Iterable[Errand], now_s: float) -> list[Errand]:
        """Those that are to be broken off: their robots charge, and have something to do."""
        charged = [
            errand
            for errand in going
            if errand.charges and (self._battery(errand.robot) or 0.0) >= LEAVES_AT
        ]
        if not charged:
            return []
        due = {leg.robot for leg in self._dispatcher.legs_to_begin(now_s)}
        return [errand for errand in charged if errand.robot in due]

    def is_to_look(self, robot: str, share: float | None, now_s: float, *, charges: bool) -> bool:
        """Whether it is time to look if a robot that `charges` has enough, or if one that nobody
        has is to charge; now and then, if so."""
        if share is None or now_s < self._looks_s.get(robot, 0.0):
            return False
        if share < LEAVES_AT if charges else share >= IDLE_BELOW:
            return False
        self._looks_s[robot] = now_s + LOOKS_AGAIN_S
        return charges or now_s >= self._again_s.get(robot, 0.0)

    def could_not(self, robot: str, now_s: float) -> None:
        """It has not charged until it was full."""
        self._again_s[robot] = now_s + AGAIN_S


def who_charges(
    dispatcher: Dispatcher,
    shares: Mapping[str, float],
    reachable: Container[str],
    taken: Container[str] = (),
) -> Iterator[tuple[str, str]]:
    """Which robot goes to which charger: the nearest that is free.

    `shares`: what the batteries of those hold that nobody has now, where it is known, in [0, 1].
    `reachable`: the places that robots can be sent to, as `FLOOR/PLACE`; `taken`: those to which
    others are on their way without a leg. Who has things aboard brings them first, and who finds no
    charger free goes on.
    """
    fleet, building = dispatcher.fleet, dispatcher.building
    stops, places = fleet.stops(), [each.name for each in building.graph.places]
    stands = {name: places[each.place] for name, each in fleet.robots.items()}
    wanted = {stop.place for left in stops.values() for stop in left}
    chargers = [each for each in building.of_kind(PlaceKind.CHARGER) if each in reachable]
    free = {each for each in chargers if each not in wanted and each not in taken}
    for name, share in sorted(shares.items(), key=lambda each: each[1]):
        if not fleet.robots[name].works or share >= _least(dispatcher, name):
            continue
        others = {at for other, at in stands.items() if other != name}
        near = {each: fleet.lasts_s(name, each) for each in free - others}
        charger = min(near, key=lambda each: (near[each], each), default=None)
        if charger is not None and near[charger] < inf:
            free.remove(charger)
            yield name, charger


def who_wants_another_away(
    dispatcher: Dispatcher, shares: Mapping[str, float], reachable: Container[str]
) -> Iterator[tuple[str, str]]:
    """Which robot holds little, and at which charger another one stands that holds enough and has
    nothing to do: the nearest.

    `shares`: what the batteries of those hold that nobody has now, where it is known, in [0, 1].
    """
    fleet, building = dispatcher.fleet, dispatcher.building
    stops, places = fleet.stops(), [each.name for each in building.graph.places]
    chargers = [each for each in building.of_kind(PlaceKind.CHARGER) if each in reachable]
    in_the_way = {
        at: name
        for name, share in shares.items()
        if (at := places[fleet.robots[name].place]) in chargers
        if share >= LEAVES_AT and not stops[name] and fleet.robots[name].works
    }
    for name, share in sorted(shares.items(), key=lambda each: each[1]):
        if not in_the_way or not fleet.robots[name].works or share >= _least(dispatcher, name):
            continue
        if places[fleet.robots[name].place] in chargers:
            continue
        near = {each: fleet.lasts_s(name, each) for each in in_the_way}
        at = min(near, key=lambda each: (near[each], each))
        if near[at] < inf:
            del in_the_way[at]
            yield name, at


def _least(dispatcher: Dispatcher, robot: str) -> float:
    """What the battery of a robot is to hold for it to do what it is to do next, if anything."""
    fleet = dispatcher.fleet
    if any(leg.robot == robot for leg in dispatcher.legs_under_way()):
        return 0.0
    if not fleet.stops()[robot]:
        return IDLE_BELOW
    number = list(fleet.robots).index(robot)
    carries = any(each.open and each.robot == number for each in fleet.items.values())
    return 0.0 if carries else BUSY_BELOW
