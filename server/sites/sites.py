"""All sites of the service: opened, closed, and there again after a restart."""

import asyncio
import logging
import math
from collections.abc import Callable, Mapping
from contextlib import suppress
from datetime import datetime
from functools import partial
from typing import Any, Protocol
from uuid import UUID, uuid4

import numpy as np
from pydantic import ValidationError

from mend.errors import ConflictError, NotFoundError, WrongInputError
from mend.robots.link.messages import Intervened
from mend.server.journal import events as ev
from mend.server.journal.journal import (
    Document,
    Entry,
    Journal,
    JournalClosedError,
    JournalWriteError,
)
from mend.server.limits import Limits
from mend.server.robots.registry import RobotRegistry
from mend.server.runtime.new_run import refuse_too_many_options, robot_names
from mend.server.runtime.ports import SiteOffer
from mend.server.runtime.results import results_of
from mend.server.runtime.run import Run
from mend.server.runtime.run_state import RunState
from mend.server.sites.borrowed_robots import BorrowedRobots
from mend.server.sites.requests import SiteRequest
from mend.server.sites.running_world import RunningWorld
from mend.server.sites.site import Site
from mend.server.sites.site_record import KIND, SiteRecord
from mend.server.sites.views import SiteRobot, SiteView
from mend.server.sites.worlds import Launch, RobotNames, SimulatedWorlds
from mend.sim.random_interventions import random_interventions
from mend.sim.world import WorldSetup
from mend.tasks.frames import Frame, frames_of
from mend.tasks.scenario import ScriptedIntervention
from mend.tasks.scene import Scene

log = logging.getLogger(__name__)

PAGE = 1000


class Scenes(Protocol):
    """Where scenes are found."""

    async def scene(self, name: str) -> Scene:
        """Raises `NotFoundError` or `WrongInputError`."""
        ...


