"""One leg, carried out by runs of its robot: going there, waiting for its turn, and doing it."""

import asyncio
import logging
from collections.abc import Awaitable, Callable
from contextlib import suppress
from dataclasses import dataclass
from uuid import UUID

from mend.errors import ConflictError, RefusalError, UnavailableError
from mend.fleet.dispatch.leg import Leg, LegEnd, LegOutcome
from mend.fleet.requests import GoToRoom, LegAction
from mend.robots.base.behaviors.behavior import MEETS_M
from mend.server.fleets.leg_task import (
    BEHAVIORS,
    HAND_OVER,
    LegStage,
    run_of,
    run_request,
    task_of,
    way_of,
)
from mend.server.fleets.place_names import PlaceNames
from mend.server.fleets.runs import Runs
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunStatus, RunView
from mend.server.sites.requests import FleetOptions
from mend.server.sites.site import Site
from mend.tasks.definition import TaskTreeDefinition

log = logging.getLogger(__name__)

TRIES_AGAIN_S = 1.0
"""What could not be begun is tried again after so long (wall time)."""
RESTS_WITHIN_S = 5.0
"""So long a robot whose leg was broken off may take to say that it stands (wall time)."""
_LONGEST = 500


@dataclass(frozen=True, slots=True)
class LegTurn:
    """What a leg has to wait for at its place, by the site's clock.

    `arrived` says that its robot is there; `may_begin` is asked, in a thread, when things have
    changed.
    """

    arrived: Callable[[], Awaitable[None]]
    may_begin: Callable[[], bool]
    now_s: Callable[[], float]


