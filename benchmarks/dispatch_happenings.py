"""What happens to a dispatcher, drawn: requests, failures, closed ways, second thoughts."""

from collections.abc import Callable, Mapping, Sequence
from random import Random
from typing import Any

from mend.errors import RefusalError
from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.dispatch.leg import Finding, Found
from mend.fleet.dispatch.setting import FleetSetting, ServiceRobot
from mend.fleet.requests import RequestStatus, request_of
from mend.fleet.scheduling.replanning.item_state import ItemState
from mend.maps.building.building import Building, PlaceKind
from mend.maps.building.random_building import random_building

MIX = {"escort": 3, "go_to_room": 52, "deliver_message": 56, "transport": 29}
"""The published mix of tasks."""


THINGS = {"escort": 1, "go_to_room": 1, "deliver_message": 1, "transport": 6}
"""A mix with more to carry, so that it pays to hand over."""


def drawn_fleet(
    seed: int, *, floors: int = 2, rooms: int = 8, robots: int = 3
) -> tuple[Building, FleetSetting]:
    """A drawn building with robots that carry 1 to 3, and may hand over at some drawn places.

    The first works always, of the others about every third for two hours.
    """
    building = Building(random_building(seed, floors, rooms))
    chance = Random(seed)
    places = building.of_kind(PlaceKind.ROOM)
    everywhere = [place.name for place in building.graph.places]
    fleet = tuple(
        ServiceRobot(
            name=f"r{number}",
            start=chance.choice(places),
            capacity=chance.choice((1.0, 2.0, 3.0)),
            works_until_s=chance.choice((None, None, 7200.0)) if number else None,
        )
        for number in range(robots)
    )
    transfers = tuple(chance.sample(everywhere, 6))
    return building, FleetSetting(robots=fleet, transfer_places=transfers, transfer_s=5.0)


