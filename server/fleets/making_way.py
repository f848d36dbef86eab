"""Robots with nothing to do that stand where another one is to come: each goes elsewhere."""

from collections.abc import Container, Iterable, Iterator
from math import inf

from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.maps.building.building import PlaceKind


def who_makes_way(
    dispatcher: Dispatcher, reachable: Container[str], also: Iterable[tuple[str, str]] = ()
) -> Iterator[tuple[str, str]]:
    """Which robot goes to which place: its first one, a charger, where robots park, or a room.

    `reachable`: the places that robots can be sent to, as `FLOOR/PLACE`; `also`: which robots are
    to come to which of them, besides for what the dispatcher has them do. Who finds no such place
    free stays.
    """
    robots, stops = dispatcher.fleet.robots, dispatcher.fleet.stops()
    places = [each.name for each in dispatcher.building.graph.places]
    stands = {name: places[each.place] for name, each in robots.items()}
    wanted = {(name, stop.place) for name, left in stops.items() for stop in left}
    wanted |= {(leg.robot, leg.place) for leg in dispatcher.legs_under_way()}
    wanted |= set(also)
    busy = {name for name, _ in wanted}
    taken = {place for _, place in wanted} | set(stands.values())
    for name, place in stands.items():
        if name in busy or not robots[name].works or place not in {at for _, at in wanted}:
            continue
        free = [each for each in _resting_places(dispatcher, name, place) if each not in taken]
        for rest in (each for each in free if each in reachable):
            taken.add(rest)
            yield name, rest
            break


def _resting_places(dispatcher: Dispatcher, robot: str, stands: str) -> list[str]:
    """Where it is in nobody's way, then wherever it is soonest."""
    building, setting, fleet = dispatcher.building, dispatcher.setting, dispatcher.fleet
    own = [building.find(each.start) for each in setting.robots if each.name == robot]
    kept = [*own, *building.of_kind(PlaceKind.CHARGER), *building.of_kind(PlaceKind.PARKING)]
    rooms = {
        each: lasts_s
        for each in building.of_kind(PlaceKind.ROOM)
        if each not in (*kept, stands) and (lasts_s := fleet.lasts_s(robot, each)) < inf
    }
    return [*kept, *sorted(rooms, key=lambda each: rooms[each])]
