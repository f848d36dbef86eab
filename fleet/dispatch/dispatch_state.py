"""What a dispatcher knows, and the one way in which its fleet hears of anything."""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager

from mend.errors import ConflictError, NotFoundError, WrongInputError
from mend.fleet.dispatch.booking import Booking, Series
from mend.fleet.dispatch.leg import Leg
from mend.fleet.dispatch.plan_log import PlanLog
from mend.fleet.dispatch.setting import FleetSetting
from mend.fleet.requests import Terms
from mend.fleet.scheduling.problem import Problem, Robot, Transfers, Weights, Window
from mend.fleet.scheduling.replanning.events import Event, EventError
from mend.fleet.scheduling.replanning.item_state import TrackedItem
from mend.fleet.scheduling.replanning.open_ways import OpenWays
from mend.fleet.scheduling.replanning.running_fleet import Outcome, RunningFleet
from mend.fleet.scheduling.travel import TravelError
from mend.maps.building.building import Building


class DispatchState:
    """The fleet, the bookings and series by name, the legs under way and how many each robot has
    begun; `tried_s`: when what had no place was tried again.

    Raises `WrongInputError` or `NotFoundError` for a setting that does not fit the building.
    """

    def __init__(self, building: Building, setting: FleetSetting) -> None:
        self.building, self.setting, self.policy = building, setting, setting.policy
        self.ways = OpenWays(building.graph, setting.speed_m_s, setting.starts_s)
        self.bookings: dict[str, Booking] = {}
        self.series: dict[str, Series] = {}
        self.under_way: dict[str, Leg] = {}
        self.begun: dict[str, int] = {}
        self.tried_s = 0.0
        self.log = PlanLog(setting.policy.kept)
        largest = max(robot.capacity for robot in setting.robots)
        places = [place.name for place in building.graph.places]
        self.terms = Terms(
            lambda name: places.index(building.find(name)), setting.handling_s, largest
        )
        self.problem = self._problem()
        self.fleet = RunningFleet(self.problem, ways=self.ways, observed=True)

    def _problem(self) -> Problem:
        setting, place = self.setting, self.terms.place
        names = [robot.name for robot in setting.robots]
        if len(set(names)) < len(names):
            raise WrongInputError("each robot must have a name of its own")
        robots = tuple(
            Robot(
                each.name,
                place(each.start),
                None,
                each.capacity,
                Window(each.works_from_s, each.until_s),
                speed=each.speed,
            )
            for each in setting.robots
        )
        try:
            travel = self.ways.travel()
        except TravelError as error:
            raise WrongInputError(str(error)) from error
        transfers = Transfers(
            tuple(place(each) for each in setting.transfer_places), service_s=setting.transfer_s
        )
        names = [each.name for each in self.building.graph.places]
        weights = Weights(
            distance=setting.per_metre,
            completion=setting.per_second,
            lateness=setting.per_second_late,
        )
        return Problem(self.building.name, tuple(names), travel, robots, (), transfers, weights)

    def apply(
        self, event: Event, why: str, requests: Iterable[str], *, own: str | None = None
    ) -> Outcome:
        """Let the fleet know, and say what became of its plan; `own`: what goes on as planned with
        that event.

        Raises `ConflictError` where it makes no sense.
        """
        with (
            refusing(),
            self.log.entry(lambda: self.fleet, why, requests, own=own) as outcomes,
        ):
            outcomes.append(self.fleet.apply(event, self.fleet.now_s))
        return outcomes[0]

    def settle(self) -> None:
        """Let every open booking follow its item."""
        items = self.fleet.items
        about_to = {leg.booking for leg in self.under_way.values()}
        for booking in self.bookings.values():
            if booking.open:
                booking.follow(items[booking.name], booking.name in about_to, self.fleet.now_s)

    def open_booking(self, name: str) -> Booking:
        """What is not over yet. Raises `NotFoundError`, and `ConflictError` where it is over."""
        booking = self.bookings.get(name)
        if booking is None:
            raise NotFoundError(f"there is no request '{name}'")
        if not booking.open:
            raise ConflictError(f"the request '{name}' is {booking.status.words}")
        return booking

    def occurrences(self, name: str) -> list[Booking]:
        """All that is known of what recurs under a name."""
        return [each for key, each in self.bookings.items() if key.split("/", 1)[0] == name]

    def where(self, item: TrackedItem) -> str:
        """Where an item is that is on its way, in words."""
        if item.robot is not None:
            return f"aboard {self.setting.robots[item.robot].name}"
        assert item.place is not None, "it lies somewhere"
        if item.held_by is not None:
            held_by = self.setting.robots[item.held_by].name
            return f"in the basket of {held_by} at {self.building.graph.places[item.place].name}"
        return f"at {self.building.graph.places[item.place].name}"


@contextmanager
def refusing() -> Iterator[None]:
    """What makes no sense to the fleet is refused, in its words."""
    try:
        yield
    except EventError as error:
        raise ConflictError(str(error)) from error