class LegExecution:
    """Carries out a leg; after a restart the same runs are found again by their ids."""

    def __init__(
        self,
        site: Site,
        leg: Leg,
        places: PlaceNames,
        options: FleetOptions,
        runs: Runs,
        turn: LegTurn,
    ) -> None:
        self._site, self._leg, self._places = site, leg, places
        self._options, self._runs, self._turn = options, runs, turn
        self._run: UUID | None = None
        self._broken_off: str | None = None
        self._waiting: asyncio.Future[None] | None = None
        self._stands = asyncio.Event()
        self._ready: Callable[[], bool] = lambda: True

    @property
    def place(self) -> str:
        """Where it is done, as `FLOOR/PLACE`."""
        return self._leg.place

    @property
    def waits(self) -> bool:
        """Whether its robot is there, and waits for its time."""
        return self._waiting is not None

    def is_ready(self) -> bool:
        """Whether its robot waits at its place, and it is its turn by now; may take a while."""
        return self.waits and self._ready()

    def look_again(self, *, ready: bool) -> None:
        """Time has passed, or others have done something: it may be its turn (`is_ready`)."""
        if self._is_still:
            self._stands.set()
        waiting = self._waiting
        if waiting is not None and not waiting.done() and (self._broken_off or ready):
            waiting.set_result(None)

    async def break_off(self, why: str) -> None:
        """It is not wanted any more; `run` says that it was withdrawn, unless it was done."""
        self._broken_off = self._broken_off or why[:_LONGEST]
        self.look_again(ready=False)
        if self._run is not None:
            try:
                await self._runs.abort(self._run)
            except ConflictError:
                # It has ended meanwhile.
                return

    async def run(self, *, at_once: bool) -> LegEnd:
        """Carry it out, and say what came of it.

        `at_once`: what is to be done may be done as soon as the robot is there.
        """
        try:
            return await self._stages(at_once=at_once)
        except RefusalError as error:
            return self._failed(str(error)[:_LONGEST])
        except Exception:
            # Nobody waits for it but the dispatcher, which would wait for ever.
            log.exception("a leg of %s could not be carried out", self._leg.robot)
            return self._failed("a fault of Mend's own; see its log")

    async def _stages(self, *, at_once: bool) -> LegEnd:
        leg, place = self._leg, self._places.in_scene(self._leg.place)
        visits = leg.action is LegAction.VISIT
        doing = run_of(self._site.id, leg.robot, leg.number, LegStage.DO)
        if visits or not (at_once or await self._runs.has_run(doing)):
            end = await self._done(LegStage.GO, way_of(place, MEETS_M))
            if end.outcome is not LegOutcome.DONE:
                return end
            await self._wait()
            if self._broken_off:
                return self._broken()
        return end if visits else await self._done(LegStage.DO, task_of(leg, place, self._away_m()))

    def _away_m(self) -> float | None:
        """How far from its place the robot stands out of whose basket something is to be taken."""
        where = None if self._leg.held_by is None else self._site.whereabouts(self._leg.held_by)
        return None if where is None else self._places.away_m(self._leg.place, *where)

    async def _wait(self) -> None:
        """Stay until it is time, and as long as somebody wants the robot there."""
        turn, request = self._turn, self._leg.request
        leaves_s = turn.now_s() + (request.stay_s if isinstance(request, GoToRoom) else 0.0)
        self._ready = lambda: turn.now_s() >= leaves_s and turn.may_begin()
        self._waiting = asyncio.get_running_loop().create_future()
        try:
            await turn.arrived()
            await self._waiting
        finally:
            self._waiting = None

    async def _done(self, stage: LegStage, tree: TaskTreeDefinition) -> LegEnd:
        """What came of one of its runs."""
        leg = self._leg
        run = run_of(self._site.id, leg.robot, leg.number, stage)
        request = run_request(self._site.id, leg, self._options)
        while not await self._is_begun(run, request, tree):
            if self._broken_off:
                return self._broken()
            await asyncio.sleep(TRIES_AGAIN_S)
        self._run = run
        view = await self._runs.wait_for_end(run)
        if not view.status.ended:
            # The service stops, and goes on with it at its next start.
            await asyncio.Event().wait()
        self._run = None
        end = self._end_of(view)
        return await self._withdrawn() if end.outcome is LegOutcome.WITHDRAWN else end

    async def _withdrawn(self) -> LegEnd:
        """Broken off: what its robot has driven it says when it stands, which is soon."""
        with suppress(TimeoutError):
            async with asyncio.timeout(RESTS_WITHIN_S):
                while not self._is_still:
                    self._stands.clear()
                    await self._stands.wait()
        return self._broken()

    @property
    def _is_still(self) -> bool:
        """Whether nothing more is to be heard of its robot, as it rests or is not there."""
        robot = self._leg.robot
        return self._site.rests(robot) or not self._site.is_connected(robot)

    async def _is_begun(self, run: UUID, request: RunRequest, tree: TaskTreeDefinition) -> bool:
        try:
            await self._runs.start_run_of(run, request, tree)
        except (ConflictError, UnavailableError):
            # Another run has the robot, or there are too many.
            return False
        return True

    def _end_of(self, run: RunView) -> LegEnd:
        """What a run that has ended says of its leg."""
        # A leaf that somebody had left out counts as done for the run, but nobody has done it.
        left_out = run.result is None or bool(run.result.missing)
        if run.status is RunStatus.FINISHED and not left_out:
            return LegEnd(outcome=LegOutcome.DONE, reason=self._felt())
        if self._broken_off:
            return self._broken()
        said = run.result.reason if run.result is not None else str(run.status)
        return self._failed(said[:_LONGEST])

    def _broken(self) -> LegEnd:
        return LegEnd(outcome=LegOutcome.WITHDRAWN, reason=self._broken_off, at=self._at())

    def _failed(self, reason: str) -> LegEnd:
        return LegEnd(outcome=LegOutcome.FAILED, reason=reason, at=self._at())

    def _felt(self) -> str | None:
        """What is known of a thing that was brought: a load cell does not tell who took it."""
        leg = self._leg
        if BEHAVIORS.get(leg.action) != HAND_OVER:
            return None
        return f"it was taken out of the basket of {leg.robot} at {leg.place}"

    def _at(self) -> str | None:
        """The place that the robot is nearest to, as far as it has said where it is."""
        where = self._site.whereabouts(self._leg.robot)
        return None if where is None else self._places.nearest(*where)
