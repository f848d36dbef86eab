"""The runs of a service, for its client: begun, watched and steered."""

from collections.abc import Iterable
from datetime import datetime
from typing import Any, Literal
from uuid import UUID

from pydantic import TypeAdapter

from mend.server.api.issue_summary import IssueSummary
from mend.server.api.statistics_views import Statistics
from mend.server.client_wire import Wire
from mend.server.journal.events import (
    AnyEvent,
    Event,
    RecordingBegun,
)
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.steering_views import AnySteering, NodeSteeringView, SteeringView
from mend.server.runtime.views import (
    LeafSaid,
    RunStatus,
    RunSummary,
    RunView,
)
from mend.tasks.intervention import Intervention

_events: TypeAdapter[Any] = TypeAdapter(list[AnyEvent])


class RunCalls(Wire):
    """Begins runs, reads what becomes of them, and steers them."""

    async def start_run(self, request: RunRequest) -> RunSummary:
        return await self._post("/api/runs", RunSummary, request.model_dump(mode="json"))

    async def runs(
        self,
        *,
        limit: int = 100,
        offset: int = 0,
        before: UUID | None = None,
        status: Iterable[RunStatus] = (),
    ) -> list[RunSummary]:
        """Runs, newest first; only those that began before another, for the next page.

        `status`: only runs in one of these states, if any is given.
        """
        last = None if before is None else str(before)
        states = [each.value for each in status]
        return await self._get(
            "/api/runs", list[RunSummary], limit=limit, offset=offset, before=last, status=states
        )

    async def issues(
        self,
        *,
        text: str | None = None,
        since: datetime | None = None,
        until: datetime | None = None,
        before: int | None = None,
        limit: int = 100,
    ) -> list[IssueSummary]:
        """Issues of all runs, newest first; those before a `seq`, for the next page.

        `text` is contained in what the issue, its part, place, robot, leaf or tree is called.
        """
        moments = {"since": since, "until": until}
        return await self._get(
            "/api/issues",
            list[IssueSummary],
            text=text,
            before=before,
            limit=limit,
            **{name: each.isoformat() for name, each in moments.items() if each is not None},
        )

    async def statistics(
        self,
        *,
        since: datetime | None = None,
        until: datetime | None = None,
        tree: str | None = None,
        robot: str | None = None,
    ) -> Statistics:
        """How often what went wrong in the runs that began in a span, of a tree or a robot."""
        moments = {"since": since, "until": until}
        return await self._get(
            "/api/statistics",
            Statistics,
            tree=tree,
            robot=robot,
            **{name: each.isoformat() for name, each in moments.items() if each is not None},
        )

    async def run_report(self, run: UUID) -> bytes:
        """The report of a run, so far, as HTML."""
        return (await self._request("GET", f"/api/runs/{run}/report")).content

    async def run_export(self, run: UUID, form: Literal["csv", "mcap"]) -> bytes:
        """A run so far as a file for other programs."""
        return (await self._request("GET", f"/api/runs/{run}/export?format={form}")).content

    async def run(self, run: UUID) -> RunView:
        return await self._get(f"/api/runs/{run}", RunView)

    async def pause(self, run: UUID) -> RunSummary:
        return await self._post(f"/api/runs/{run}/pause", RunSummary)

    async def resume(self, run: UUID) -> RunSummary:
        return await self._post(f"/api/runs/{run}/resume", RunSummary)

    async def abort(self, run: UUID) -> RunSummary:
        return await self._post(f"/api/runs/{run}/abort", RunSummary)

    async def events(self, run: UUID, *, after: int = 0, limit: int = 100) -> list[Event]:
        """A page of a run's events with `seq` > `after`, in order; only the last one is empty."""
        response = await self._request(
            "GET", f"/api/runs/{run}/events", params={"after": after, "limit": limit}
        )
        events: list[Event] = _events.validate_json(response.content)
        return events

    async def camera(self, run: UUID, camera: str) -> bytes:
        """What a camera sees now, as JPEG."""
        return (await self._request("GET", f"/api/runs/{run}/cameras/{camera}")).content

    async def record(self, run: UUID, seconds: float, helper: str) -> RecordingBegun:
        """Have all cameras of a run recorded for so long, in real time."""
        body = {"seconds": seconds, "helper": helper}
        return await self._post(f"/api/runs/{run}/recordings", RecordingBegun, body)

    async def take_leaf(self, run: UUID, node: str, helper: str) -> RunSummary:
        """Have a leaf be a person's, who does it themselves; a robot that sees it done says so."""
        body = {"node": node, "helper": helper}
        return await self._post(f"/api/runs/{run}/leaves/take", RunSummary, body)

    async def give_leaf_back(self, run: UUID, node: str, helper: str) -> RunSummary:
        """Have it be anybody's again."""
        body = {"node": node, "helper": helper}
        return await self._post(f"/api/runs/{run}/leaves/give_back", RunSummary, body)

    async def say_of_leaf(self, run: UUID, words: str, helper: str) -> LeafSaid:
        """Either of these in plain words: "I do the saucer", "I give the saucer back"."""
        body = {"words": words, "helper": helper}
        return await self._post(f"/api/runs/{run}/leaves/say", LeafSaid, body)

    async def intervene(self, run: UUID, intervention: Intervention) -> Intervention:
        """Have a person do something in a simulated world."""
        body = intervention.model_dump(mode="json")
        return await self._post(f"/api/runs/{run}/interventions", Intervention, body)

    async def steering(self, run: UUID) -> SteeringView:
        """How a run is steered: breakpoints, what is next, its autonomy, and what waits."""
        return await self._get(f"/api/runs/{run}/steering", SteeringView)

    async def steering_offers(self, run: UUID, node: str) -> NodeSteeringView:
        """What may be said of a node now, and why the rest may not."""
        return await self._get(f"/api/runs/{run}/steering/offers", NodeSteeringView, node=node)

    async def steer(self, run: UUID, wish: AnySteering, helper: str) -> SteeringView:
        """Say what is to be of a node, or how much the robots may do without being asked."""
        body = {**wish.model_dump(mode="json"), "helper": helper}
        return await self._post(f"/api/runs/{run}/steering", SteeringView, body)
