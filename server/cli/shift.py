"""A shift in a building: a site of its own, the requests of a file, and what became of them."""

from collections.abc import AsyncIterator, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any, Literal
from uuid import UUID

import typer

from mend.fleet.requests import STATUS, RequestStatus
from mend.server.cli.failures import NOT_FINISHED
from mend.server.cli.local_user import local_author
from mend.server.documents import DocumentKind
from mend.server.fixed_documents import GivenFiles
from mend.server.fleets.request_refused import RequestRefusedError
from mend.server.journal import events as ev
from mend.server.journal.stored_event import read_event
from mend.server.journal.subscriptions import SubscriptionOverflowError
from mend.server.settings import Settings
from mend.server.sites.requests import FleetOptions, SiteRequest
from mend.server.transcript import Tone, Transcript
from mend.tasks.scene import Scene

if TYPE_CHECKING:
    from mend.fleet.dispatch.booking import AnyRequest
    from mend.server.composition import Service

_TOLD = (Tone.FAULT, Tone.SAID, Tone.ASKED, Tone.ANSWERED, Tone.DEED, Tone.SETBACK)
"""Of what robots do in their legs only what is said, and why, is told."""


class Shift:
    """Has the robots of a scene meet requests, and prints what happens."""

    def __init__(
        self,
        scene: Scene,
        requests: Sequence["AnyRequest"],
        *,
        seed: int,
        options: dict[str, Any],
        fleet: FleetOptions,
        speed: float | Literal["max"],
    ) -> None:
        self._scene = scene
        self._requests = requests
        self._site = SiteRequest(
            scene=scene.name,
            world="building",
            speed=speed,
            seed=seed,
            world_options=options,
            fleet=fleet,
        )
        self._open: set[str] = set()
        self._ended: dict[str, str] = {}
        self._transcripts: dict[UUID, tuple[Transcript, float]] = {}
        self._now_s = 0.0

    async def carry_out(self, settings: Settings) -> int:
        """Run it to its end and return the exit code: 0 where everything was done."""
        from mend.server.composition import open_service

        text = self._scene.model_dump_json(exclude_defaults=True)
        given = GivenFiles({DocumentKind.SCENE: {self._scene.name: text}})
        async with open_service(settings, recover=False, given=given) as service:
            site = (await service.sites.open_site(self._site, local_author())).id
            for request in self._requests:
                await self._ask(service, site, request)
            if self._open:
                async for event in _events(service):
                    self._tell(event)
                    if not self._open:
                        break
        return self._sum_up()

    async def _ask(self, service: "Service", site: UUID, request: "AnyRequest") -> None:
        try:
            _, booked = await service.fleets.submit(site, request, local_author())
        except RequestRefusedError as error:
            self._say(f"refused: {error}")
            self._ended[request.name] = "refused"
        else:
            self._open.add(booked.name)

    def _tell(self, event: ev.Event) -> None:
        match event:
            case ev.RequestChanged():
                self._now_s = event.at_s
                self._tell_of_request(event)
            case ev.PlanChanged():
                self._now_s = event.at_s
                others = f" ({', '.join(event.requests)})" if event.requests else ""
                self._say(f"plan {event.number}: {event.reason}{others}")
            case ev.RunStarted():
                self._transcripts[event.run] = Transcript(), self._now_s
                self._say(f"{event.robots[0]} begins to {event.tree_name.replace('_', ' ')}")
            case _ if event.run in self._transcripts:
                transcript, since_s = self._transcripts[event.run]
                for line in transcript.lines(event):
                    if line.tone in _TOLD:
                        self._now_s = max(self._now_s, since_s + line.time_s)
                        by = f"{line.speaker}: " if line.speaker else ""
                        self._say(f"  {by}{line.text}")

    def _tell_of_request(self, event: ev.RequestChanged) -> None:
        by = f" by {event.robot}" if event.robot else ""
        due = f", expected at {event.done_s:.0f} s" if event.done_s is not None else ""
        why = f": {event.reason}" if event.reason else ""
        self._say(f"'{event.request}' is {event.status.replace('_', ' ')}{by}{due}{why}")
        if STATUS.is_last(RequestStatus(event.status)):
            self._open.discard(event.request)
            self._ended[event.request] = event.status

    def _sum_up(self) -> int:
        done = sum(each == RequestStatus.DONE for each in self._ended.values())
        self._say(f"{done} of {len(self._ended)} requests are done")
        return 0 if done == len(self._ended) else NOT_FINISHED

    def _say(self, text: str) -> None:
        typer.echo(f"{self._now_s:8.1f}  {text}")


async def _events(service: "Service") -> AsyncIterator[ev.Event]:
    after = 0
    while True:
        with suppress(SubscriptionOverflowError), service.journal.subscribe(after) as records:
            async for record in records:
                after = record.seq
                yield read_event(record.seq, record.text)
            return
