"""A request that was taken or refused, and how far it has come."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from mend.fleet.requests import STATUS, DeliverMessage, Escort, GoToRoom, RequestStatus, Transport
from mend.fleet.scheduling.problem import Window
from mend.fleet.scheduling.replanning.item_state import ItemState, TrackedItem
from mend.fleet.scheduling.replanning.transfer_saving import TransferSaving

AnyRequest = GoToRoom | DeliverMessage | Escort | Transport


@dataclass(slots=True)
class Booking:
    """One request, or one occurrence of one that recurs, under a name.

    `reason`: why it is not going as it was asked, or what is known of how it was done;
    `attempts`: how often its stop failed; `put_off_since_s`: since when it has no place in the
    plan; `fails`: it is on its way to `failed`, not to `cancelled`.
    """

    name: str
    request: AnyRequest
    status: RequestStatus = RequestStatus.BOOKED
    reason: str | None = None
    attempts: int = 0
    put_off_since_s: float | None = None
    fails: bool = False
    closed_s: float | None = None

    @property
    def open(self) -> bool:
        """Whether anything remains to be done for it."""
        return not STATUS.is_last(self.status)

    def become(self, status: RequestStatus, now_s: float) -> None:
        """Go on. Raises `IllegalTransitionError`."""
        if status is self.status:
            return
        self.status = STATUS.require(self.status, status)
        if not self.open:
            self.closed_s, self.put_off_since_s = now_s, None

    def follow(self, item: TrackedItem, about_to: bool, now_s: float) -> None:
        """Take over how far the item has come; `about_to`: a robot has set out for it."""
        status = self._status(item, about_to)
        if item.put_off is not None:
            since_s = self.put_off_since_s
            self.put_off_since_s = now_s if since_s is None else since_s
            # Why it goes back, or fails, stays true however long that takes.
            self.reason = self.reason if item.returns or self.fails else item.put_off
        elif self.put_off_since_s is not None:
            goes_on = item.open and not item.returns and not self.fails
            self.reason = None if goes_on else self.reason
            self.put_off_since_s = None
        self.become(status, now_s)

    def _status(self, item: TrackedItem, about_to: bool) -> RequestStatus:
        match item.state:
            case ItemState.WAITING:
                if about_to:
                    return RequestStatus.UNDER_WAY
                return RequestStatus.WAITING if item.put_off else RequestStatus.BOOKED
            case ItemState.ABOARD | ItemState.LEFT:
                return RequestStatus.RETURNING if item.returns else RequestStatus.UNDER_WAY
            case ItemState.DELIVERED:
                return RequestStatus.DONE
            case ItemState.CANCELLED:
                return RequestStatus.FAILED if self.fails else RequestStatus.CANCELLED
            case ItemState.REFUSED | ItemState.LOST | ItemState.STRANDED:
                return RequestStatus.FAILED


@dataclass(slots=True)
class Series:
    """A request that recurs; `booked`: how many of its occurrences have been asked for so far."""

    request: AnyRequest
    booked: int = 0
    over: bool = False

    def is_missed(self, now_s: float) -> bool:
        """Whether the time of the next occurrence is over, as nobody was there to book it."""
        request = self.request.occurrence(self.booked + 1)
        if request.latest_s is not None:
            return request.latest_s <= now_s
        every = self.request.recurrence
        return every is not None and request.earliest_s + every.every_s <= now_s

    def next_name(self) -> str:
        """The name of the next occurrence."""
        return f"{self.request.name}/{self.booked + 1}"


@dataclass(frozen=True, slots=True)
class Expected:
    """When a request is begun and done, and by whom; `place`: where its next stop is.

    `late_s`: how much later that is than planned, as a robot has not done by now what it was to do
    by then; the times are then the earliest that are left.
    """

    robot: str
    place: str
    begins_s: float
    done_s: float
    late_s: float = 0.0


@dataclass(frozen=True, slots=True)
class Answer:
    """What became of what was asked: booked, with when it is expected; or refused, why, and within
    which other time it could be met just now (None: at no time)."""

    booked: bool
    expected: Expected | None = None
    why: str | None = None
    next_possible: Window | None = None


@dataclass(frozen=True, slots=True)
class RequestView:
    """How far a request has come, for whoever asked."""

    name: str
    request: AnyRequest
    status: RequestStatus
    reason: str | None
    expected: Expected | None


@dataclass(frozen=True, slots=True)
class PlanChange:
    """Why the plan became another one, and whom that touches.

    `said`: by request or robot, a sentence on what cannot be kept. `transfers`: the requests whose
    things change robots now that did not before, or elsewhere, and what that saves.
    """

    number: int
    at_s: float
    reason: str
    requests: tuple[str, ...]
    robots: tuple[str, ...]
    said: Mapping[str, str] = field(default_factory=dict)
    transfers: Mapping[str, TransferSaving] = field(default_factory=dict)
