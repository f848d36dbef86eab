"""A shift drawn by a seed: what people ask of a building's robots, and what happens meanwhile.

What happens has a request of its own each, so far from the others that one rarely is in the way of
another.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import count
from math import inf
from random import Random
from typing import TypeVar

from mend.documents.problem import list_names
from mend.errors import WrongInputError
from mend.fleet.dispatch.booking import AnyRequest
from mend.fleet.dispatch.closed_words import told_hours
from mend.fleet.dispatch.setting import FleetSetting, ServiceRobot
from mend.fleet.happenings import (
    Cancelled,
    Happening,
    NobodyAnswers,
    RobotFails,
    WayBarred,
    WrongFloor,
)
from mend.fleet.request_file import RequestsDocument
from mend.fleet.requests import DeliverMessage, Escort, Transport
from mend.fleet.shifts.changing_robots import changing_robots
from mend.fleet.shifts.ways import DeliveryWays, Hindrance
from mend.maps.building.building import Building, PlaceKind

T = TypeVar("T")

CAPACITY = 3.0
"""What fits into a basket, in loads, unless somebody says otherwise."""
HELPERS = ("reception", "caretaker")
_THINGS = (
    "parcel", "keys", "forms", "cups", "mail", "tablet", "letters", "lamp", "towels", "books",
    "tools", "flowers", "lunch", "samples", "badge", "charger", "umbrella", "glasses",
)  # fmt: skip
_ENOUGH_ROOMS = 4
AHEAD_S = 120.0
"""What is asked for at first is asked for so long ahead: the plan is made before robots set out."""
_NEAR, _FAR = 2, 2
"""So many deliveries are asked for at first near each robot, and from one to another."""
_TRIES = 200
"""So many deliveries are drawn at most to find one on whose way something may happen."""
_BLOCKED, _LOCKED = 6.0, 30.0
"""Such a share of a shift what can be gone round bars a way, and what cannot."""
_SOON_S = 60.0
"""Whoever goes round that takes no longer does so at once."""


@dataclass(frozen=True, slots=True)
class Shift:
    """A request file, and a sentence for whatever cannot happen in this building."""

    document: RequestsDocument
    notes: Sequence[str]


def drawn_shift(
    building: Building, robots: Mapping[str, str], goals: Sequence[str], seed: int, lasts_s: float
) -> Shift:
    """A shift of `lasts_s` seconds; the same seed draws the same.

    `robots`: where each begins, `FLOOR/PLACE`; `goals`: the places that robots are sent to. Raises
    `WrongInputError` where there are fewer than two that robots get to.
    """
    return _Drawing(building, robots, goals, Random(seed), lasts_s).drawn()


class _Drawing:
    def __init__(
        self,
        building: Building,
        robots: Mapping[str, str],
        goals: Sequence[str],
        chance: Random,
        lasts_s: float,
    ) -> None:
        self._building, self._robots, self._goals = building, robots, goals
        self._chance, self._lasts_s = chance, lasts_s
        self._requests: list[AnyRequest] = []
        self._asked_s: dict[str, float] = {}
        self._happenings: list[Happening] = []
        self._notes: list[str] = []
        self._ways = DeliveryWays(building)
        self._names = _names(chance)
        self._rooms = self._wanted_at()
        self._transfer_places = self._where_to_change()

    def drawn(self) -> Shift:
        acts = [
            self._rush,
            self._wrong_floor,
            self._escort,
            self._blocked_hallway,
            self._closed_door,
            self._nobody_answers,
            self._cancelled,
            self._message,
        ]
        for number, act in enumerate(acts):
            act(round(self._lasts_s * number / len(acts)))
        document = RequestsDocument(
            requests=tuple(self._requests),
            asked_s=self._asked_s,
            happenings=tuple(self._happenings),
            helpers=HELPERS,
            transfer_places=tuple(self._transfer_places),
        )
        return Shift(document, self._notes)

    # --- What happens, one after the other --------------------------------------------------------

    def _rush(self, at_s: float) -> None:
        """More than robots bring at once; a thing changes robots, and a robot fails."""
        transports, changes = self._transports()
        for each in transports:
            self._ask(each, at_s)
        if len(self._robots) < 2:
            self._notes.append("one robot alone: no thing changes robots, and nobody helps it out")
            return
        if not changes:
            self._notes.append(
                "no thing changes robots: in all plans that were tried one robot alone is as quick"
            )
        fails_s, back_s = at_s + AHEAD_S + 30.0, at_s + self._lasts_s / 2.0
        self._happenings.append(
            RobotFails(kind="robot_fails", at_s=fails_s, until_s=back_s, reason="a wheel is stuck")
        )

    def _transports(self) -> tuple[Sequence[Transport], bool]:
        """Some anywhere; or some near each robot, and then some from one to another."""
        zones = self._zones()
        near = [zone for zone in zones if len(zone) > 1] * _NEAR
        names = [next(self._names) for _ in range(max(len(near) + _FAR, len(self._robots) + 1))]

        def draw() -> Sequence[Transport]:
            if self._chance.random() < 0.5:
                many = self._chance.randint(len(self._robots), len(names))
                ends = [self._two_rooms() for _ in range(many)]
            else:
                ends = [self._two_of(zone) for zone in near]
                self._chance.shuffle(ends)
                ends += [self._far_rooms(zones) for _ in range(_FAR)]
            return [
                _transport(name, *each, earliest_s=AHEAD_S)
                for name, each in zip(names, ends, strict=False)
            ]

        if len(self._robots) < 2 or not self._transfer_places:
            return draw(), False
        setting = FleetSetting(
            robots=tuple(
                ServiceRobot(name=name, start=start, capacity=CAPACITY)
                for name, start in self._robots.items()
            ),
            transfer_places=tuple(self._transfer_places),
        )
        return changing_robots(self._building, setting, draw)

    def _zones(self) -> Sequence[Sequence[str]]:
        """The rooms that are nearest to each robot, where it begins."""
        zones: dict[str, list[str]] = {start: [] for start in self._robots.values()}
        for room in self._rooms:
            zones[min(zones, key=lambda start: self._ways.seconds(start, room))].append(room)
        return [zone for zone in zones.values() if zone]

    def _far_rooms(self, zones: Sequence[Sequence[str]]) -> tuple[str, str]:
        """Rooms near different robots, where there are such."""
        if len(zones) < 2:
            return self._two_rooms()
        one, other = self._chance.sample(zones, 2)
        return self._chance.choice(one), self._chance.choice(other)

    def _wrong_floor(self, at_s: float) -> None:
        """Somebody presses another button in the elevator that a thing is to be brought by."""
        found = self._on_the_way(lambda a, b: self._ways.elevators(a, b)[:1])
        if found is None:
            self._notes.append("no wrong floor: no elevator is on the way between any two rooms")
            return
        ends, (elevator,) = found
        self._happenings.append(WrongFloor(kind="wrong_floor", at_s=at_s, elevator=elevator))
        self._ask(_transport(next(self._names), *ends), at_s)

    def _escort(self, at_s: float) -> None:
        origin, destination = self._two_rooms()
        guest = Escort(name="guest", person="Ms Lee", origin=origin, destination=destination)
        self._ask(guest, at_s)

    def _blocked_hallway(self, at_s: float) -> None:
        hindrance = self._hindered(at_s, is_door=False)
        if hindrance is None:
            self._notes.append(
                "no blocked hallway: on no way between rooms is a lane with walls on both sides"
            )
        elif hindrance.longer_s == inf:
            self._notes.append("a blocked hallway is waited for: no way leads round any")

    def _closed_door(self, at_s: float) -> None:
        if self._hindered(at_s, is_door=True) is None:
            self._notes.append("no closed door: no door is on the way between any two rooms")

    def _nobody_answers(self, at_s: float) -> None:
        """The question goes to the next helper."""
        begin_s, end_s = max(0.0, at_s - 10.0), at_s + 30.0
        self._happenings.append(NobodyAnswers(kind="nobody_answers", at_s=begin_s, until_s=end_s))
        self._ask(_transport(next(self._names), *self._two_rooms()), at_s)

    def _cancelled(self, at_s: float) -> None:
        name = next(self._names)
        self._ask(_transport(name, *self._two_rooms()), at_s)
        self._happenings.append(Cancelled(kind="cancelled", at_s=at_s + 20.0, request=name))

    def _message(self, at_s: float) -> None:
        begins_s = at_s + self._lasts_s / 20.0
        place = self._chance.choice(self._rooms)
        message = "We close at six."
        self._ask(
            DeliverMessage(name="closing", place=place, message=message, earliest_s=begins_s), at_s
        )

    # --- What is drawn ----------------------------------------------------------------------------

    def _hindered(self, at_s: float, *, is_door: bool) -> Hindrance | None:
        """A transport, and what bars its way from shortly before it is asked for.

        It is over the sooner where no other way leads: nobody gets past before that.
        """

        def that_bar(origin: str, destination: str) -> Sequence[Hindrance]:
            every = self._ways.hindrances(origin, destination)
            return [each for each in every if each.is_door is is_door]

        found = self._on_the_way(that_bar, lambda each: each.longer_s)
        if found is None:
            return None
        ends, hindrances = found
        chosen = min(hindrances, key=lambda each: each.longer_s)
        lasts_s = self._lasts_s / (_LOCKED if chosen.longer_s == inf else _BLOCKED)
        self._happenings.append(
            WayBarred(
                kind="way_barred",
                between=chosen.between,
                at_s=max(0.0, at_s - 30.0),
                until_s=at_s + lasts_s,
            )
        )
        self._ask(_transport(next(self._names), *ends), at_s)
        return chosen

    def _on_the_way(
        self,
        of: Callable[[str, str], Sequence[T]],
        longer_s: Callable[[T], float] = lambda _: 0.0,
    ) -> tuple[tuple[str, str], Sequence[T]] | None:
        """Two rooms between which there is something, and that; the shortest way round of some."""
        best: tuple[float, tuple[str, str], Sequence[T]] | None = None
        for _ in range(_TRIES):
            ends = self._two_rooms()
            if not (there := of(*ends)):
                continue
            least_s = min(map(longer_s, there))
            if best is None or least_s < best[0]:
                best = least_s, ends, there
            if least_s <= _SOON_S:
                break
        return None if best is None else best[1:]

    def _two_rooms(self) -> tuple[str, str]:
        return self._two_of(self._rooms)

    def _two_of(self, rooms: Sequence[str]) -> tuple[str, str]:
        origin, destination = self._chance.sample(rooms, 2)
        return origin, destination

    def _ask(self, request: AnyRequest, at_s: float) -> None:
        self._requests.append(request)
        if at_s > 0.0:
            self._asked_s[request.name] = at_s

    def _wanted_at(self) -> Sequence[str]:
        """Rooms and where robots park, also chargers where there are few; of what they get to."""
        reached = [each for each in self._goals if self._is_reached(each)]
        if lost := [each for each in self._goals if each not in reached]:
            hours = told_hours(self._building)
            at_all_times = f" at all times ({hours})" if hours else ""
            self._notes.append(
                f"robots do not get to {list_names(lost)}{at_all_times}, where nobody asks then"
            )
        of_kind = self._building.of_kind
        rooms = {*of_kind(PlaceKind.ROOM), *of_kind(PlaceKind.PARKING)}
        wanted = [each for each in reached if each in rooms]
        if len(wanted) < _ENOUGH_ROOMS:
            chargers = of_kind(PlaceKind.CHARGER)
            wanted += [each for each in reached if each in chargers]
        if len(wanted) < 2:
            raise WrongInputError(
                f"'{self._building.name}' has {'one room' if wanted else 'no room'}, charger or "
                "place to park that robots get to: what is to be brought somewhere needs two"
            )
        return wanted

    def _is_reached(self, goal: str) -> bool:
        seconds = self._ways.seconds
        return any(
            seconds(start, goal) < inf and seconds(goal, start) < inf
            for start in self._robots.values()
        )

    def _where_to_change(self) -> Sequence[str]:
        """At elevators; where there are none, in the room that is nearest to all others."""
        stops = self._building.of_kind(PlaceKind.ELEVATOR)
        if found := [each for each in self._goals if each in stops]:
            return found
        return [min(self._rooms, key=lambda a: sum(self._ways.seconds(a, b) for b in self._rooms))]


def _transport(name: str, origin: str, destination: str, earliest_s: float = 0.0) -> Transport:
    return Transport(
        name=name,
        what=f"the {name}",
        origin=origin,
        destination=destination,
        earliest_s=earliest_s,
    )


def _names(chance: Random) -> Iterator[str]:
    """Things that are brought, each once; then with numbers."""
    for number in count(1):
        for each in chance.sample(_THINGS, len(_THINGS)):
            yield each if number == 1 else f"{each}{number}"
