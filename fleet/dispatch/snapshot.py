"""What a dispatcher knows, as a strict document from which an equal one is made."""

from mend.documents.strict_model import StrictModel
from mend.fleet.dispatch.booking import Booking, PlanChange, Series
from mend.fleet.dispatch.fleet_snapshot import FleetSnapshot, Number
from mend.fleet.dispatch.leg import Leg
from mend.fleet.requests import Request, RequestStatus


class KeptBooking(StrictModel):
    """A booking."""

    name: str
    request: Request
    status: RequestStatus
    reason: str | None
    attempts: Number
    put_off_since_s: float | None
    fails: bool
    closed_s: float | None

    @classmethod
    def of(cls, booking: Booking) -> "KeptBooking":
        """The same as a document."""
        return cls(**{name: getattr(booking, name) for name in cls.model_fields})

    def booking(self) -> Booking:
        """The same again."""
        return Booking(**{name: getattr(self, name) for name in type(self).model_fields})


class KeptSeries(StrictModel):
    """A request that recurs."""

    request: Request
    booked: Number
    over: bool

    @classmethod
    def of(cls, series: Series) -> "KeptSeries":
        """The same as a document."""
        return cls(request=series.request, booked=series.booked, over=series.over)

    def series(self) -> Series:
        """The same again."""
        return Series(self.request, self.booked, self.over)


class KeptChange(StrictModel):
    """A change of the plan."""

    number: Number
    at_s: float
    reason: str
    requests: tuple[str, ...]
    robots: tuple[str, ...]
    said: dict[str, str]

    @classmethod
    def of(cls, change: PlanChange) -> "KeptChange":
        """The same as a document."""
        values = {name: getattr(change, name) for name in cls.model_fields}
        return cls(**{**values, "said": dict(change.said)})

    def change(self) -> PlanChange:
        """The same again."""
        return PlanChange(**{name: getattr(self, name) for name in type(self).model_fields})


class DispatcherSnapshot(StrictModel):
    """All that a dispatcher knows but its building and its setting."""

    fleet: FleetSnapshot
    bookings: tuple[KeptBooking, ...]
    series: tuple[KeptSeries, ...]
    under_way: tuple[Leg, ...]
    begun: dict[str, Number]
    tried_s: float
    changes: tuple[KeptChange, ...]
    change_count: Number
