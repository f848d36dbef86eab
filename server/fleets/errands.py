"""Ways of robots that carry out no leg: somebody has sent them, or they make way for another."""

import asyncio
import logging
from collections.abc import Callable, Iterable, Mapping
from uuid import UUID, uuid4

from mend.errors import ConflictError, RefusalError
from mend.server.background import log_failure
from mend.server.fleets.charging import Charging
from mend.server.fleets.fleet_book import FleetBook
from mend.server.fleets.fleet_record import Errand
from mend.server.fleets.leg_task import charging_at, way_of, way_request
from mend.server.fleets.runs import Runs
from mend.server.journal import events as ev
from mend.server.runtime.views import RunStatus
from mend.server.sites.requests import FleetOptions
from mend.server.sites.site import Site

log = logging.getLogger(__name__)
_LONGEST = 500

BROKEN_OFF = "it was broken off"


class Errands:
    """At most one of each robot, in a run of its own; meanwhile no leg of that robot begins."""

    def __init__(
        self,
        site: Site,
        options: Callable[[], FleetOptions],
        runs: Runs,
        book: FleetBook,
        charging: Charging,
        going: Iterable[Errand],
    ) -> None:
        """`going`: those that were under way when the service stopped. `options`: as they are by
        then when an errand begins.
        """
        self._site, self._options, self._runs = site, options, runs
        self._book, self._charging, self._dispatcher = book, charging, book.dispatcher
        self._going = {each.robot: each for each in going}
        self._tasks: dict[str, asyncio.Task[None]] = {}
        self._unwanted: set[UUID] = set()
        """The runs that were broken off, maybe before they had begun."""

    @property
    def going(self) -> Mapping[str, Errand]:
        """Those under way, by robot."""
        return self._going

    def require_free(self, robot: str) -> None:
        """Raises `ConflictError` where a robot cannot be sent anywhere now."""
        leg = next((e for e in self._dispatcher.legs_under_way() if e.robot == robot), None)
        if leg is not None:
            raise ConflictError(
                f"robot '{robot}' is at work for '{leg.booking}' at {leg.place}: send it once that "
                "is done, or take it out of service first"
            )
        if robot in self._going:
            raise ConflictError(f"robot '{robot}' is on its way to {self._going[robot].place}")
        if not self._site.is_connected(robot):
            raise ConflictError(f"robot '{robot}' is not connected")
        if not self._site.rests(robot):
            run = self._site.run_of(robot)
            busy = "has not come to rest yet" if run is None else f"is busy with run {run}"
            raise ConflictError(f"robot '{robot}' {busy}")

    @property
    def tasks(self) -> list[asyncio.Task[None]]:
        """What is to be cancelled where the service stops."""
        return list(self._tasks.values())

    def send(
        self, robot: str, place: str, author: ev.Author | None, *, charges: bool = False
    ) -> None:
        """Have a robot without a leg go to a place (`FLOOR/PLACE`), once that is journaled."""
        errand = Errand(robot=robot, place=place, run=uuid4(), charges=charges)
        self._going[robot] = errand
        self._book.note(self._book.news.errand_begun(errand, self._book.at(robot), author))

    def carry_out(self, errand: Errand) -> None:
        """Have its robot go, unless it does so already."""
        if errand.robot not in self._tasks:
            task = asyncio.create_task(self._follow(errand), name=f"errand of {errand.robot}")
            task.add_done_callback(log_failure)
            self._tasks[errand.robot] = task

    async def _follow(self, errand: Errand) -> None:
        robot, begun = errand.robot, True
        try:
            reason = await self._run(errand)
        except RefusalError as error:
            reason, begun = str(error)[:_LONGEST], False
        except Exception:
            # Its robot would be thought to be on its way for ever.
            log.exception("an errand of %s could not be carried out", robot)
            reason, begun = "a fault of Mend's own; see its log", False
        async with self._book.at_once:
            at = errand.place if reason is None else self._book.at(robot)
            if errand.charges and reason is not None:
                self._charging.could_not(robot, self._book.now_s)
            self._book.note(self._book.news.errand_ended(errand, at, reason))
            await self._end(errand, at)
            await self._book.keep()
        if begun:
            self._book.changed.set()
        # Else whatever changes next has it tried again, where it makes way.

    async def _run(self, errand: Errand) -> str | None:
        """Have its robot go there; returns why it has not come there, if so.

        Raises a `RefusalError` where it cannot be begun.
        """
        request = way_request(self._site.id, errand.robot, self._options())
        place = self._book.places.in_scene(errand.place)
        tree = charging_at(place) if errand.charges else way_of(place)
        await self._runs.start_run_of(errand.run, request, tree)
        if errand.run in self._unwanted:
            await self.break_off(errand)
        view = await self._runs.wait_for_end(errand.run)
        if not view.status.ended:
            # The service stops, and goes on with it at its next start.
            await asyncio.Event().wait()
        if view.status is RunStatus.ABORTED and errand.run in self._unwanted:
            return BROKEN_OFF
        if view.result is None:
            return str(view.status)
        # A leaf that somebody had left out counts as done for the run, but nobody has done it.
        came = view.status is RunStatus.FINISHED and not view.result.missing
        return None if came else view.result.reason[:_LONGEST]

    async def break_off(self, errand: Errand) -> None:
        """It is not wanted any more."""
        self._unwanted.add(errand.run)
        try:
            await self._runs.abort(errand.run)
        except RefusalError as error:
            log.info("the errand of %s was over, or not begun: %s", errand.robot, error)

    async def _end(self, errand: Errand, at: str) -> None:
        """Its robot is at a place, which plans know from now on."""
        del self._going[errand.robot], self._tasks[errand.robot]
        self._unwanted.discard(errand.run)
        if self._dispatcher.fleet.robots[errand.robot].works:
            try:
                now_s = self._dispatcher.now_s
                await self._book.in_thread(self._dispatcher.robot_moved, errand.robot, at, now_s)
            except ConflictError as error:
                log.info("where %s has gone changes no plan: %s", errand.robot, error)
