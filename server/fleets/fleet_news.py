"""What has become of a fleet's requests and plan since it was last told."""

from collections.abc import Callable
from datetime import datetime
from uuid import UUID

from mend.fleet.dispatch.booking import PlanChange, RequestView
from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.dispatch.leg import Leg, LegEnd
from mend.fleet.requests import RequestStatus
from mend.robots.link.messages import Driven
from mend.server.fleets.fleet_record import Errand
from mend.server.journal import events as ev


class FleetNews:
    """Makes the events of a fleet, each once."""

    def __init__(
        self,
        site: UUID,
        dispatcher: Dispatcher,
        utc_now: Callable[[], datetime],
        now_s: Callable[[], float],
    ) -> None:
        """`now_s`: the site's clock, which the dispatcher only knows as it was told last."""
        self._site = site
        self._now_s = now_s
        self._dispatcher = dispatcher
        self._utc_now = utc_now
        self._told = {each.name: _state(each) for each in dispatcher.views()}
        self._changes = max((each.number for each in dispatcher.log), default=0)

    def since(self, author: ev.Author | None = None, asked: str = "") -> list[ev.Event]:
        """What is new; `author` is who has asked for the request `asked`, or wants it no more."""
        views = {each.name: each for each in self._dispatcher.views()}
        new = [each for each in views.values() if self._told.get(each.name) != _state(each)]
        events: list[ev.Event] = [
            self._request(each, author if each.name.split("/", 1)[0] == asked else None)
            for each in new
        ]
        changes = [each for each in self._dispatcher.log if each.number > self._changes]
        events += [self._change(each) for each in changes]
        self._told = {name: _state(each) for name, each in views.items()}
        self._changes = max((each.number for each in changes), default=self._changes)
        return events

    def told(
        self,
        told: str,
        author: ev.Author | None = None,
        *,
        finder: str | None = None,
        robot: str | None = None,
        in_service: bool | None = None,
    ) -> ev.FleetTold:
        """What an operator, or the robot `finder`, has told.

        `robot`: who is `in_service` now, or no more.
        """
        return ev.FleetTold(
            wall_time=self._utc_now(),
            site=self._site,
            at_s=self._now_s(),
            told=told,
            author=author,
            finder=finder,
            robot=robot,
            in_service=in_service,
        )

    def begun(self, leg: Leg, start: str) -> ev.LegBegun:
        """A robot that stands at `start` is sent to do a leg."""
        return ev.LegBegun(
            wall_time=self._utc_now(),
            site=self._site,
            at_s=self._dispatcher.now_s,
            robot=leg.robot,
            number=leg.number,
            booking=leg.booking,
            action=leg.action,
            place=leg.place,
            start=start,
        )

    def ended(self, leg: Leg, end: LegEnd, driven: Driven | None) -> ev.LegEnded:
        """What became of a leg, and what its robot has driven for it, as far as is known."""
        return ev.LegEnded(
            wall_time=self._utc_now(),
            site=self._site,
            at_s=self._dispatcher.now_s,
            robot=leg.robot,
            number=leg.number,
            booking=leg.booking,
            action=leg.action,
            place=leg.place,
            outcome=end.outcome,
            reason=end.reason,
            at=end.at or leg.place,
            driven_m=None if driven is None else driven.way_m,
            barred_s=None if driven is None else driven.barred_s,
        )

    def errand_begun(self, errand: Errand, start: str, author: ev.Author | None) -> ev.ErrandBegun:
        """A robot that stands at `start` is sent somewhere without a leg."""
        return ev.ErrandBegun(
            wall_time=self._utc_now(),
            site=self._site,
            at_s=self._now_s(),
            robot=errand.robot,
            place=errand.place,
            start=start,
            author=author,
            charges=errand.charges,
        )

    def errand_ended(self, errand: Errand, at: str, reason: str | None) -> ev.ErrandEnded:
        """Where it is then; `reason`: why it has not come to its place."""
        return ev.ErrandEnded(
            wall_time=self._utc_now(),
            site=self._site,
            at_s=self._now_s(),
            robot=errand.robot,
            place=errand.place,
            came=reason is None,
            reason=reason,
            at=at,
        )

    def _request(self, view: RequestView, author: ev.Author | None) -> ev.RequestChanged:
        expected = view.expected
        return ev.RequestChanged(
            wall_time=self._utc_now(),
            site=self._site,
            at_s=self._dispatcher.now_s,
            request=view.name,
            what=view.request.model_dump(mode="json", exclude_none=True),
            status=view.status,
            reason=view.reason,
            robot=None if expected is None else expected.robot,
            done_s=None if expected is None else expected.done_s,
            author=_without_key(author) if view.status is RequestStatus.REFUSED else author,
        )

    def _change(self, change: PlanChange) -> ev.PlanChanged:
        return ev.PlanChanged(
            wall_time=self._utc_now(),
            site=self._site,
            at_s=change.at_s,
            number=change.number,
            reason=change.reason,
            requests=list(change.requests),
            robots=list(change.robots),
            said=dict(change.said),
            transfers=[
                ev.PlannedTransfer(request=name, sooner_s=saving.sooner_s, less_m=saving.less_m)
                for name, saving in change.transfers.items()
            ],
        )


def _without_key(author: ev.Author | None) -> ev.Author | None:
    """What is refused leaves its key free: whoever asks once more is told why again."""
    return None if author is None else ev.Author.model_validate(author.model_dump())


def _state(view: RequestView) -> object:
    """What is told when it has changed."""
    return view.request, view.status, view.reason