class DispatchHappenings:
    """Draws what happens to a dispatcher and does it.

    `busy`: so many requests are open at most; `mix`: how often which kind is asked for.
    """

    def __init__(
        self,
        building: Building,
        chance: Random,
        *,
        busy: int = 12,
        mix: Mapping[str, int] = MIX,
    ) -> None:
        self._rooms = building.of_kind(PlaceKind.ROOM)
        self._ways = [(way.a, way.b) for way in building.graph.ways]
        self._busy, self._mix, self._chance, self._count = busy, mix, chance, 0

    def happen(self, dispatcher: Dispatcher, now_s: float) -> str:
        """Something happens, and what it was; what makes no sense just then is refused."""
        draws: Sequence[Callable[[Dispatcher, float], str]] = (
            self._ask, self._cancel, self._change, self._fail, self._back, self._find, self._lose,
            self._fetch,
        )  # fmt: skip
        draw = self._chance.choices(draws, weights=(10, 2, 1, 1, 2, 3, 0.3, 1))[0]
        try:
            return draw(dispatcher, now_s)
        except RefusalError as error:
            return f"refused: {error}"

    def request(self, now_s: float) -> dict[str, Any]:
        """A request as somebody could make it at a time."""
        chance = self._chance
        self._count += 1
        kind = chance.choices(list(self._mix), weights=list(self._mix.values()))[0]
        origin, destination = chance.sample(self._rooms, 2)
        earliest_s = now_s + chance.choice((0.0, 0.0, 300.0, 3000.0))
        asked: dict[str, Any] = {"kind": kind, "name": f"q{self._count}", "earliest_s": earliest_s}
        if chance.random() < 0.6:
            asked["latest_s"] = earliest_s + chance.choice((60.0, 300.0, 900.0, 3600.0))
        if chance.random() < 0.05:
            asked["recurrence"] = {"every_s": 1800.0, "until_s": earliest_s + 7200.0}
        match kind:
            case "escort":
                return {**asked, "origin": origin, "destination": destination, "person": "Ann"}
            case "transport":
                load = float(chance.choice((0.5, 1.0, 2.0)))
                places = {"origin": origin, "destination": destination}
                return {**asked, **places, "what": "a parcel", "load": load}
            case "deliver_message":
                return {**asked, "place": origin, "message": "the meeting begins"}
        return {**asked, "place": origin, "stay_s": chance.choice((0.0, 60.0))}

    def _ask(self, dispatcher: Dispatcher, now_s: float) -> str:
        if len(self._open(dispatcher)) >= self._busy:
            return "enough is asked for"
        request = request_of(self.request(now_s))
        answer = dispatcher.submit(request, now_s)
        return f"asked for {request.name}: {answer.why or 'booked'}"

    def _cancel(self, dispatcher: Dispatcher, now_s: float) -> str:
        name = self._one(self._open(dispatcher))
        dispatcher.cancel(name, now_s)
        return f"cancelled {name}"

    def _change(self, dispatcher: Dispatcher, now_s: float) -> str:
        name = self._one(self._open(dispatcher))
        asked = {**self.request(now_s), "name": name.split("/")[0]}
        asked.pop("recurrence", None)
        answer = dispatcher.change(name, request_of(asked), now_s)
        return f"changed {name}: {answer.why or 'booked'}"

    def _fail(self, dispatcher: Dispatcher, now_s: float) -> str:
        robots = dispatcher.fleet.robots
        name = self._one([name for name, robot in robots.items() if robot.works])
        number = list(robots).index(name)
        aboard = [
            item
            for item, each in dispatcher.fleet.items.items()
            if each.robot == number and each.state is ItemState.ABOARD
        ]
        lost = [item for item in aboard if self._chance.random() < 0.1]
        at = self._chance.choice((None, self._chance.choice(self._rooms)))
        dispatcher.robot_failed(name, at, "its battery is empty", now_s, lost=lost)
        return f"{name} failed at {at}, {lost} lost"

    def _back(self, dispatcher: Dispatcher, now_s: float) -> str:
        robots = dispatcher.fleet.robots
        name = self._one([name for name, robot in robots.items() if not robot.works])
        dispatcher.robot_back(name, self._chance.choice(self._rooms), now_s)
        return f"{name} is back"

    def _find(self, dispatcher: Dispatcher, now_s: float) -> str:
        chance, closed = self._chance, [tuple(way) for way in dispatcher.closed_until_s()]
        finding = chance.choice(list(Finding))
        way = chance.choice(closed if finding is Finding.OPEN and closed else self._ways)
        until_s = now_s + chance.choice((100.0, 2000.0)) if chance.random() < 0.5 else None
        found = Found(finding=finding, between=(way[0], way[1]), until_s=until_s)
        if finding is not Finding.OPEN and (legs := dispatcher.legs_under_way()):
            by = chance.choice(legs).robot
            instead = dispatcher.take_over(found.model_copy(update={"by": by}), now_s)
            if instead is not None:
                return f"{instead} takes over from {by}, which found {finding} between {way}"
        dispatcher.found(found, now_s)
        return f"found {finding} between {way}"

    def _lose(self, dispatcher: Dispatcher, now_s: float) -> str:
        name = self._one(self._open(dispatcher))
        dispatcher.item_lost(name, "somebody saw it fall", now_s)
        return f"lost {name}"

    def _fetch(self, dispatcher: Dispatcher, now_s: float) -> str:
        items = dispatcher.fleet.items.items()
        name = self._one([name for name, item in items if item.state is ItemState.STRANDED])
        dispatcher.fetched(name, now_s)
        return f"fetched {name}"

    def _open(self, dispatcher: Dispatcher) -> list[str]:
        over = (
            RequestStatus.DONE, RequestStatus.REFUSED, RequestStatus.CANCELLED,
            RequestStatus.FAILED,
        )  # fmt: skip
        return [view.name for view in dispatcher.views() if view.status not in over]

    def _one(self, names: Sequence[str]) -> str:
        if not names:
            raise RefusalError("there is none just now")
        return self._chance.choice(names)
