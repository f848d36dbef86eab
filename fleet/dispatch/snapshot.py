"""What a dispatcher knows, as a strict document from which an equal one is made."""

from mend.documents.strict_model import StrictModel
from mend.errors import UnreadableError
from mend.fleet.dispatch.booking import Booking, PlanChange, Series
from mend.fleet.dispatch.dispatch_state import DispatchState
from mend.fleet.dispatch.fleet_snapshot import FleetSnapshot, Number, fleet_snapshot, state_of
from mend.fleet.dispatch.leg import Leg
from mend.fleet.requests import Request, RequestStatus
from mend.fleet.scheduling.checker import ScheduleError
from mend.fleet.scheduling.replanning.events import EventError
from mend.fleet.scheduling.replanning.residual_problem import Building
from mend.fleet.scheduling.replanning.running_fleet import RunningFleet
from mend.fleet.scheduling.replanning.transfer_saving import TransferSaving


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
    transfers: dict[str, TransferSaving] = {}

    @classmethod
    def of(cls, change: PlanChange) -> "KeptChange":
        """The same as a document."""
        values = {name: getattr(change, name) for name in cls.model_fields}
        return cls(**{**values, "said": dict(change.said), "transfers": dict(change.transfers)})

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


def snapshot_of(state: DispatchState) -> DispatcherSnapshot:
    """What a dispatcher knows as a document."""
    return DispatcherSnapshot(
        fleet=fleet_snapshot(state.fleet.state()),
        bookings=tuple(KeptBooking.of(each) for each in state.bookings.values()),
        series=tuple(KeptSeries.of(each) for each in state.series.values()),
        under_way=tuple(state.under_way.values()),
        begun=dict(state.begun),
        tried_s=state.tried_s,
        changes=tuple(KeptChange.of(each) for each in state.log.changes),
        change_count=state.log.count,
    )


def restore(state: DispatchState, snapshot: DispatcherSnapshot) -> None:
    """Make what a new dispatcher knows what a document says.

    Raises `UnreadableError` where the building or its robots are others now.
    """
    problem = state.problem
    about = Building(problem.name, problem.places, problem.transfers, problem.weights)
    try:
        fleet_state = state_of(snapshot.fleet, about, problem.robots, state.ways)
        state.fleet = RunningFleet.resumed(fleet_state)
    except (EventError, ScheduleError) as error:
        raise UnreadableError(f"what was kept does not fit the building: {error}") from error
    state.bookings = {each.name: each.booking() for each in snapshot.bookings}
    state.series = {each.request.name: each.series() for each in snapshot.series}
    state.under_way = {each.robot: each for each in snapshot.under_way}
    state.begun, state.tried_s = dict(snapshot.begun), snapshot.tried_s
    state.log.restore((each.change() for each in snapshot.changes), snapshot.change_count)