class Sites:
    """The simulated worlds of a service. Implements `mend.server.runtime.ports.Worlds`.

    A run that names no site is given one of its own, which is there for as long as it lasts.
    """

    def __init__(
        self,
        worlds: SimulatedWorlds,
        journal: Journal,
        registry: RobotRegistry,
        launch: Launch,
        names: RobotNames,
        limits: Limits,
        scenes: Scenes,
        *,
        utc_now: Callable[[], datetime],
    ) -> None:
        self._worlds = worlds
        self._journal = journal
        self._registry = registry
        self._launch = launch
        self._names = names
        self._limits = limits
        self._scenes = scenes
        self._utc_now = utc_now
        self._sites: dict[UUID, Site] = {}
        self._records: dict[UUID, SiteRecord] = {}
        self._opening = 0
        self._tasks: set[asyncio.Task[None]] = set()

    # --- Opening and closing ------------------------------------------------------------------

    async def recover(self) -> None:
        """Have every site again that was open when the service stopped, and can be read."""
        for name, text in (await self._journal.documents(KIND)).items():
            try:
                record = SiteRecord.model_validate_json(text)
            except ValidationError as error:
                # One site that cannot be read must not keep the service from starting.
                log.error("site %s cannot be read: %s", name, error)
                continue
            site = self._sites[record.site] = self._site_of(record)
            self._records[record.site] = record
            # It may take a while: who comes meanwhile waits for its robots, not for the service.
            self._spawn(self._start_again(site))

    async def _start_again(self, site: Site) -> None:
        try:
            await site.start()
        except WrongInputError as error:
            log.error("site %s cannot be started again: %s", site.id, error)

    async def open_site(self, request: SiteRequest, author: ev.Author | None = None) -> SiteView:
        """Start a world that stays.

        Raises `NotFoundError` (the scene), `WrongInputError` or `ConflictError`.
        """
        refuse_too_many_options(request.world_options, self._limits)
        self._worlds.check(request.world, request.world_options)
        scene = await self._scenes.scene(request.scene)
        if request.fleet is not None and not scene.setting:
            raise WrongInputError(
                f"'fleet' is for the robots of a building, and the scene '{request.scene}' is none"
            )
        if len(self._sites) + self._opening >= self._limits.sites:
            raise ConflictError(
                f"{self._limits.sites} sites are open, and at most so many may be: close one",
                limit="sites",
            )
        new = uuid4()
        record = SiteRecord(
            site=new,
            opened=self._utc_now(),
            world=request.world,
            scene=scene,
            robots=robot_names(scene, new),
            seed=request.seed,
            speed=request.speed,
            options=dict(request.world_options),
            author=author,
            fleet=request.fleet,
            interventions=request.interventions,
        )
        self._opening += 1
        try:
            await self._open(record)
        finally:
            self._opening -= 1
        return self._view(record)

    async def _open(self, record: SiteRecord) -> None:
        site = self._site_of(record)
        try:
            await site.start()
            opened = ev.SiteOpened(
                wall_time=record.opened,
                site=record.site,
                world=record.world,
                scene=record.scene.name,
                robots=record.robots,
                seed=record.seed,
                speed=record.speed,
                options=record.options,
                author=record.author,
            )
            await self._keep(record, opened)
        except BaseException:
            await site.stop()
            raise
        self._sites[record.site], self._records[record.site] = site, record

    async def close_site(self, site: UUID, author: ev.Author | None = None) -> None:
        """Stop a world that stays. Raises `NotFoundError`, or `ConflictError` while runs use it."""
        found = self._find(site)
        if found.used:
            raise ConflictError(f"site {site} is used by a run: abort that, or wait for its end")
        closed = ev.SiteClosed(wall_time=self._utc_now(), site=site, author=author)
        document = Document(KIND, str(site), None)
        # From here on nobody finds it to begin a run there, and no report brings its world back.
        record = self._records.pop(site)
        found.forgotten = True
        try:
            entry = Entry(events=[closed], document=document, world_forgotten=site)
            await self._journal.append(entry)
        except JournalWriteError:
            found.forgotten = False
            self._records[site] = record
            raise
        del self._sites[site]
        await found.stop()

    async def close(self) -> None:
        """Stop every world without closing its site: it is there again at the next start."""
        for task in tuple(self._tasks):
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        await asyncio.gather(*(each.stop() for each in self._sites.values()))

    async def _keep(self, record: SiteRecord, event: ev.Event) -> None:
        document = Document(KIND, str(record.site), record.model_dump_json())
        await self._journal.append(Entry(events=[event], document=document), patient=True)

    def _site_of(self, record: SiteRecord) -> Site:
        frames = dict(zip(record.robots, frames_of(record.scene).values(), strict=True))
        return self._site(record.site, record.world, frames, record.setup())

    def _site(self, id_: UUID, world: str, frames: dict[str, Frame], setup: WorldSetup) -> Site:
        def open_world(lost: Callable[[str, str], None]) -> RunningWorld:
            return RunningWorld(self._launch, self._journal, self._names, world, id_, setup, lost)

        restarted, acted = partial(self._restarted, id_), partial(self._acted, id_)
        return Site(id_, frames, open_world, self._registry, self._journal, restarted, acted)

    def _acted(self, site: UUID, done: Intervened, at_s: float) -> ev.SiteIntervention:
        return ev.SiteIntervention(
            wall_time=self._utc_now(),
            site=site,
            at_s=at_s,
            intervention=done.intervention,
            by=done.by,
            ok=done.ok,
            detail=done.detail,
        )

    def _restarted(self, site: UUID, reason: str) -> None:
        event = ev.SiteRestarted(wall_time=self._utc_now(), site=site, reason=reason)
        self._spawn(self._tell(event))

    async def _tell(self, event: ev.Event) -> None:
        with suppress(JournalClosedError, JournalWriteError):
            await self._journal.append(Entry(events=[event]), patient=True)

    def _spawn(self, work: Any) -> None:
        task = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    # --- What there is ------------------------------------------------------------------------

    def sites(self) -> list[SiteView]:
        """Every open site, in the order in which they were opened."""
        return [self._view(each) for each in self._records.values()]

    async def events(self, site: UUID, after: int, limit: int) -> list[ev.Event]:
        """What became of a site, also of one that is closed. Raises `NotFoundError`."""
        found: list[ev.Event] = []
        last = after
        while len(found) < limit:
            page = await self._journal.read_readable(last, PAGE, ev.NO_RUN)
            if not page:
                break
            last = page[-1].seq
            of_site = (each for each in page if isinstance(each, ev.SiteEvent))
            found += [each for each in of_site if each.site == site]
        if not found and after == 0:
            self._find(site)
        return found[:limit]

    def view(self, site: UUID) -> SiteView:
        """One site. Raises `NotFoundError`."""
        self._find(site)
        return self._view(self._records[site])

    def record(self, site: UUID) -> SiteRecord:
        """What is kept of an open site. Raises `NotFoundError`."""
        self._find(site)
        return self._records[site]

    def records(self) -> list[SiteRecord]:
        """What is kept of every open site, in the order in which they were opened."""
        return list(self._records.values())

    def site(self, site: UUID) -> Site:
        """An open site, its robots and who has them. Raises `NotFoundError`."""
        return self._find(site)

    def _find(self, site: UUID) -> Site:
        if site not in self._sites or site not in self._records:
            raise NotFoundError(f"there is no site {site}; it may have been closed")
        return self._sites[site]

    def _view(self, record: SiteRecord) -> SiteView:
        site = self._sites[record.site]
        frames = frames_of(record.scene)
        robots = [
            SiteRobot(
                robot=robot,
                stands=name,
                connected=self._registry.connected(robot),
                run=site.run_of(robot),
            )
            for robot, name in zip(record.robots, frames, strict=True)
        ]
        return SiteView(
            id=record.site,
            world=record.world,
            scene=record.scene.name,
            seed=record.seed,
            speed=record.speed,
            opened=record.opened,
            robots=robots,
            moved=record.moved,
            fleet=record.fleet,
        )

    # --- Runs ---------------------------------------------------------------------------------

    def check(self, world: str, options: Mapping[str, Any]) -> None:
        """Raises `WrongInputError` where there is no such world, or none with such options here."""
        self._worlds.check(world, options)

    def offer(self, site: UUID, robots: list[str]) -> SiteOffer:
        """What a run finds at a site, with these of its robots, or with all.

        Raises `NotFoundError`, `WrongInputError` or `ConflictError`.
        """
        found, record = self._find(site), self._records[site]
        wanted = [each for each in record.robots if not robots or each in robots]
        unknown = [each for each in robots if each not in record.robots]
        if unknown:
            known = ", ".join(record.robots)
            raise WrongInputError(f"site {site} has no robot '{unknown[0]}'; it has {known}")
        found.require_free(wanted)
        return SiteOffer(record.world, record.scene_for(wanted), wanted, record.seed, record.speed)

    def now_s(self, site: UUID) -> float | None:
        """What a site's clock says, as far as it is known. Raises `NotFoundError`."""
        found = self._find(site)
        # While nobody does anything, only poses tell how late it is.
        return found.shown_s if math.isfinite(found.world.time.latest_s) else None

    def open(self, state: RunState, run: Callable[[], Run]) -> BorrowedRobots:
        """The hardware of a run, which starts it; `run` is asked for only then.

        Raises `NotFoundError` where its site is there no more.
        """
        if state.started.site is not None:
            site = self._find(state.started.site)
            return BorrowedRobots(
                site, run, self._give_back, starts_world=False, began_s=state.started.at_s
            )
        own = self._site(state.id, state.started.world, state.frames, _own_setup(state))

        async def stop(_: Run) -> None:
            await own.stop()

        return BorrowedRobots(own, run, stop, starts_world=True)

    async def _give_back(self, run: Run) -> None:
        """A run has ended, or goes on after a restart."""
        state = run.context.state
        assert state.started.site is not None, "only those who borrowed something give it back"
        site = self._sites[state.started.site]
        if not state.status.ended:
            return
        site.take_back(run)
        moved = {
            each.object: each.place
            for each, leaf in results_of(state).items()
            if leaf not in state.left_out
        }
        event = ev.SiteGivenBack(
            wall_time=self._utc_now(),
            site=site.id,
            of_run=state.id,
            robots=list(run.proxies),
            moved=moved,
        )
        # At once: another run may end while this is written.
        record = self._records[site.id] = self._records[site.id].after(moved)
        with suppress(JournalClosedError):
            await self._keep(record, event)


def _own_setup(state: RunState) -> WorldSetup:
    """What the world of a run alone is told at its start, its people among it."""
    started, request = state.started, state.request
    interventions: list[ScriptedIntervention] = []
    if state.scenario is not None:
        interventions += state.scenario.interventions
    if request.interventions == "random":
        objects = state.tree.nodes.handled_objects()
        rng = np.random.default_rng([started.seed, len(objects)])
        interventions += random_interventions(objects, state.scene, rng)
    return WorldSetup(
        robots=list(started.robots),
        scene=state.scene,
        seed=started.seed,
        speed=None if started.speed == "max" else started.speed,
        interventions=interventions,
        options=dict(request.world_options),
    )
