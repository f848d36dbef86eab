"""The legs that robots of a fleet carry out now, each as a run of its own."""

import asyncio
from collections.abc import Callable, Mapping
from functools import partial

from mend.errors import ConflictError
from mend.fleet.dispatch.leg import Leg, LegEnd, LegOutcome
from mend.robots.link.messages import Driven
from mend.server.background import log_failure
from mend.server.fleets.fleet_book import FleetBook
from mend.server.fleets.leg_execution import LegExecution, LegTurn
from mend.server.fleets.runs import Runs
from mend.server.sites.odometer import Odometer
from mend.server.sites.requests import FleetOptions
from mend.server.sites.site import Site


class LegsUnderWay:
    """At most one of each robot; what becomes of it is in the book before others hear of it."""

    def __init__(
        self, site: Site, options: Callable[[], FleetOptions], runs: Runs, book: FleetBook
    ) -> None:
        """`options`: as they are by then when a leg begins."""
        self._site, self._options, self._runs, self._book = site, options, runs, book
        self._dispatcher = book.dispatcher
        self._executions: dict[str, LegExecution] = {}
        self._tasks: dict[str, asyncio.Task[None]] = {}
        self._set_out: dict[str, Odometer | None] = {}
        """What robots had driven when they set out for the leg that they are on."""

    @property
    def executions(self) -> Mapping[str, LegExecution]:
        """How they are carried out, by robot."""
        return self._executions

    @property
    def tasks(self) -> list[asyncio.Task[None]]:
        """What is to be cancelled where the service stops."""
        return list(self._tasks.values())

    def ready(self) -> frozenset[str]:
        """The robots that wait at the place of their leg, and may begin by now."""
        executions = list(self._executions.items())
        return frozenset(robot for robot, each in executions if each.is_ready())

    def note_begun(self, leg: Leg, now_s: float) -> None:
        """A robot sets out for a leg, which is carried out once that is journaled."""
        start = self._book.at(leg.robot)
        self._dispatcher.began(leg, now_s)
        self._set_out[leg.robot] = self._site.odometer(leg.robot)
        self._book.note(self._book.news.begun(leg, start))

    def carry_out(self, leg: Leg) -> None:
        """Have its robot do it, unless it does so already."""
        if leg.robot in self._executions:
            return
        turn = LegTurn(
            arrived=partial(self._arrived, leg),
            may_begin=lambda: self._dispatcher.may_begin(leg, self._book.now_s),
            now_s=lambda: self._book.now_s,
        )
        execution = LegExecution(
            self._site, leg, self._book.places, self._options(), self._runs, turn
        )
        self._executions[leg.robot] = execution
        task = asyncio.create_task(self._follow(leg, execution), name=f"leg of {leg.robot}")
        task.add_done_callback(log_failure)
        self._tasks[leg.robot] = task

    async def _follow(self, leg: Leg, execution: LegExecution) -> None:
        async with self._book.at_once:
            at_once = await self._book.in_thread(self._dispatcher.may_begin, leg, self._book.now_s)
        end = await execution.run(at_once=at_once)
        async with self._book.at_once:
            if leg.robot in {each.robot for each in self._dispatcher.legs_under_way()}:
                await self._book.in_thread(self._end, leg, end)
            del self._executions[leg.robot]
            del self._tasks[leg.robot]
            await self._book.keep()
        self._book.changed.set()

    async def _arrived(self, leg: Leg) -> None:
        async with self._book.at_once:
            await self._book.in_thread(self._dispatcher.arrived, leg, self._book.now_s)
            await self._book.keep()
        self._book.changed.set()

    def _end(self, leg: Leg, end: LegEnd) -> None:
        robot, now_s = leg.robot, self._book.now_s
        done = end.outcome is LegOutcome.DONE
        gone = None if self._site.is_connected(robot) else end.reason or "it is gone"
        why = self._book.out_of_service.get(robot, None if done else gone)
        if done or why is None:
            try:
                self._dispatcher.ended(leg, end, now_s)
            except ConflictError as error:
                # What is said to be done cannot have been.
                refused = LegEnd(outcome=LegOutcome.FAILED, reason=str(error)[:500], at=end.at)
                self._dispatcher.ended(leg, refused, now_s)
                end = refused
        if why is not None:
            # Others fetch what it has, and do what it was to do.
            self._dispatcher.robot_failed(robot, self._book.met_at(robot), why, now_s)
        driven = self._driven(robot, end.outcome)
        self._book.note(self._book.news.ended(leg, end, driven))

    def _driven(self, robot: str, outcome: LegOutcome) -> Driven | None:
        """What it drove for a leg that ends so; None where it has not said that yet.

        Whose leg fails has said so itself, if it is there; whose leg is broken off was driving,
        and says so once it stands.
        """
        odometer, before = self._site.odometer(robot), self._set_out.pop(robot, None)
        failed_there = outcome is LegOutcome.FAILED and self._site.is_connected(robot)
        known = outcome is LegOutcome.DONE or failed_there or self._site.rests(robot)
        return odometer.since(before) if odometer is not None and known else None
