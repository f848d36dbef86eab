"""The fleet of one site at work: it hands out legs as runs, and hears what becomes of them."""

import asyncio
import logging
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Literal, TypeVar
from uuid import UUID

from mend.errors import RefusalError
from mend.fleet.dispatch.booking import RequestView
from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.dispatch.leg import Finding, Found
from mend.fleet.right_of_way.right_of_way import Yielding
from mend.robots.link.messages import Poses
from mend.server.background import Endless
from mend.server.fleets.alarms import Alarms
from mend.server.fleets.charging import Charging
from mend.server.fleets.closed_ways import ClosedWays
from mend.server.fleets.errands import Errands
from mend.server.fleets.failed_robots import FailedRobots
from mend.server.fleets.fleet_book import FleetBook
from mend.server.fleets.fleet_news import FleetNews
from mend.server.fleets.fleet_record import Errand, FleetRecord
from mend.server.fleets.found_ways import FoundWays
from mend.server.fleets.held_cabins import HeldCabins
from mend.server.fleets.leg_task import taken_out
from mend.server.fleets.legs_under_way import LegsUnderWay
from mend.server.fleets.making_way import who_makes_way
from mend.server.fleets.meeting_watch import MeetingWatch
from mend.server.fleets.meetings import Meetings, Occupation
from mend.server.fleets.operators import Operators
from mend.server.fleets.place_names import PlaceNames
from mend.server.fleets.requesters import Requesters
from mend.server.fleets.robot_findings import finding_of, findings
from mend.server.fleets.runs import Runs
from mend.server.journal.journal import Journal
from mend.server.poses.bases import SeenBase, in_scene
from mend.server.sites.requests import FleetOptions
from mend.server.sites.site import Site

T = TypeVar("T")

log = logging.getLogger(__name__)

LOOKS_AGAIN_S = 5.0
"""While a robot waits at the place of its leg, the leg is looked after that often (site's time)."""


OTHERS_S = 3.0
"""So long a robot whose way is barred lets others go instead before it asks people (its time)."""


@dataclass(frozen=True, slots=True)
class _Decided:
    """What comes of what was thought about: whose legs are not wanted any more, by robot with why;
    robots that have charged enough, or whose turn it is at their place; when plans are to be
    looked at again."""

    unwanted: Mapping[str, str]
    charged: list[Errand]
    ready: frozenset[str]
    wakes_s: float | None
    taken_out: Mapping[str, list[str]]


