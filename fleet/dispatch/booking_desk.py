"""What people ask: booked, refused with the next possible time, changed or cancelled."""

from collections.abc import Iterable, Sequence

from mend.errors import ConflictError, WrongInputError
from mend.fleet.dispatch.booking import Answer, AnyRequest, Booking, Expected, Series
from mend.fleet.dispatch.closed_words import with_closed
from mend.fleet.dispatch.dispatch_state import DispatchState, refusing
from mend.fleet.dispatch.giving_up import GivingUp
from mend.fleet.dispatch.next_possible import bounded, next_possible
from mend.fleet.dispatch.recurring import Recurring
from mend.fleet.dispatch.views import stops_by_booking, view_of
from mend.fleet.requests import RequestStatus
from mend.fleet.scheduling.problem import Item
from mend.fleet.scheduling.replanning.events import Cancelled, NewItem, NewItems
from mend.fleet.scheduling.replanning.running_fleet import RunningFleet


class BookingDesk:
    """Takes requests on, one by one and as they recur."""

    def __init__(self, state: DispatchState, giving_up: GivingUp, recurring: Recurring) -> None:
        self._state, self._giving_up, self._recurring = state, giving_up, recurring

    def submit(self, request: AnyRequest) -> Answer:
        """Book a request, or the first occurrence of one that recurs, or refuse it."""
        if request.recurrence is None:
            return self._book(request.name, request)
        series = Series(request)
        answer = self._book(series.next_name(), request.occurrence(1))
        if answer.booked:
            series.booked = 1
            self._state.series[request.name] = series
            self.book_recurring()
        return answer

    def cancel(self, name: str) -> None:
        """What is asked for under a name is not wanted any more; what is fetched goes back.

        Of a request that recurs all that is still open goes. Raises `NotFoundError`, and
        `ConflictError` where it is over.
        """
        series = self._state.series.get(name)
        if series is None:
            self._cancel(self._state.open_booking(name))
            return
        left = [
            each
            for each in self._state.occurrences(name)
            if each.open
            and each.status is not RequestStatus.RETURNING
            and not self._state.fleet.items[each.name].withdrawn
        ]
        if series.over and not left:
            raise ConflictError(f"the request '{name}' is over")
        series.over = True
        for booking in left:
            self._cancel(booking)

    def change(self, name: str, request: AnyRequest) -> Answer:
        """Book other words for what nobody has set out for yet; refused, it stays as it was.

        One occurrence of a series keeps its time, unless another is given. Raises `NotFoundError`,
        and `ConflictError` where it is too late or it recurs.
        """
        if name in self._state.series or request.recurrence is not None:
            raise ConflictError(
                f"the request '{name}' recurs: change one occurrence, or cancel it and ask anew"
            )
        if request.name != name.split("/", 1)[0]:
            raise WrongInputError(
                f"what is changed keeps its name: '{name.split('/', 1)[0]}', not '{request.name}'"
            )
        for place in request.places:
            self._state.building.find(place)
        booking = self._state.open_booking(name)
        if booking.status not in (RequestStatus.BOOKED, RequestStatus.WAITING):
            raise ConflictError(
                f"the request '{name}' is {booking.status.words}: too late to change it"
            )
        if name.partition("/")[0] in self._state.series:
            request = _at_its_time(request, booking.request)
        without = self._state.fleet.fork()
        without.apply(Cancelled(name), without.now_s)
        without.forget_closed()
        answer = self._take_on(without, self._item(name, request), f"'{name}' is wanted otherwise")
        if answer is None:
            booking.request, booking.attempts, booking.reason = request, 0, None
        return answer or self._promised(name)

    def require_free(self, name: str) -> None:
        """Raises `ConflictError` where there is something of that name that was not refused."""
        booking = self._state.bookings.get(name) or self._state.bookings.get(f"{name}/1")
        refused = booking is not None and booking.status is RequestStatus.REFUSED
        if (booking is not None and not refused) or name in self._state.series:
            raise ConflictError(f"there is a request '{name}' already")

    def book_recurring(self) -> None:
        """Book what recurs as far ahead as is planned, all at once: each by itself would take as
        long as all. Of much the rest is booked at the next call."""
        lot, state = self._recurring.next_lot(), self._state
        if not lot:
            return
        if any(name in state.fleet.items for name, _ in lot):
            state.fleet.forget_closed()
        names = [name for name, _ in lot]
        items = tuple(self._item(name, request) for name, request in lot)
        refused = state.apply(NewItems(items), _asked_for(names), names).refused
        for name, request in lot:
            booking = Booking(name, request)
            state.bookings.pop(name, None)
            state.bookings[name] = booking
            if name in refused:
                self._refuse(booking, self._closed_told(refused[name]))
        self._promise([name for name in names if name not in refused])

    def _item(self, name: str, request: AnyRequest) -> Item:
        item = request.item(name, self._state.terms)
        if request.latest_s is None:
            begins_s = max(self._state.fleet.now_s, request.earliest_s)
            item = bounded(item, begins_s + self._state.policy.longest_s)
        return item

    def _book(self, name: str, request: AnyRequest) -> Answer:
        if name in self._state.fleet.items:
            self._state.fleet.forget_closed()
        booking = Booking(name, request)
        answer = self._take_on(
            self._state.fleet, self._item(name, request), f"'{name}' is asked for"
        )
        self._state.bookings.pop(name, None)
        self._state.bookings[name] = booking
        if answer is not None:
            self._refuse(booking, answer.why)
            return answer
        return self._promised(name)

    def _promised(self, name: str) -> Answer:
        """It is booked, with when it is expected, which is kept to from now on."""
        return Answer(True, self._promise([name])[name])

    def _promise(self, names: Iterable[str]) -> dict[str, Expected | None]:
        """When each of what is booked is expected, which is kept to from now on."""
        self._state.settle()
        stops, promised = stops_by_booking(self._state.fleet), dict[str, Expected | None]()
        for name in names:
            expected = view_of(self._state.bookings[name], stops).expected
            promised[name] = expected
            if expected is not None:
                self._state.fleet.promise(name, expected.done_s + self._state.policy.slack_s)
        return promised

    def _refuse(self, booking: Booking, why: str | None) -> None:
        booking.status, booking.reason = RequestStatus.REFUSED, why
        booking.closed_s = self._state.fleet.now_s

    def _take_on(self, fleet: RunningFleet, item: Item, why: str) -> Answer | None:
        """Go on as that fleet with one more item. Where it has no place, stay as it is, and say why
        and when it would have one."""
        trial, policy = fleet.fork(), self._state.policy
        with refusing():
            outcome = trial.apply(NewItem(item), trial.now_s)
        refused = outcome.refused.get(item.name)
        if refused is None:
            with self._state.log.entry(lambda: self._state.fleet, why, {item.name}) as outcomes:
                outcomes.append(outcome)
                self._state.fleet = trial
            return None
        window = next_possible(fleet, item, longest_s=policy.longest_s, grace_s=policy.grace_s)
        return Answer(False, None, self._closed_told(refused), window)

    def _closed_told(self, why: str) -> str:
        return with_closed(why, self._state.building, self._state.fleet.closed_until_s())

    def _cancel(self, booking: Booking) -> None:
        item = self._state.fleet.items[booking.name]
        if item.withdrawn or booking.status is RequestStatus.RETURNING:
            raise ConflictError(f"the request '{booking.name}' is cancelled already")
        booking.reason = "it was cancelled"
        self._giving_up.give_up(booking, f"'{booking.name}' was cancelled")
        self._state.settle()


def _asked_for(names: Sequence[str]) -> str:
    if len(names) == 1:
        return f"'{names[0]}' is asked for"
    if len(names) == 2:
        return f"'{names[0]}' and '{names[1]}' are asked for"
    return f"'{names[0]}', '{names[1]}' and {len(names) - 2} more are asked for"


def _at_its_time(request: AnyRequest, before: AnyRequest) -> AnyRequest:
    """As it is asked for now, at the time of before where none is given."""
    given = request.model_fields_set
    if "earliest_s" in given:
        return request
    latest_s = request.latest_s if "latest_s" in given else before.latest_s
    if latest_s is not None and latest_s <= before.earliest_s:
        raise WrongInputError(
            f"latest_s must be after the {before.earliest_s:g} s from which it is wanted, "
            f"unless another earliest_s is given, but it is {latest_s:g} s"
        )
    return request.model_copy(update={"earliest_s": before.earliest_s, "latest_s": latest_s})
