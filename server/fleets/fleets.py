"""The fleets of all sites: opened with the first request, and there again after a restart."""

import asyncio
import logging
import math
from collections.abc import Callable
from datetime import datetime
from importlib import import_module
from typing import TYPE_CHECKING, Protocol
from uuid import UUID

from pydantic import ValidationError

from mend.errors import ConflictError, NotFoundError
from mend.fleet.requests import STATUS
from mend.robots.link.messages import Poses
from mend.server.fleets.fleet_track import FleetTrack
from mend.server.fleets.runs import Runs
from mend.server.journal.events import Author
from mend.server.journal.journal import Document, Entry, Journal
from mend.server.poses.frame import Frame, time_of
from mend.server.poses.record import PoseRecord
from mend.server.robots.sink import FollowPoses
from mend.server.sites.site import Site
from mend.server.sites.site_record import SiteRecord
from mend.server.sites.sites import Sites

if TYPE_CHECKING:
    from mend.fleet.dispatch.booking import AnyRequest, RequestView
    from mend.server.fleets.fleet_at_work import FleetAtWork
    from mend.server.fleets.fleet_opening import FleetOpener

log = logging.getLogger(__name__)

KIND = "fleet"
"""The kind of document that the journal keeps fleets as; its name is the site's id."""


class SiteRecords(Protocol):
    """Where frames of sites are recorded."""

    def record(self, site: UUID) -> PoseRecord | None: ...

    async def last(self, site: UUID, /) -> Frame | None: ...

    def forget(self, site: UUID, /) -> None: ...


class Fleets:
    """What people ask of the fleets of a service. Raises the errors of `mend.errors`."""

    def __init__(
        self,
        sites: Sites,
        runs: Runs,
        journal: Journal,
        poses: SiteRecords,
        *,
        utc_now: Callable[[], datetime],
        most_open: int,
    ) -> None:
        """`most_open`: so many requests of each fleet may be open."""
        self._sites = sites
        self._runs = runs
        self._journal = journal
        self._poses = poses
        self._utc_now = utc_now
        self._most_open = most_open
        self._fleets: dict[UUID, FleetAtWork] = {}
        self._loading = asyncio.Lock()
        self._opener: FleetOpener | None = None

    # --- Their life ---------------------------------------------------------------------------

    async def recover(self) -> None:
        """Have every fleet go on that had anything to do when the service stopped."""
        for name, text in (await self._journal.documents(KIND)).items():
            try:
                record = self._sites.record(UUID(name))
                await self._open(record, text)
            except (ValidationError, NotFoundError) as error:
                # One fleet that cannot be read must not keep the service from starting.
                log.error("the fleet of site %s cannot go on: %s", name, error)

    async def close(self) -> None:
        """Stop without ending anything."""
        await asyncio.gather(*(each.stop() for each in self._fleets.values()))

    async def close_site(self, site: UUID) -> None:
        """The site is about to be closed. Raises `ConflictError` while requests are open."""
        fleet = self._fleets.get(site)
        if fleet is None:
            return
        views = await fleet.read(lambda all_: all_.views())
        open_ = [each.name for each in views if not STATUS.is_last(each.status)]
        if open_:
            raise ConflictError(
                f"site {site} has open requests, '{open_[0]}' first: cancel them, or wait"
            )
        for errand in fleet.errands.values():
            raise ConflictError(
                f"robot '{errand.robot}' of site {site} is on its way to {errand.place}: wait"
            )
        await self._fleets.pop(site).stop()
        self._sites.site(site).follow_bases(None)
        self._poses.forget(site)
        await self._journal.append(Entry(document=Document(KIND, str(site), None)))

    async def _of(self, site: UUID | None) -> "FleetAtWork":
        """The fleet of a site, or of the only one that has one."""
        record = self._sites.record(site) if site is not None else self._only()
        if record.fleet is None:
            raise ConflictError(
                f"the robots of site {record.site} take no requests: open one with 'fleet'"
            )
        if record.site not in self._fleets:
            await self._open(record)
        return self._fleets[record.site]

    def _only(self) -> SiteRecord:
        with_fleet = [each for each in self._sites.records() if each.fleet is not None]
        if len(with_fleet) == 1:
            return with_fleet[0]
        if not with_fleet:
            raise NotFoundError("no robots take requests here: open a site with 'fleet'")
        ids = ", ".join(str(each.site) for each in with_fleet)
        raise ConflictError(f"robots of several sites take requests: say which 'site' of {ids}")

    async def _open(self, record: SiteRecord, kept: str | None = None) -> None:
        """Have a fleet, as it was `kept`. Raises `ValidationError` for what cannot be read."""
        async with self._loading:
            if self._opener is None:
                # It compiles what plans are made with, which takes long the first time.
                self._opener = await asyncio.to_thread(_load_opener)
            if record.site in self._fleets:
                return
            site = self._sites.site(record.site)
            fleet = self._opener(
                site, record, kept, self._runs, self._journal, self._utc_now, self._most_open
            )
            self._fleets[record.site] = fleet
            site.follow_bases(await self._followed(site, fleet))
            fleet.start()

    async def _followed(self, site: Site, fleet: "FleetAtWork") -> FollowPoses:
        """What is told where robots are: the fleet, and what keeps it if that is to be kept."""
        last = await self._poses.last(site.id)
        record = self._poses.record(site.id)
        if record is None:
            return fleet.saw
        since_s = -math.inf if last is None else time_of(last)
        track = FleetTrack(site.frames, record, since_s)

        def take(robot: str, poses: Poses) -> None:
            track.take(robot, poses)
            fleet.saw(robot, poses)

        return take

    # --- What people ask ----------------------------------------------------------------------

    async def submit(
        self, site: UUID | None, request: "AnyRequest", author: Author | None
    ) -> "tuple[UUID, RequestView]":
        """Book a request; where, and how far it is. Raises `RequestRefusedError` and others."""
        fleet = await self._of(site)
        return fleet.site, await fleet.requesters.submit(request, author)

    async def change(
        self, site: UUID | None, name: str, request: "AnyRequest", author: Author | None
    ) -> "tuple[UUID, RequestView]":
        """Other words for a request that nobody has set out for."""
        fleet = await self._of(site)
        return fleet.site, await fleet.requesters.change(name, request, author)

    async def cancel(self, site: UUID | None, name: str, author: Author | None) -> None:
        """What was asked for is not wanted any more; what is fetched goes back."""
        await (await self._of(site)).requesters.cancel(name, author)

    async def request(self, site: UUID | None, name: str) -> "tuple[UUID, RequestView]":
        """How far a request is. Raises `NotFoundError`."""
        fleet = await self._of(site)
        return fleet.site, await fleet.read(lambda all_: all_.view(name, fleet.shown_s))

    async def requests(self, site: UUID | None) -> "list[tuple[UUID, RequestView]]":
        """All requests that are known, of a site or of all."""
        ids = [site] if site is not None else [each.site for each in self._sites.records()]
        fleets = [await self._of(e) for e in ids if self._sites.record(e).fleet is not None]
        views = [(each.site, await each.requests()) for each in fleets]
        return [(at, view) for at, of_site in views for view in of_site]

    async def fleet(self, site: UUID | None) -> "FleetAtWork":
        """The fleet of a site, or the only one. Raises `NotFoundError`, or `ConflictError` where it
        has none."""
        return await self._of(site)


def _load_opener() -> "FleetOpener":
    """What only services load that have fleets."""
    module = import_module("mend.server.fleets.fleet_opening")
    module.warm_up()
    opener: FleetOpener = module.open_fleet
    return opener