class FleetAtWork:
    """One dispatcher, and the robots of a site that do what it says.

    What it decides is in the journal before a robot hears of it. `pace`: simulated seconds per
    second, None as fast as possible.
    """

    def __init__(
        self,
        site: Site,
        dispatcher: Dispatcher,
        places: PlaceNames,
        options: FleetOptions,
        runs: Runs,
        journal: Journal,
        pace: float | None,
        utc_now: Callable[[], datetime],
        kept: FleetRecord | None = None,
        *,
        most_open: int,
    ) -> None:
        """`kept`: what was known beside the dispatcher when the service stopped; `most_open`: so
        many requests may be open.
        """
        self.dispatcher = dispatcher
        self._site = site
        self.places = places
        self._options = options
        self._journal = journal
        self._pace = pace
        self._book = FleetBook(
            site,
            dispatcher,
            places,
            FleetNews(site.id, dispatcher, utc_now, lambda: self.shown_s),
            journal,
            lambda: tuple(self._errands.going.values()),
            lambda: self._held_cabins.held,
            kept,
        )
        self._failed_robots = FailedRobots(dispatcher, site.whereabouts, self._book.met_at)
        self._found_ways = FoundWays(dispatcher, self._book.closed_ways, site.whereabouts)
        self._held_cabins = HeldCabins(
            dispatcher,
            self._book.closed_ways,
            site.whereabouts,
            places.around,
            self._is_idle,
            {} if kept is None else kept.held_cabins,
        )
        self._charging = Charging(dispatcher, site.battery, places.names)
        self._legs = LegsUnderWay(site, lambda: self._options, runs, self._book)
        self._errands = Errands(
            site,
            lambda: self._options,
            runs,
            self._book,
            self._charging,
            () if kept is None else kept.errands,
        )
        self.operators = Operators(self._book, self._errands, self._legs)
        self.requesters = Requesters(self._book, most_open)
        meetings = Meetings(
            dispatcher.building, site.frames, places.names, self._occupation, site.base_of
        )
        self._meeting_watch = MeetingWatch(
            meetings, site.make_way, self._have_met, lambda: self.shown_s
        )
        self._asked_aside: dict[str, str] = {}
        """Where robots that rest are to go, as they stand in the way of others."""
        self._running: list[asyncio.Task[None]] = []
        self._alarms = Alarms(lambda: self.shown_s)

    # --- Its life -----------------------------------------------------------------------------

    def start(self) -> None:
        """Begin to work; legs that were under way go on."""
        self._site.changed = self._book.changed.set
        self._site.show_bases()
        self._site.hear_of_ways(OTHERS_S)
        self._book.changed.set()
        loops = {"fleet of": self._work, "findings at": self._hear}
        loops["meetings at"] = self._meeting_watch.run
        self._running = [
            asyncio.create_task(loop(), name=f"{what} {self._site.id}")
            for what, loop in loops.items()
        ]

    async def stop(self) -> None:
        """Stop without ending anything: it goes on from the journal."""
        self._site.changed = lambda: None
        tasks = [*self._legs.tasks, *self._errands.tasks, *self._running]
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    async def _work(self) -> None:
        working = Endless(f"the fleet of site {self._site.id}")
        while True:
            await self._book.changed.wait()
            self._book.changed.clear()
            with working.one_pass():
                await self._go_on()

    async def _go_on(self) -> None:
        async with self._book.at_once:
            decided = await self._book.in_thread(self._decide, self.now_s)
            await self._book.keep()
            robots = self.dispatcher.fleet.robots.items()
            failed = [name for name, each in robots if not each.works]
            failed += [each for each in self._held_cabins.held if each not in failed]
            self._site.keep_off(self.dispatcher.closed_until_s(), failed)
            self._site.note_taken(decided.taken_out)
            for robot, execution in self._legs.executions.items():
                execution.look_again(ready=robot in decided.ready)
            self._alarms.ring()
            self._let_time_pass(decided.wakes_s)
            # Nothing is begun after a break: what was under way may be over by then.
            for errand in self._errands.going.values():
                self._errands.carry_out(errand)
            for leg in self.dispatcher.legs_under_way():
                self._legs.carry_out(leg)
            executions = self._legs.executions
            unwanted = [
                (e, decided.unwanted[n]) for n, e in executions.items() if n in decided.unwanted
            ]
        for errand in decided.charged:
            await self._errands.break_off(errand)
        for execution, why in unwanted:
            await execution.break_off(why)

    def _decide(self, now_s: float) -> _Decided:
        """All that is to be thought about, which takes a while where much is planned."""
        self._send_before_legs(now_s)
        unwanted = self._begin_legs(now_s)
        self._send_aside(now_s)
        charged = self._charging.enough(self._errands.going.values(), now_s)
        ready = self._legs.ready()
        open_ = any(each.open for each in self.dispatcher.fleet.items.values())
        wakes_s = self.dispatcher.wakes_s() if open_ else None
        return _Decided(unwanted, charged, ready, wakes_s, taken_out(self.dispatcher))

    def _send_before_legs(self, now_s: float) -> None:
        """Robots get out of cabins, and charge, before they do anything else."""
        free = [each for each in self.dispatcher.fleet.robots if self._is_free(each)]
        for robot, to in self._held_cabins.to_send_out(free, now_s):
            self._errands.send(robot, to, None)
        free = [each for each in free if each not in self._errands.going]
        going = self._errands.going.values()
        for robot, charger in self._charging.to_send(free, going, now_s):
            self._errands.send(robot, charger, None, charges=True)

    def _send_aside(self, now_s: float) -> None:
        """Robots that have nothing to do make way."""
        asked, self._asked_aside = self._asked_aside, {}
        names = self.dispatcher.fleet.robots
        free = [each for each in names if self._is_free(each)]
        to_charge = self._charging.wanted(free, now_s)
        makes_way = who_makes_way(self.dispatcher, self.places.names, to_charge)
        for robot, to in [*asked.items(), *makes_way]:
            if self._is_free(robot):
                self._errands.send(robot, to, None)

    def _begin_legs(self, now_s: float) -> dict[str, str]:
        """Have robots that rest set out for what is due; whose legs are not wanted any more, and
        why."""
        for robot, known in self.dispatcher.fleet.robots.items():
            if (
                not known.works
                and robot not in self._book.out_of_service
                and self._site.rests(robot)
            ):
                self.dispatcher.robot_back(robot, self._book.at(robot), now_s)
        for robot, at in self._failed_robots.moved():
            self.dispatcher.robot_moved(robot, at, now_s)
        for elevator, found in self._held_cabins.found(now_s):
            self._note_held(elevator, found, now_s)
        legs = self.dispatcher.legs_to_withdraw(now_s)
        unwanted = {each.robot: self.dispatcher.why_unwanted(each) for each in legs}
        while due := [e for e in self.dispatcher.legs_to_begin(now_s) if self._is_free(e.robot)]:
            self._legs.note_begun(due[0], now_s)
        return unwanted

    def _is_free(self, robot: str) -> bool:
        return self._site.rests(robot) and robot not in self._errands.going

    def _is_idle(self, robot: str) -> bool:
        """Whether it does nothing for anybody, be it in service or not."""
        busy = robot in self._legs.executions or robot in self._errands.going
        return not busy and self._site.run_of(robot) is None

    @property
    def site(self) -> UUID:
        """The id of its site."""
        return self._site.id

    @property
    def now_s(self) -> float:
        """The site's clock, as far as it is known: it never goes back."""
        return self._book.now_s

    @property
    def out_of_service(self) -> Mapping[str, str]:
        """The robots that somebody has taken out, and why."""
        return self._book.out_of_service

    @property
    def closed_ways(self) -> ClosedWays:
        """What was told of ways."""
        return self._book.closed_ways

    @property
    def shown_s(self) -> float:
        """The site's clock for who watches it."""
        return self._book.shown_s

    def _let_time_pass(self, wakes_s: float | None) -> None:
        """Have the site's clock run to when there is something to be done, if there ever is.

        `wakes_s`: when plans have something to be done.
        """
        now_s, alarm_s = self.now_s, self._alarms.next_s
        if alarm_s is not None:
            wakes_s = min(alarm_s, wakes_s or alarm_s)
        if any(execution.waits for execution in self._legs.executions.values()):
            wakes_s = min(now_s + LOOKS_AGAIN_S, wakes_s or now_s + LOOKS_AGAIN_S)
        if wakes_s is not None:
            self._site.let_time_pass(max(wakes_s, now_s + 1.0), self._pace)

    async def wait_until(self, moment_s: float) -> None:
        """Have the site's clock come to a moment, whether or not there is anything to do."""
        self._book.changed.set()
        await self._alarms.wait(moment_s)
        # Reports of robots that drive for long may not have told of it yet.
        self._site.world.time.heard(moment_s)

    # --- What robots tell ---------------------------------------------------------------------

    async def _hear(self) -> None:
        """Have plans follow what robots find on their ways."""
        hearing = Endless(f"what robots find at site {self._site.id}")
        async for event in findings(self._journal):
            found = finding_of(event)
            if found is not None and event.robot in self.dispatcher.fleet.robots:
                with hearing.one_pass():
                    await self._robot_found(found)

    async def _robot_found(self, found: Found) -> None:
        async with self._book.told():
            try:
                if await self._book.in_thread(self._found_ways.take, found, self.now_s):
                    self._note_found(found)
            except RefusalError as error:
                log.info("what %s found of its way changes no plan: %s", found.by, error)

    def _note_found(self, found: Found) -> None:
        """It is told even where it changes nobody's plan."""
        a, b = found.between
        finding = found.finding.replace("_", " ")
        told = f"found of the way between {a} and {b}: {finding}"
        self._book.note(self._book.news.told(told, finder=found.by))

    def _note_held(self, elevator: str, found: Found, now_s: float) -> None:
        """A robot stays in an elevator's cabin, or is out of it."""
        try:
            self._held_cabins.take(found, now_s)
        except RefusalError as error:
            log.info("that %s holds %s changes no plan: %s", found.by, elevator, error)
            return
        stays = f"stays in {elevator}, which nobody else can ride"
        told = f"is out of {elevator}" if found.finding is Finding.OPEN else stays
        self._book.note(self._book.news.told(told, finder=found.by))

    def saw(self, robot: str, poses: Poses) -> None:
        """A robot says where it is, by the site's clock."""
        self._alarms.ring()
        self._meeting_watch.take(robot, poses)
        errand = self._errands.going.get(robot)
        charges = errand is not None and errand.charges
        looks = (charges or self._is_free(robot)) and self._charging.is_to_look(
            robot, poses.battery, poses.time, charges=charges
        )
        here = in_scene(self._site.frames[robot], poses.base)[:3]
        if self._held_cabins.saw(robot, here, poses.time) or looks:
            self._book.changed.set()

    async def _have_met(self, decided: Yielding, place: str | None) -> None:
        """A robot makes way for another one; `place`: where it is to go for that, if it rests."""
        told = f"met {decided.other} where they cannot pass each other, and is to make way"
        async with self._book.told():
            self._book.note(self._book.news.told(told, finder=decided.robot))
            if place is not None:
                self._asked_aside[decided.robot] = place

    def _occupation(self, robot: str) -> Occupation:
        leg, errand = self._legs.executions.get(robot), self._errands.going.get(robot)
        if leg is not None:
            return Occupation(goal=leg.place)
        if errand is not None:
            return Occupation(goal=errand.place)
        return Occupation(rests=self._site.rests(robot) and robot not in self._book.out_of_service)

    def stands_at(self, robot: str) -> str | None:
        """The place at which somebody asks a robot; None where none is sent. Raises
        `NotFoundError`."""
        self._book.require_robot(robot)
        place = self._book.at(robot)
        return place if place in self.places.names else None

    @property
    def pace(self) -> float | None:
        """Seconds of the site's clock per second; None where it goes as fast as it can."""
        return self._pace

    # --- What others ask of it --------------------------------------------------------------------

    async def break_off_errands(self) -> None:
        """No robot goes anywhere without a leg; over once those have ended that had begun."""
        for errand in list(self._errands.going.values()):
            await self._errands.break_off(errand)
        if tasks := self._errands.tasks:
            await asyncio.wait(tasks)

    async def have_answered(self, answers: Literal["live", "yes", "late"]) -> None:
        """Who answers robots in the legs that begin from now on."""
        async with self._book.at_once:
            self._options = self._options.model_copy(update={"answers": answers})

    @property
    def errands(self) -> Mapping[str, Errand]:
        """Which robots go somewhere without a leg."""
        return self._errands.going

    def is_connected(self, robot: str) -> bool:
        """Whether a robot is there."""
        return self._site.is_connected(robot)

    def run_of(self, robot: str) -> UUID | None:
        """Which run has a robot."""
        return self._site.run_of(robot)

    def base(self, robot: str) -> SeenBase | None:
        """Where a robot says that it is; None until it has."""
        return self._site.base(robot)

    def battery(self, robot: str) -> float | None:
        """What a robot's battery holds, as a share; None where it does not run out or say so."""
        return self._site.battery(robot)

    async def requests(self) -> list[RequestView]:
        """How far all requests are that are known, and when they are expected just now."""
        return await self.read(lambda all_: all_.views(self.shown_s))

    async def read(self, view: Callable[[Dispatcher], T]) -> T:
        """What a view of its dispatcher shows, while nothing changes there."""
        async with self._book.at_once:
            return await self._book.in_thread(view, self.dispatcher)
