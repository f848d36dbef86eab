"""What recurs: which of its occurrences are to be booked by now, and when the next ones are."""

from collections import Counter
from heapq import heapify, heappop, heappush

from mend.fleet.dispatch.booking import AnyRequest, Booking, Series
from mend.fleet.dispatch.dispatch_state import DispatchState
from mend.fleet.requests import RequestStatus

AT_ONCE = 24
LEAST_AT_ONCE = 4
"""So many occurrences at most are booked in one go, and at least, as far as any are due: those
first that begin first, the rest at the next."""
IN_PLAN = 3000
"""In one go times what is in the plan: each takes the longer the more is planned."""
LEAST_AHEAD = 3
"""So many of each are booked ahead however much else recurs."""
LEAST_BEHIND = 2
"""So many of each may be late before no more of it are booked."""


class Recurring:
    """Looks after the series of a dispatcher. Times are seconds on its clock."""

    def __init__(self, state: DispatchState) -> None:
        self._state = state

    def next_lot(self) -> list[tuple[str, AnyRequest]]:
        """What is to be booked now, under its names, and counts as booked from then on.

        Where too many of a series are late when its next one is due, that one is refused.
        """
        series, now_s = self._running(), self._state.fleet.now_s
        ahead, behind = self._ahead(), self._behind()
        lot: list[tuple[str, AnyRequest]] = []
        queue = [(_begins_s(each), number) for number, each in enumerate(series)]
        heapify(queue)
        most = self._at_once()
        while queue and len(lot) < most:
            _, number = heappop(queue)
            each = series[number]
            if not each.request.recurs(each.booked + 1):
                each.over = True
                continue
            if each.is_missed(now_s):
                pass
            elif self._books_s(each, ahead, behind) > now_s:
                continue
            elif self._is_behind(each, ahead, behind):
                self._refuse(each)
            else:
                lot.append((each.next_name(), each.request.occurrence(each.booked + 1)))
            each.booked += 1
            heappush(queue, (_begins_s(each), number))
        return lot

    def times_s(self) -> list[float]:
        """When the next ones are to be booked, or refused."""
        ahead, behind = self._ahead(), self._behind()
        return [self._books_s(each, ahead, behind) for each in self._running()]

    def _running(self) -> list[Series]:
        return [each for each in self._state.series.values() if not each.over]

    def _at_once(self) -> int:
        planned = sum(each.open for each in self._state.bookings.values())
        return max(LEAST_AT_ONCE, min(AT_ONCE, IN_PLAN // max(1, planned)))

    def _ahead(self) -> int:
        """How many of each series are booked ahead: less than usual where much recurs."""
        policy = self._state.policy
        share = policy.occurrences_in_all // max(1, len(self._running()))
        return min(policy.occurrences, max(LEAST_AHEAD, share))

    def _behind(self) -> Counter[str]:
        """By series, of how many the time has come for which nobody has set out yet."""
        now_s, waits = self._state.fleet.now_s, (RequestStatus.BOOKED, RequestStatus.WAITING)
        return Counter(
            name.partition("/")[0]
            for name, each in self._state.bookings.items()
            if each.status in waits and each.request.earliest_s <= now_s
        )

    def _is_behind(self, series: Series, ahead: int, behind: Counter[str]) -> bool:
        return behind[series.request.name] > max(LEAST_BEHIND, ahead // 2)

    def _books_s(self, series: Series, ahead: int, behind: Counter[str]) -> float:
        recurrence, policy = series.request.recurrence, self._state.policy
        assert recurrence is not None, "it is of a series"
        if self._is_behind(series, ahead, behind):
            return _begins_s(series)
        # A plan that holds a day of what recurs each minute takes minutes to make.
        return _begins_s(series) - min(policy.horizon_s, ahead * recurrence.every_s)

    def _refuse(self, series: Series) -> None:
        name, request = series.next_name(), series.request.occurrence(series.booked + 1)
        booking = Booking(name, request, RequestStatus.REFUSED)
        booking.reason = (
            f"the occurrences of '{series.request.name}' before it are late and nobody has set out "
            "for them yet"
        )
        booking.closed_s = self._state.fleet.now_s
        self._state.bookings[name] = booking


def _begins_s(series: Series) -> float:
    """When the next one is wanted."""
    return series.request.occurrence(series.booked + 1).earliest_s
