"""Hands the requests of one building's people to its robots, leg by leg, and follows what comes.

Whoever carries out the legs says what became of each; times are passed in, seconds on one clock
that never goes back. What is raised is a `RefusalError` and leaves all as it was.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from math import ceil, inf

from mend.errors import ConflictError, NotFoundError, UnreadableError, WrongInputError
from mend.fleet.dispatch.booking import (
    Answer,
    AnyRequest,
    Booking,
    Expected,
    PlanChange,
    RequestView,
    Series,
)
from mend.fleet.dispatch.fleet_snapshot import snapshot_of, state_of
from mend.fleet.dispatch.leg import Finding, Found, Leg, LegEnd, LegOutcome
from mend.fleet.dispatch.next_possible import bounded, next_possible
from mend.fleet.dispatch.plan_log import PlanLog
from mend.fleet.dispatch.setting import FleetSetting
from mend.fleet.dispatch.snapshot import DispatcherSnapshot, KeptBooking, KeptChange, KeptSeries
from mend.fleet.requests import LegAction, RequestStatus, Terms
from mend.fleet.scheduling.checker import ScheduleError
from mend.fleet.scheduling.problem import Item, Problem, Robot, Transfers, Weights, Window
from mend.fleet.scheduling.replanning.events import (
    Cancelled,
    DoorClosed,
    Event,
    EventError,
    Fetched,
    ItemLost,
    NewItem,
    RobotBack,
    RobotFailed,
    SetOut,
    StopBegun,
    StopFailed,
    StopMade,
    Stranded,
    TimePassed,
    WayOpen,
)
from mend.fleet.scheduling.replanning.item_state import ItemState, TrackedItem
from mend.fleet.scheduling.replanning.live_plan import NextStop
from mend.fleet.scheduling.replanning.open_ways import OpenWays
from mend.fleet.scheduling.replanning.residual_problem import Building as KeptBuilding
from mend.fleet.scheduling.replanning.running_fleet import RunningFleet
from mend.fleet.scheduling.schedule import Action
from mend.fleet.scheduling.travel import TravelError
from mend.maps.building.building import Building

REOPENS_EVERY_S = 300.0
"""What is closed for a while counts as open at multiples of this: plans know few such times."""
CLOSED_ITEMS = 64
"""So many items with which nothing remains to be done are forgotten at once."""
IN_TIME_S = 1e-6


class Dispatcher:
    """The requests of a building's people and its robots.

    Raises `WrongInputError` or `NotFoundError` for a setting that does not fit the building.
    """

    def __init__(self, building: Building, setting: FleetSetting, *, now_s: float = 0.0) -> None:
        self._begin(building, setting)
        problem = self._problem()
        self._fleet = RunningFleet(problem, ways=self._ways, observed=True)
        self._fleet.advance(now_s)

    @classmethod
    def restored(
        cls, building: Building, setting: FleetSetting, snapshot: DispatcherSnapshot
    ) -> "Dispatcher":
        """A dispatcher equal to the one whose snapshot it was.

        Raises `UnreadableError` where the building or its robots are others now.
        """
        dispatcher = cls.__new__(cls)
        dispatcher._begin(building, setting)
        problem = dispatcher._problem()
        about = KeptBuilding(problem.name, problem.places, problem.transfers, problem.weights)
        try:
            state = state_of(snapshot.fleet, about, problem.robots, dispatcher._ways)
            dispatcher._fleet = RunningFleet.resumed(state)
        except (EventError, ScheduleError) as error:
            raise UnreadableError(f"what was kept does not fit the building: {error}") from error
        dispatcher._bookings = {each.name: each.booking() for each in snapshot.bookings}
        dispatcher._series = {each.request.name: each.series() for each in snapshot.series}
        dispatcher._under_way = {each.robot: each for each in snapshot.under_way}
        dispatcher._begun, dispatcher._tried_s = dict(snapshot.begun), snapshot.tried_s
        dispatcher._log.restore((each.change() for each in snapshot.changes), snapshot.change_count)
        return dispatcher

    def snapshot(self) -> DispatcherSnapshot:
        """All that is known, to be kept; `restored` makes an equal dispatcher of it."""
        return DispatcherSnapshot(
            fleet=snapshot_of(self._fleet.state()),
            bookings=tuple(KeptBooking.of(each) for each in self._bookings.values()),
            series=tuple(KeptSeries.of(each) for each in self._series.values()),
            under_way=tuple(self._under_way.values()),
            begun=dict(self._begun),
            tried_s=self._tried_s,
            changes=tuple(KeptChange.of(each) for each in self._log.changes),
            change_count=self._log.count,
        )

    def _begin(self, building: Building, setting: FleetSetting) -> None:
        self.building, self.setting, self.policy = building, setting, setting.policy
        self._ways = OpenWays(building.graph, setting.speed_m_s)
        self._bookings: dict[str, Booking] = {}
        self._series: dict[str, Series] = {}
        self._under_way: dict[str, Leg] = {}
        self._begun: dict[str, int] = {}
        self._tried_s = 0.0
        self._log = PlanLog(setting.policy.kept)
        largest = max(robot.capacity for robot in setting.robots)
        places = [place.name for place in building.graph.places]
        self._terms = Terms(
            lambda name: places.index(building.find(name)), setting.handling_s, largest
        )

    def _problem(self) -> Problem:
        setting, place = self.setting, self._terms.place
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
            travel = self._ways.travel()
        except TravelError as error:
            raise WrongInputError(str(error)) from error
        transfers = Transfers(
            tuple(place(each) for each in setting.transfer_places), service_s=setting.transfer_s
        )
        names = [each.name for each in self.building.graph.places]
        weights = Weights(distance=setting.per_metre, completion=setting.per_second)
        return Problem(self.building.name, tuple(names), travel, robots, (), transfers, weights)

    # --- what people ask --------------------------------------------------------------------------

    def submit(self, request: AnyRequest, now_s: float) -> Answer:
        """Book a request, or refuse it with the next time at which it could be met.

        Of one that recurs the first occurrence decides. Raises `ConflictError` where there is one
        of that name, `NotFoundError` for a place that the building does not have.
        """
        self._require_free(request.name)
        for place in request.places:
            self.building.find(place)
        self._advance(now_s)
        if request.recurrence is None:
            return self._book(request.name, request)
        series = Series(request)
        answer = self._book(series.next_name(), request.occurrence(1))
        if answer.booked:
            series.booked = 1
            self._series[request.name] = series
            self._book_recurring()
        return answer

    def cancel(self, name: str, now_s: float) -> RequestView | None:
        """What is asked for under a name is not wanted any more; what is fetched goes back.

        Of a request that recurs all that is still open goes; then there is no view. Raises
        `NotFoundError`, and `ConflictError` where it is over.
        """
        self._advance(now_s)
        series = self._series.get(name)
        if series is None:
            self._cancel(self._open_booking(name))
            return self.view(name)
        left = [
            each
            for each in self._occurrences(name)
            if each.open
            and each.status is not RequestStatus.RETURNING
            and not self._fleet.items[each.name].withdrawn
        ]
        if series.over and not left:
            raise ConflictError(f"the request '{name}' is over")
        series.over = True
        for booking in left:
            self._cancel(booking)
        return None

    def change(self, name: str, request: AnyRequest, now_s: float) -> Answer:
        """Book other words for what nobody has set out for yet; refused, it stays as it was.

        Raises `NotFoundError`, and `ConflictError` where it is too late or it recurs.
        """
        self._advance(now_s)
        if name in self._series or request.recurrence is not None:
            raise ConflictError(
                f"the request '{name}' recurs: change one occurrence, or cancel it and ask anew"
            )
        if request.name != name.split("/", 1)[0]:
            raise WrongInputError(
                f"what is changed keeps its name: '{name.split('/', 1)[0]}', not '{request.name}'"
            )
        for place in request.places:
            self.building.find(place)
        booking = self._open_booking(name)
        if booking.status not in (RequestStatus.BOOKED, RequestStatus.WAITING):
            raise ConflictError(f"the request '{name}' is {booking.status}: too late to change it")
        without = self._fleet.fork()
        without.apply(Cancelled(name), without.now_s)
        without.forget_closed()
        answer = self._take_on(without, self._item(name, request), f"'{name}' is wanted otherwise")
        if answer is None:
            booking.request, booking.attempts, booking.reason = request, 0, None
            self._settle()
        return answer or Answer(True, self.expected(name))

    # --- what robots do ---------------------------------------------------------------------------

    def legs_to_begin(self, now_s: float) -> list[Leg]:
        """What robots are to set out for now, at most one leg each."""
        self._advance(now_s)
        legs = (self._due_leg(robot, stops) for robot, stops in self._fleet.stops().items())
        return [leg for leg in legs if leg is not None]

    def legs_to_withdraw(self, now_s: float) -> list[Leg]:
        """The legs under way that are not wanted any more: each is to be broken off and ended."""
        self._advance(now_s)
        return [leg for robot, leg in self._under_way.items() if not self._fleet.robots[robot].held]

    def legs_under_way(self) -> list[Leg]:
        """The legs that were begun and have not ended."""
        return list(self._under_way.values())

    def may_begin(self, leg: Leg, now_s: float) -> bool:
        """Whether a robot that is at the place of its leg may do there what it is to do."""
        self._advance(now_s)
        self._require_under_way(leg)
        if now_s < leg.not_before_s - IN_TIME_S:
            return False
        return leg.action is not LegAction.TAKE or self._fleet.is_there(leg.robot)

    def began(self, leg: Leg, now_s: float) -> None:
        """A robot has set out. Raises `ConflictError` where it is not to do that any more."""
        self._advance(now_s)
        stops = self._fleet.stops().get(leg.robot, ())
        now = self._leg(leg.robot, stops[0]) if stops else None
        if now is None or not now.is_same(leg) or leg.robot in self._under_way:
            raise ConflictError(f"robot '{leg.robot}' is not to {leg.action} '{leg.booking}' now")
        self._apply(SetOut(leg.robot), f"{leg.robot} sets out later than planned", set())
        self._under_way[leg.robot] = now
        self._begun[leg.robot] = now.number
        self._settle()

    def arrived(self, leg: Leg, now_s: float) -> None:
        """A robot is there and begins with what it is to do. Raises `ConflictError`."""
        self._advance(now_s)
        self._require_under_way(leg)
        self._apply(StopBegun(leg.robot), f"{leg.robot} is at {leg.place}", set(), own=leg.booking)
        self._settle()

    def ended(self, leg: Leg, end: LegEnd, now_s: float) -> None:
        """What became of a leg. Raises `ConflictError` where it is none that is under way."""
        self._advance(now_s)
        self._require_under_way(leg)
        at = leg.place if end.at is None else self.building.find(end.at)
        lost = end.outcome is LegOutcome.ITEM_LOST and self._fleet.items[leg.booking].under_way
        if lost:
            why = f"it was gone when {leg.robot} was to {leg.action} it: {end.reason or 'lost'}"
            self._free(leg, at, self._fleet.now_s, f"{leg.robot} does not have '{leg.booking}'")
            self._lose(self._bookings[leg.booking], why)
        elif end.outcome is LegOutcome.DONE and self._is_possible(leg):
            closes = leg.request.is_visit
            what = f"{leg.robot} is done with '{leg.booking}' at {leg.place}"
            self._apply(StopMade(leg.robot, closes), what, set(), own=leg.booking)
            self._bookings[leg.booking].attempts = 0
        elif self._fleet.robots[leg.robot].held and end.outcome is not LegOutcome.DONE:
            self._failed(leg, end, at)
        else:
            self._free(leg, at, self._fleet.now_s, f"{leg.robot} has broken off '{leg.booking}'")
        self._under_way.pop(leg.robot, None)
        self._settle()

    def item_lost(self, name: str, reason: str, now_s: float) -> None:
        """What was on its way for a request is gone. Raises `ConflictError` where it was not."""
        self._advance(now_s)
        booking = self._open_booking(name)
        self._lose(booking, reason)
        self._settle()

    def fetched(self, name: str, now_s: float) -> None:
        """A person took what a robot had for a request, or what lay somewhere.

        Raises `ConflictError` where there is no such thing.
        """
        self._advance(now_s)
        if name not in self._bookings:
            raise NotFoundError(f"there is no request '{name}'")
        why = f"a person took what was to be brought for '{name}'"
        self._apply(Fetched(name), why, {name})
        if self._bookings[name].open:
            self._bookings[name].reason = why
        self._settle()

    # --- what happens to robots and ways ----------------------------------------------------------

    def robot_failed(
        self, robot: str, at: str | None, reason: str, now_s: float, *, lost: Iterable[str] = ()
    ) -> None:
        """A robot works no more and stands at a place (None: where it should be by now); others
        fetch what it has, but what is `lost` with it. Its leg has ended with that.

        Raises `ConflictError` where it works no more already, `NotFoundError`.
        """
        self._advance(now_s)
        where = None if at is None else self.building.find(at)
        missing = frozenset(lost)
        self._apply(RobotFailed(robot, missing, where), f"{robot} has failed: {reason}", missing)
        for name in missing:
            self._bookings[name].reason = f"it was lost with {robot}: {reason}"
        self._under_way.pop(robot, None)
        self._settle()

    def robot_back(self, robot: str, at: str, now_s: float) -> None:
        """A robot works again, at a place. Raises `ConflictError`, `NotFoundError`."""
        self._advance(now_s)
        self._apply(RobotBack(robot, self.building.find(at)), f"{robot} works again", set())
        self._settle()

    def found(self, found: Found, now_s: float) -> None:
        """A robot has found a way blocked, or a door closed, which counts for a while; or open.

        Raises `WrongInputError` where the places are no neighbours.
        """
        self._advance(now_s)
        a, b = (self.building.find(each) for each in found.between)
        by = "somebody" if found.by is None else found.by
        if found.finding is Finding.OPEN:
            self._apply(WayOpen((a, b)), f"{by} found the way between {a} and {b} open", set())
        else:
            now_s = self._fleet.now_s
            until_s = now_s + self.policy.forget_s if found.until_s is None else found.until_s
            until_s = REOPENS_EVERY_S * ceil(max(until_s, now_s + 1.0) / REOPENS_EVERY_S)
            what = "a closed door" if found.finding is Finding.DOOR_CLOSED else "the way blocked"
            why = f"{by} found {what} between {a} and {b}, which counts until {until_s:g} s"
            self._apply(DoorClosed((a, b), until_s - now_s), why, set())
        self._settle()

    # --- what is known ----------------------------------------------------------------------------

    @property
    def now_s(self) -> float:
        """The latest time that was told."""
        return self._fleet.now_s

    @property
    def fleet(self) -> RunningFleet:
        """The plan, the robots and the items, to be read only."""
        return self._fleet

    @property
    def log(self) -> Sequence[PlanChange]:
        """Why the plan became another one, the latest last."""
        return self._log.changes

    def closed_until_s(self) -> Mapping[frozenset[str], float]:
        """The ways that were found blocked or closed, and until when that counts."""
        return self._fleet.closed_until_s()

    def views(self) -> list[RequestView]:
        """All requests that are known, in the order in which they came."""
        stops = self._stops_by_booking()
        return [self._view(booking, stops) for booking in self._bookings.values()]

    def view(self, name: str) -> RequestView:
        """How far a request has come. Raises `NotFoundError`."""
        if name not in self._bookings:
            raise NotFoundError(f"there is no request '{name}'")
        return self._view(self._bookings[name], self._stops_by_booking())

    def expected(self, name: str) -> Expected | None:
        """When it is begun and done; None where it is in no plan. Raises `NotFoundError`."""
        return self.view(name).expected

    def wakes_s(self) -> float | None:
        """When `legs_to_begin` has to be asked again, if nothing happens before."""
        robots = self._fleet.robots
        times = [
            max(
                robots[robot].free_s,
                self._fleet.leaves_s(robot, stops[0]) - self.policy.reserve_s,
            )
            for robot, stops in self._fleet.stops().items()
            if stops and self._may_set_out(robot, stops[0])
        ]
        times += self.closed_until_s().values()
        times += [
            series.request.occurrence(series.booked + 1).earliest_s - self.policy.horizon_s
            for series in self._series.values()
            if not series.over
        ]
        if any(booking.put_off_since_s is not None for booking in self._bookings.values()):
            times.append(self._tried_s + self.policy.retry_waiting_s)
        return max(self.now_s, min(times)) if times else None

    # --- booking ----------------------------------------------------------------------------------

    def _require_free(self, name: str) -> None:
        booking = self._bookings.get(name) or self._bookings.get(f"{name}/1")
        refused = booking is not None and booking.status is RequestStatus.REFUSED
        if (booking is not None and not refused) or name in self._series:
            raise ConflictError(f"there is a request '{name}' already")

    def _open_booking(self, name: str) -> Booking:
        booking = self._bookings.get(name)
        if booking is None:
            raise NotFoundError(f"there is no request '{name}'")
        if not booking.open:
            raise ConflictError(f"the request '{name}' is {booking.status}")
        return booking

    def _occurrences(self, name: str) -> list[Booking]:
        return [each for key, each in self._bookings.items() if key.split("/", 1)[0] == name]

    def _item(self, name: str, request: AnyRequest) -> Item:
        item = request.item(name, self._terms)
        if request.latest_s is None:
            begins_s = max(self._fleet.now_s, request.earliest_s)
            item = bounded(item, begins_s + self.policy.longest_s)
        return item

    def _book(self, name: str, request: AnyRequest) -> Answer:
        if name in self._fleet.items:
            self._fleet.forget_closed()
        booking = Booking(name, request)
        answer = self._take_on(self._fleet, self._item(name, request), f"'{name}' is asked for")
        self._bookings.pop(name, None)
        self._bookings[name] = booking
        if answer is not None:
            booking.status, booking.reason = RequestStatus.REFUSED, answer.why
            booking.closed_s = self._fleet.now_s
            return answer
        self._settle()
        return Answer(True, self.expected(name))

    def _take_on(self, fleet: RunningFleet, item: Item, why: str) -> Answer | None:
        """Go on as that fleet with one more item. Where it has no place, stay as it is, and say why
        and when it would have one."""
        trial, policy = fleet.fork(), self.policy
        with _refusing():
            outcome = trial.apply(NewItem(item), trial.now_s)
        refused = outcome.refused.get(item.name)
        if refused is None:
            with self._log.entry(lambda: self._fleet, why, {item.name}) as outcomes:
                outcomes.append(outcome)
                self._fleet = trial
            return None
        window = next_possible(fleet, item, longest_s=policy.longest_s, grace_s=policy.grace_s)
        return Answer(False, None, refused, window)

    def _cancel(self, booking: Booking) -> None:
        item = self._fleet.items[booking.name]
        if item.withdrawn or booking.status is RequestStatus.RETURNING:
            raise ConflictError(f"the request '{booking.name}' is cancelled already")
        booking.reason = "it was cancelled"
        self._give_up(booking, f"'{booking.name}' was cancelled")
        self._settle()

    def _book_recurring(self) -> None:
        """Book what recurs as far ahead as is planned."""
        for series in self._series.values():
            while not series.over:
                if not series.request.recurs(series.booked + 1):
                    series.over = True
                    break
                request = series.request.occurrence(series.booked + 1)
                if series.is_missed(self._fleet.now_s):
                    series.booked += 1
                    continue
                if request.earliest_s > self._fleet.now_s + self.policy.horizon_s:
                    break
                name = series.next_name()
                series.booked += 1
                self._book(name, request)

    # --- legs -------------------------------------------------------------------------------------

    def _due_leg(self, robot: str, stops: Sequence[NextStop]) -> Leg | None:
        if not stops or not self._may_set_out(robot, stops[0]):
            return None
        now_s, free_s = self._fleet.now_s, self._fleet.robots[robot].free_s
        if max(free_s, self._fleet.leaves_s(robot, stops[0]) - self.policy.reserve_s) > now_s:
            return None
        return self._leg(robot, stops[0])

    def _may_set_out(self, robot: str, stop: NextStop) -> bool:
        """Whether it does nothing, and nobody still does something with the item that is to be
        broken off."""
        if robot in self._under_way:
            return False
        return not any(
            leg.booking == stop.item and not self._fleet.robots[other].held
            for other, leg in self._under_way.items()
        )

    def _leg(self, robot: str, stop: NextStop) -> Leg:
        request, item = self._bookings[stop.item].request, self._fleet.items[stop.item]
        not_before_s = 0.0
        if stop.action is Action.PICK:
            waits = item.state is ItemState.WAITING
            not_before_s = item.item.pickup.window.earliest_s if waits else item.ready_s
        elif stop.action is Action.DROP:
            not_before_s = item.item.delivery.window.earliest_s
        return Leg(
            robot=robot,
            number=self._begun.get(robot, 0) + 1,
            action=_leg_action(request, item, stop.action),
            place=stop.place,
            booking=stop.item,
            request=request,
            begins_s=stop.begin_s,
            done_s=stop.done_s,
            not_before_s=not_before_s,
            waits_for=stop.partner if stop.action is Action.TAKE else None,
        )

    def _require_under_way(self, leg: Leg) -> None:
        now = self._under_way.get(leg.robot)
        if now is None or not now.is_same(leg):
            raise ConflictError(
                f"robot '{leg.robot}' is not under way to {leg.action} '{leg.booking}'"
            )

    def _is_possible(self, leg: Leg) -> bool:
        """Whether what is said to be done can have been: the item is not gone meanwhile.

        Raises `ConflictError` for what was not given yet.
        """
        item = self._fleet.items.get(leg.booking)
        if item is None or not (item.open or item.withdrawn):
            return False
        if leg.action is LegAction.TAKE and not self._fleet.is_there(leg.robot):
            raise ConflictError(f"'{leg.booking}' cannot be taken: it was not left at {leg.place}")
        return True

    def _free(self, leg: Leg, at: str, again_s: float | None, why: str) -> None:
        self._apply(StopFailed(leg.robot, at, again_s), why, set(), own=leg.booking)

    def _failed(self, leg: Leg, end: LegEnd, at: str) -> None:
        """A leg that is still wanted was not done: try again later, or give up."""
        booking, item = self._bookings[leg.booking], self._fleet.items[leg.booking]
        what = f"{leg.robot} could not {leg.action} '{leg.booking}' at {leg.place}"
        said = f"{what}: {end.reason or end.outcome}"
        booking.reason, waits = said, item.state is ItemState.WAITING
        now_s = self._fleet.now_s
        withdrawn = end.outcome is LegOutcome.WITHDRAWN
        booking.attempts += not withdrawn
        again_s = now_s if withdrawn else now_s + self.policy.retry_after_s
        goes_on = end.outcome is not LegOutcome.ITEM_LOST
        if waits and again_s > item.item.pickup.window.latest_s:
            booking.reason = f"{said}; there is no time to try it again"
        elif goes_on and booking.attempts < self.policy.max_attempts:
            self._free(leg, at, again_s, f"{said}; it is tried again at {again_s:g} s")
            return
        booking.fails = True
        self._free(leg, at, None if waits else now_s, said)
        if not waits:
            self._give_up(booking, said)

    def _lose(self, booking: Booking, reason: str) -> None:
        self._apply(ItemLost(booking.name), f"'{booking.name}' is lost: {reason}", {booking.name})
        booking.reason = f"it is lost: {reason}"

    def _give_up(self, booking: Booking, why: str) -> None:
        """Nothing more is tried; what was fetched goes back, or stays where it is for a person."""
        item, name = self._fleet.items[booking.name], booking.name
        if not item.under_way or (booking.request.comes_back and not item.returns):
            self._apply(Cancelled(name), why, {name})
            booking.attempts = 0
            return
        self._strand(booking, why)

    def _strand(self, booking: Booking, why: str) -> None:
        """No robot does any more: a thing stays where it is, a person is on their own."""
        where, name = self._where(self._fleet.items[booking.name]), booking.name
        if booking.request.comes_back:
            self._apply(Stranded(name), why, {name})
            booking.reason = f"{booking.reason or why}; it is {where}, for a person to take it"
        else:
            self._apply(Fetched(name), why, {name})

    def _where(self, item: TrackedItem) -> str:
        if item.robot is not None:
            return f"aboard {self.setting.robots[item.robot].name}"
        assert item.place is not None, "it lies somewhere"
        return f"at {self.building.graph.places[item.place].name}"

    # --- time goes by -----------------------------------------------------------------------------

    def _advance(self, now_s: float) -> None:
        """Let time pass; what waits is tried again, and given up where its time is over."""
        if not self._fleet.now_s - IN_TIME_S <= now_s < inf:
            raise WrongInputError(f"it is {self._fleet.now_s:g} s already, not {now_s:g} s")
        with self._log.entry(lambda: self._fleet, "what was planned is late", ()) as outcomes:
            outcomes.append(self._fleet.advance(now_s))
        waiting = any(each.put_off_since_s is not None for each in self._bookings.values())
        if waiting and self._fleet.now_s >= self._tried_s + self.policy.retry_waiting_s:
            self._tried_s = self._fleet.now_s
            self._apply(TimePassed(), "what had no place is tried again", set())
        self._settle()
        for booking in [each for each in self._bookings.values() if each.open]:
            self._end_patience(booking)
        self._book_recurring()
        self._forget()

    def _end_patience(self, booking: Booking) -> None:
        since_s, now_s = booking.put_off_since_s, self._fleet.now_s
        # What a robot does with it just now still counts.
        if since_s is None or any(leg.booking == booking.name for leg in self.legs_under_way()):
            return
        item = self._fleet.items[booking.name]
        over = not item.under_way and item.item.pickup.window.latest_s < now_s
        if not over and now_s - since_s < self.policy.patience_s:
            return
        booking.fails = True
        if item.under_way:
            booking.reason = item.put_off
            self._strand(booking, f"nobody can bring '{booking.name}'")
        else:
            self._give_up(booking, f"nobody had a place for '{booking.name}' in time")
        self._settle()

    def _forget(self) -> None:
        if sum(not each.open for each in self._fleet.items.values()) >= CLOSED_ITEMS:
            self._fleet.forget_closed()
        closed = [name for name, each in self._bookings.items() if not each.open]
        if len(closed) > self.policy.kept:
            items = self._fleet.items
            stranded = {n for n, item in items.items() if item.state is ItemState.STRANDED}
            for name in closed[: len(closed) - self.policy.kept]:
                if name not in stranded:
                    del self._bookings[name]
        for name in [name for name, each in self._series.items() if each.over]:
            if not self._occurrences(name):
                del self._series[name]

    # --- one event --------------------------------------------------------------------------------

    def _apply(
        self, event: Event, why: str, requests: Iterable[str], *, own: str | None = None
    ) -> None:
        """Let the fleet know; `own`: what goes on as planned with that event."""
        with (
            _refusing(),
            self._log.entry(lambda: self._fleet, why, requests, own=own) as outcomes,
        ):
            outcomes.append(self._fleet.apply(event, self._fleet.now_s))

    def _settle(self) -> None:
        """Let every open booking follow its item."""
        items = self._fleet.items
        about_to = {leg.booking for leg in self._under_way.values()}
        for booking in self._bookings.values():
            if booking.open:
                booking.follow(items[booking.name], booking.name in about_to, self._fleet.now_s)

    def _stops_by_booking(self) -> dict[str, list[tuple[str, NextStop]]]:
        found: dict[str, list[tuple[str, NextStop]]] = {}
        for robot, stops in self._fleet.stops().items():
            for stop in stops:
                found.setdefault(stop.item, []).append((robot, stop))
        return found

    def _view(
        self, booking: Booking, stops: Mapping[str, Sequence[tuple[str, NextStop]]]
    ) -> RequestView:
        mine = sorted(stops.get(booking.name, ()), key=lambda each: each[1].begin_s)
        expected = None
        if mine and booking.open:
            robot, first = mine[0]
            done_s = mine[0 if booking.request.is_visit else -1][1].done_s
            expected = Expected(robot, first.place, first.begin_s, done_s)
        return RequestView(booking.name, booking.request, booking.status, booking.reason, expected)


def _leg_action(request: AnyRequest, item: TrackedItem, action: Action) -> LegAction:
    match action:
        case Action.GIVE:
            return LegAction.GIVE
        case Action.TAKE:
            return LegAction.TAKE
        case Action.PICK:
            lies = item.state is ItemState.LEFT and request.comes_back
            return LegAction.TAKE if lies else request.fetching
        case Action.DROP:
            return LegAction.BRING_BACK if item.returns else request.bringing


@contextmanager
def _refusing() -> Iterator[None]:
    """What makes no sense to the fleet is refused, in its words."""
    try:
        yield
    except EventError as error:
        raise ConflictError(str(error)) from error
