"""A fleet hands its legs out as runs, once each, and follows what becomes of them."""

import asyncio
from collections import defaultdict
from collections.abc import AsyncIterator, Callable, Collection, Mapping
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime
from functools import partial
from threading import Event as ThreadEvent
from threading import get_ident
from typing import Any
from uuid import UUID

import pytest
from dispatch_office import asked, dispatcher_for, office, visit
from pydantic import ValidationError

from mend.errors import ConflictError, NotFoundError, WrongInputError
from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.requests import RequestStatus
from mend.robots.base.behaviors.behavior import MEETS_M
from mend.robots.link.messages import BaseLimits, Driven, MakeWay
from mend.server.fleets import leg_execution
from mend.server.fleets.fleet_at_work import FleetAtWork
from mend.server.fleets.fleet_record import FleetRecord
from mend.server.fleets.fleets import KIND
from mend.server.fleets.operator_requests import WayReport
from mend.server.fleets.place_names import PlaceNames
from mend.server.fleets.request_refused import RequestRefusedError
from mend.server.fleets.views import FleetView
from mend.server.journal import events as ev
from mend.server.journal.sqlite import SqliteJournal
from mend.server.poses.bases import SeenBase
from mend.server.runtime.clock import WorldTime
from mend.server.runtime.views import RunStatus
from mend.server.sites.odometer import Odometer
from mend.server.sites.requests import FleetOptions
from mend.tasks.definition import TaskTreeDefinition
from mend.tasks.frames import Frame
from mend.tasks.scene import Place, Pose, Scene

SITE = UUID(int=9)
PATIENCE_S = 20.0
SCENE = Scene(
    name="office",
    objects={},
    places={each: Place(pose=Pose(x=10.0 * n, y=0.0, z=0.0)) for n, each in enumerate("abcde")},
)


class FakeSite:
    """A site whose clock runs as far as it is asked to, and at once."""

    def __init__(self) -> None:
        self.id = SITE
        self.world: Any = self
        self.time = WorldTime()
        self.changed: Callable[[], None] = lambda: None
        self.busy: set[str] = set()
        self.gone: set[str] = set()
        self.rolls_on: set[str] = set()
        self.standing: dict[str, tuple[float, float, float]] = {}
        self.runs: dict[str, UUID] = {}
        self.bases: dict[str, SeenBase] = {}
        self.shown_s = 0.0
        self.odometers: dict[str, Odometer] = {}
        self.kept_off: set[frozenset[str]] = set()
        self.stands_still = False
        self.asks_after_s = 0.0
        self.failed: list[str] = []
        self.batteries: dict[str, float] = {}
        self.taken: Mapping[str, list[str]] = {}
        self.made_way: list[tuple[str, MakeWay]] = []

    def odometer(self, robot: str) -> Odometer | None:
        return self.odometers.get(robot)

    def keep_off(
        self, closed: Mapping[frozenset[str], float], failed: Collection[str] = ()
    ) -> None:
        self.kept_off, self.failed = set(closed), [*failed]

    def hear_of_ways(self, asks_after_s: float) -> None:
        self.asks_after_s = asks_after_s

    @property
    def frames(self) -> Mapping[str, Frame]:
        return defaultdict(Frame)

    def base_of(self, robot: str) -> BaseLimits:  # noqa: ARG002 - all are alike
        return BaseLimits(radius_m=0.25, speed_m_s=1.0)

    def make_way(self, robot: str, told: MakeWay) -> None:
        self.made_way.append((robot, told))

    def note_taken(self, taken: Mapping[str, list[str]]) -> None:
        self.taken = taken

    def battery(self, robot: str) -> float | None:
        return self.batteries.get(robot)

    def rests(self, robot: str) -> bool:
        return robot not in self.busy | self.gone | self.rolls_on

    def run_of(self, robot: str) -> UUID | None:
        return self.runs.get(robot)

    def show_bases(self) -> None:
        """They are as a test sets them."""

    def base(self, robot: str) -> SeenBase | None:
        return self.bases.get(robot)

    def is_connected(self, robot: str) -> bool:
        return robot not in self.gone

    def whereabouts(self, robot: str) -> tuple[float, float, float] | None:
        return self.standing.get(robot)

    def let_time_pass(self, until_s: float, rate: float | None) -> bool:  # noqa: ARG002
        if self.stands_still:
            return True
        self.time.heard(until_s)
        asyncio.get_running_loop().call_soon(self.changed)
        return True


@dataclass
class FakeRun:
    """A run of which a test says how it ends."""

    id: UUID
    robot: str
    behavior: str
    parameters: dict[str, Any]
    ended: "asyncio.Future[tuple[str, bool]]"


@dataclass
class FakeRuns:
    """Implements `mend.server.fleets.runs.Runs`; `refuse` so many beginnings."""

    site: FakeSite
    refuse: int = 0
    runs: list[FakeRun] = field(default_factory=list)
    begun: asyncio.Event = field(default_factory=asyncio.Event)
    aborted: asyncio.Event = field(default_factory=asyncio.Event)
    """What is to be before an abort is over."""

    def __post_init__(self) -> None:
        self.aborted.set()

    async def start_run_of(self, run: UUID, request: Any, tree: TaskTreeDefinition) -> Any:
        if self.refuse:
            self.refuse -= 1
            raise ConflictError("the robot is busy")
        if not await self.has_run(run):
            leaf: Any = tree.nodes[0]
            ended = asyncio.get_running_loop().create_future()
            (robot,) = request.robots
            self.site.busy.add(robot)
            self.runs.append(FakeRun(run, robot, leaf.behavior, leaf.parameters, ended))
            self.begun.set()

    async def wait_for_end(self, run: UUID) -> Any:
        of = next(each for each in self.runs if each.id == run)
        status, done = await asyncio.shield(of.ended)
        self.site.busy.discard(of.robot)
        return _View(status, done, of.behavior)

    async def abort(self, run: UUID, author: object = None) -> Any:  # noqa: ARG002
        if not await self.has_run(run):
            raise NotFoundError(f"there is no run {run}")
        next(each for each in self.runs if each.id == run).ended.set_result(("aborted", False))
        await self.aborted.wait()

    async def has_run(self, run: UUID) -> bool:
        return any(each.id == run for each in self.runs)

    async def nth(self, number: int) -> FakeRun:
        """The first run that is begun, the second, ..."""
        async with asyncio.timeout(PATIENCE_S):
            while len(self.runs) < number:
                self.begun.clear()
                await self.begun.wait()
        return self.runs[number - 1]


class _View:
    def __init__(self, status: str, done: bool, behavior: str) -> None:
        self.status = RunStatus(status)
        self.result = self
        self.reason = "nobody came"
        self.missing = [] if done else [behavior]


@dataclass
class Work:
    """A fleet at work on an empty journal."""

    site: FakeSite
    runs: FakeRuns
    journal: SqliteJournal
    fleet: FleetAtWork

    async def status(self, name: str) -> RequestStatus:
        return await self.fleet.read(lambda all_: all_.view(name).status)

    async def until(self, name: str, status: RequestStatus) -> None:
        async with asyncio.timeout(PATIENCE_S):
            while await self.status(name) is not status:  # noqa: ASYNC110 - nobody tells of it
                await asyncio.sleep(0)


def _fleet(
    site: Any,
    runs: FakeRuns,
    journal: SqliteJournal,
    of: Dispatcher,
    kept: FleetRecord | None = None,
    most_open: int = 100,
) -> FleetAtWork:
    places, options = PlaceNames(office(), SCENE), FleetOptions()
    now = datetime(2026, 1, 2, tzinfo=UTC)
    return FleetAtWork(
        site, of, places, options, runs, journal, None, lambda: now, kept, most_open=most_open
    )


@asynccontextmanager
async def working(*starts: str, refuse: int = 0, most_open: int = 100) -> AsyncIterator[Work]:
    site, journal = FakeSite(), SqliteJournal(":memory:")
    runs = FakeRuns(site, refuse)
    fleet = _fleet(site, runs, journal, dispatcher_for(*starts), most_open=most_open)
    fleet.start()
    try:
        yield Work(site, runs, journal, fleet)
    finally:
        await fleet.stop()
        journal.close()


async def test_what_is_asked_for_is_fetched_and_handed_over_by_one_robot() -> None:
    async with working("a") as work:
        await work.fleet.requesters.submit(asked(), None)
        fetching = await work.runs.nth(1)
        assert fetching.behavior == "collect_item"
        assert fetching.parameters == {"place": "b", "item": "tea"}
        fetching.ended.set_result(("finished", True))
        bringing = await work.runs.nth(2)
        assert bringing.behavior == "hand_over_item"
        assert bringing.parameters == {"place": "d", "item": "tea"}
        assert await work.status("tea") is RequestStatus.UNDER_WAY
        bringing.ended.set_result(("finished", True))
        await work.until("tea", RequestStatus.DONE)
        assert len(work.runs.runs) == 2


async def test_that_time_goes_on_while_legs_are_decided_fails_nothing(
    caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with working("a", "c") as work:
        heard = work.site.time.heard

        def where(_robot: str) -> None:
            heard(work.fleet.now_s + 0.3)

        monkeypatch.setattr(work.site, "whereabouts", where)
        for name, place in (("one", "b"), ("other", "d")):
            await work.fleet.requesters.submit(visit(name=name, place=place), None)
        for number in (1, 2):
            (await work.runs.nth(number)).ended.set_result(("finished", True))
        for name in ("one", "other"):
            await work.until(name, RequestStatus.DONE)
    assert [each.getMessage() for each in caplog.records if "has failed" in each.getMessage()] == []


async def test_of_what_was_brought_nobody_says_who_has_it() -> None:
    async with working("a") as work:
        await work.fleet.requesters.submit(asked(), None)
        (await work.runs.nth(1)).ended.set_result(("finished", True))
        (await work.runs.nth(2)).ended.set_result(("finished", True))
        await work.until("tea", RequestStatus.DONE)
        taken_out = "it was taken out of the basket of r0 at f/d"
        assert work.fleet.dispatcher.view("tea").reason == taken_out
        told = [e for e in await work.journal.read(0, 1000) if isinstance(e, ev.LegEnded)]
        assert [each.reason for each in told] == [None, taken_out]


async def test_a_leg_is_in_the_journal_before_its_robot_hears_of_it() -> None:
    async with working("a") as work:
        await work.fleet.requesters.submit(asked(), None)
        await work.runs.nth(1)
        kept = (await work.journal.documents(KIND))[str(SITE)]
        (leg,) = FleetRecord.model_validate_json(kept).dispatcher.under_way
        assert (leg.robot, leg.booking, leg.action) == ("r0", "tea", "collect")


async def _legs_of(journal: SqliteJournal) -> list[tuple[str, str, int]]:
    """What is journaled of legs: kind of event, robot and number of the leg."""
    return [
        (each.type, each.robot, each.number)
        for each in await journal.read(0, 1000)
        if isinstance(each, ev.LegBegun | ev.LegEnded)
    ]


async def test_the_journal_tells_when_legs_begin_and_end_once_each_over_a_restart() -> None:
    async with working("a") as work:
        await work.fleet.requesters.submit(asked(), None)
        fetching = await work.runs.nth(1)
        assert await _legs_of(work.journal) == [("leg_begun", "r0", 1)]
        await work.fleet.stop()
        kept = (await work.journal.documents(KIND))[str(SITE)]
        was = FleetRecord.model_validate_json(kept)
        again = Dispatcher.restored(office(), work.fleet.dispatcher.setting, was.dispatcher)
        work.fleet = _fleet(work.site, work.runs, work.journal, again)
        work.fleet.start()
        fetching.ended.set_result(("finished", True))
        await work.runs.nth(2)
        assert await _legs_of(work.journal) == [
            ("leg_begun", "r0", 1),
            ("leg_ended", "r0", 1),
            ("leg_begun", "r0", 2),
        ]


@pytest.mark.parametrize(("boot", "told"), [("b1", (7.5, 2.0)), ("b2", (None, None))])
async def test_the_journal_tells_what_was_driven_for_a_leg_unless_the_robot_began_anew(
    boot: str, told: tuple[float | None, float | None]
) -> None:
    async with working("a") as work:
        work.site.odometers["r0"] = Odometer("b1", Driven(way_m=100.0, barred_s=5.0))
        await work.fleet.requesters.submit(asked(), None)
        fetching = await work.runs.nth(1)
        work.site.odometers["r0"] = Odometer(boot, Driven(way_m=107.5, barred_s=7.0))
        fetching.ended.set_result(("finished", True))
        await work.runs.nth(2)
        (ended,) = [e for e in await work.journal.read(0, 1000) if isinstance(e, ev.LegEnded)]
        assert (ended.driven_m, ended.barred_s) == told


async def _taken_out_while_it_drives(work: Work) -> None:
    """At 40 s, by what it shows; since it set out, at 100 m, it has not said what it drove."""
    work.site.odometers["r0"] = Odometer("b1", Driven(way_m=100.0, barred_s=5.0))
    await work.fleet.requesters.submit(asked(), None)
    await work.runs.nth(1)
    work.site.rolls_on.add("r0")
    work.site.shown_s = 40.0
    await work.fleet.operators.take_out("r0", "it is stuck", None)


async def _ended(journal: SqliteJournal) -> ev.LegEnded | None:
    legs = [each for each in await journal.read(0, 1000) if isinstance(each, ev.LegEnded)]
    return legs[0] if legs else None


async def _first_ended(work: Work) -> ev.LegEnded:
    async with asyncio.timeout(PATIENCE_S):
        while (ended := await _ended(work.journal)) is None:  # noqa: ASYNC110 - nobody tells of it
            await asyncio.sleep(0)
    return ended


async def test_a_leg_that_is_broken_off_counts_what_its_robot_says_once_it_stands() -> None:
    async with working("a") as work:
        await _taken_out_while_it_drives(work)
        assert await _ended(work.journal) is None, "its robot has not said how far it came"
        work.site.odometers["r0"] = Odometer("b1", Driven(way_m=108.0, barred_s=6.0))
        work.site.rolls_on.clear()
        work.site.changed()
        ended = await _first_ended(work)
        assert (ended.outcome, ended.driven_m, ended.barred_s) == ("withdrawn", 8.0, 1.0)
        assert ended.reason == "r0 was taken out of service: it is stuck"


async def test_the_leg_of_a_request_that_was_cancelled_says_so() -> None:
    async with working("a") as work:
        await work.fleet.requesters.submit(asked(), None)
        await work.runs.nth(1)
        await work.fleet.requesters.cancel("tea", None)
        ended = await _first_ended(work)
        assert (ended.outcome, ended.reason) == (
            "withdrawn",
            "the request is not wanted any more",
        )


async def test_what_a_robot_drove_is_not_known_that_never_says_that_it_stands(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(leg_execution, "RESTS_WITHIN_S", 0.0)
    async with working("a") as work:
        await _taken_out_while_it_drives(work)
        ended = await _first_ended(work)
        assert (ended.outcome, ended.driven_m, ended.barred_s) == ("withdrawn", None, None)


async def test_what_a_robot_drove_is_not_known_that_is_gone() -> None:
    async with working("a") as work:
        work.site.odometers["r0"] = Odometer("b1", Driven(way_m=100.0, barred_s=5.0))
        await work.fleet.requesters.submit(asked(), None)
        going = await work.runs.nth(1)
        work.site.gone.add("r0")
        going.ended.set_result(("failed", False))
        assert (await _first_ended(work)).driven_m is None


async def test_what_an_operator_tells_is_dated_by_when_it_is_told() -> None:
    async with working("a") as work:
        await _taken_out_while_it_drives(work)
        (told,) = [e for e in await work.journal.read(0, 1000) if isinstance(e, ev.FleetTold)]
        assert told.at_s == 40.0


async def test_after_a_restart_the_same_run_goes_on() -> None:
    async with working("a") as work:
        await work.fleet.requesters.submit(asked(), None)
        fetching = await work.runs.nth(1)
        await work.fleet.stop()
        kept = (await work.journal.documents(KIND))[str(SITE)]
        was = FleetRecord.model_validate_json(kept)
        setting = work.fleet.dispatcher.setting
        again = Dispatcher.restored(office(), setting, was.dispatcher)
        work.fleet = _fleet(work.site, work.runs, work.journal, again)
        work.fleet.start()
        fetching.ended.set_result(("finished", True))
        bringing = await work.runs.nth(2)
        assert bringing.behavior == "hand_over_item"


async def test_what_cannot_be_begun_now_is_tried_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(leg_execution, "TRIES_AGAIN_S", 0.0)
    async with working("a", refuse=3) as work:
        await work.fleet.requesters.submit(visit(), None)
        (await work.runs.nth(1)).ended.set_result(("finished", True))
        await work.until("visit", RequestStatus.DONE)


async def test_a_robot_that_is_too_early_waits_at_the_place() -> None:
    async with working("a") as work:
        await work.fleet.requesters.submit(asked(earliest_s=600.0), None)
        going = await work.runs.nth(1)
        assert (going.behavior, going.parameters) == ("go_to", {"place": "b", "near_m": MEETS_M})
        assert 500.0 < work.site.time.latest_s < 600.0
        going.ended.set_result(("finished", True))
        assert (await work.runs.nth(2)).behavior == "collect_item"
        assert work.site.time.latest_s >= 600.0


async def test_somebody_who_comes_stays_as_long_as_was_asked() -> None:
    async with working("a") as work:
        await work.fleet.requesters.submit(visit(stay_s=120.0), None)
        going = await work.runs.nth(1)
        came_s = max(0.0, work.site.time.latest_s)
        going.ended.set_result(("finished", True))
        await work.until("visit", RequestStatus.DONE)
        assert work.site.time.latest_s >= came_s + 120.0


async def test_what_failed_is_tried_again_later_and_fails_with_the_reason() -> None:
    async with working("a") as work:
        await work.fleet.requesters.submit(visit(), None)
        for number in (1, 2, 3):
            (await work.runs.nth(number)).ended.set_result(("failed", False))
        await work.until("visit", RequestStatus.FAILED)
        reason = await work.fleet.read(lambda all_: all_.view("visit").reason)
        assert "nobody came" in (reason or "")
        assert len(work.runs.runs) == 3


async def test_a_leg_that_ends_while_it_is_broken_off_is_not_begun_again() -> None:
    async with working("a") as work:
        await work.fleet.requesters.submit(visit(), None)
        await work.runs.nth(1)
        work.runs.aborted.clear()
        await work.fleet.requesters.cancel("visit", None)
        async with asyncio.timeout(PATIENCE_S):
            while await work.fleet.read(lambda all_: bool(all_.legs_under_way())):  # noqa: ASYNC110
                await asyncio.sleep(0)
        await work.fleet.requesters.submit(asked(), None)
        work.runs.aborted.set()
        fetching = await work.runs.nth(2)
        assert fetching.robot == "r0"


async def test_what_is_cancelled_is_broken_off() -> None:
    async with working("a") as work:
        await work.fleet.requesters.submit(visit(), None)
        going = await work.runs.nth(1)
        await work.fleet.requesters.cancel("visit", None)
        await work.until("visit", RequestStatus.CANCELLED)
        assert going.ended.result() == ("aborted", False)


async def test_another_robot_takes_over_from_one_that_is_gone() -> None:
    async with working("a", "e") as work:
        await work.fleet.requesters.submit(visit(place="b"), None)
        going = await work.runs.nth(1)
        assert going.robot == "r0"
        work.site.gone.add("r0")
        going.ended.set_result(("failed", False))
        instead = await work.runs.nth(2)
        assert instead.robot == "r1"
        instead.ended.set_result(("finished", True))
        await work.until("visit", RequestStatus.DONE)


async def test_a_robot_that_is_back_works_again_where_it_stands() -> None:
    async with working("a") as work:
        await work.fleet.requesters.submit(visit(place="b"), None)
        going = await work.runs.nth(1)
        work.site.gone.add("r0")
        going.ended.set_result(("failed", False))
        await work.until("visit", RequestStatus.WAITING)
        work.site.gone.clear()
        work.site.standing["r0"] = (31.0, 0.4, 0.0)
        work.site.changed()
        back = await work.runs.nth(2)
        assert back.robot == "r0"
        stands = work.fleet.dispatcher.fleet.robots["r0"]
        assert stands.works
        back.ended.set_result(("finished", True))
        await work.until("visit", RequestStatus.DONE)


async def test_a_robot_that_is_taken_out_breaks_off_and_another_takes_over() -> None:
    async with working("a", "e") as work:
        await work.fleet.requesters.submit(visit(place="b"), None)
        going = await work.runs.nth(1)
        assert going.robot == "r0"
        await work.fleet.operators.take_out("r0", "its wheel squeaks", None)
        assert going.ended.result() == ("aborted", False)
        instead = await work.runs.nth(2)
        assert instead.robot == "r1"
        instead.ended.set_result(("finished", True))
        await work.until("visit", RequestStatus.DONE)
        with pytest.raises(ConflictError, match="is out of service already"):
            await work.fleet.operators.take_out("r0", "its wheel squeaks", None)
        with pytest.raises(NotFoundError, match="this fleet has no robot 'r7'; it has r0, r1"):
            await work.fleet.operators.take_out("r7", "its wheel squeaks", None)


async def _with_tea_aboard_r0_fails(work: Work) -> FakeRun:
    """It is taken out with what it is to hand over; the run in which another one fetches that."""
    await work.fleet.requesters.submit(asked(), None)
    (await work.runs.nth(1)).ended.set_result(("finished", True))
    assert (await work.runs.nth(2)).behavior == "hand_over_item"
    work.site.standing["r0"] = (20.0, 0.0, 0.0)
    await work.fleet.operators.take_out("r0", "its wheel squeaks", None)
    fetching = await work.runs.nth(3)
    assert (fetching.robot, fetching.behavior) == ("r1", "collect_item")
    return fetching


async def test_who_fetches_something_says_in_whose_basket_it_is_and_its_robot_is_told() -> None:
    async with working("a", "e") as work:
        fetching = await _with_tea_aboard_r0_fails(work)
        assert fetching.parameters["held_by"] == "r0"
        assert fetching.parameters["away_m"] == 10.0
        assert work.site.failed == ["r0"], "the others know what they meet there"
        assert work.site.taken == {}
        fetching.ended.set_result(("finished", True))
        bringing = await work.runs.nth(4)
        assert (bringing.robot, bringing.behavior) == ("r1", "hand_over_item")
        assert work.site.taken == {"r0": ["tea"]}


async def test_what_a_robot_has_aboard_that_is_out_of_service_is_shown_until_it_is_fetched() -> (
    None
):
    async with working("a", "e") as work:
        fetching = await _with_tea_aboard_r0_fails(work)
        assert await _aboard(work) == [["tea"], []]
        fetching.ended.set_result(("finished", True))
        await work.runs.nth(4)
        assert await _aboard(work) == [[], ["tea"]]


async def _aboard(work: Work) -> list[list[str]]:
    view = await work.fleet.read(partial(FleetView.of, work.fleet))
    return [each.aboard for each in view.robots]


async def test_a_robot_that_is_put_back_brings_what_nobody_has_fetched() -> None:
    async with working("a", "e") as work:
        fetching = await _with_tea_aboard_r0_fails(work)
        await work.fleet.operators.put_back("r0", None)
        bringing = await work.runs.nth(4)
        assert (bringing.robot, bringing.behavior) == ("r0", "hand_over_item")
        assert fetching.ended.result() == ("aborted", False)
        bringing.ended.set_result(("finished", True))
        await work.until("tea", RequestStatus.DONE)
        assert len(work.runs.runs) == 4


async def test_what_a_robot_has_that_rode_on_after_it_failed_is_fetched_where_it_stands() -> None:
    async with working("a", "e") as work:
        fetching = await _with_tea_aboard_r0_fails(work)
        work.site.standing["r0"] = (9.5, 0.0, 0.0)
        work.site.changed()
        again = await work.runs.nth(4)
        assert fetching.ended.result() == ("aborted", False)
        assert again.robot == "r1"
        assert again.parameters["place"] != fetching.parameters["place"]


async def test_what_was_fetched_just_as_its_robot_was_put_back_is_brought_by_who_has_it() -> None:
    async with working("a", "e") as work:
        fetching = await _with_tea_aboard_r0_fails(work)
        work.runs.abort = _too_late  # type: ignore[method-assign]
        await work.fleet.operators.put_back("r0", None)
        fetching.ended.set_result(("finished", True))
        bringing = await work.runs.nth(4)
        assert (bringing.robot, bringing.behavior) == ("r1", "hand_over_item")
        assert work.site.taken == {"r0": ["tea"]}


async def _too_late(*_: object) -> Any:
    raise ConflictError("it has ended")


async def test_a_robot_that_is_out_of_service_works_only_once_it_is_put_back() -> None:
    async with working("a") as work:
        await work.fleet.operators.take_out("r0", "its wheel squeaks", None)
        kept = (await work.journal.documents(KIND))[str(SITE)]
        assert FleetRecord.model_validate_json(kept).out_of_service == {"r0": "its wheel squeaks"}
        with pytest.raises(RequestRefusedError, match="no robot works"):
            await work.fleet.requesters.submit(visit(), None)
        await work.fleet.operators.put_back("r0", None)
        await work.fleet.requesters.submit(visit(), None)
        (await work.runs.nth(1)).ended.set_result(("finished", True))
        await work.until("visit", RequestStatus.DONE)
        with pytest.raises(ConflictError, match="is in service"):
            await work.fleet.operators.put_back("r0", None)


async def test_a_way_that_somebody_found_blocked_keeps_robots_off_it() -> None:
    async with working("a") as work:
        await work.fleet.operators.found(WayReport(finding="blocked", between=["b", "c"]), None)
        with pytest.raises(RequestRefusedError):
            await work.fleet.requesters.submit(visit(place="d", latest_s=200.0), None)
        await work.fleet.operators.found(WayReport(finding="open", between=["b", "c"]), None)
        await work.fleet.requesters.submit(visit(place="d", latest_s=200.0), None)
        assert (await work.runs.nth(1)).parameters == {"place": "d", "near_m": MEETS_M}


async def test_a_door_that_is_not_there_is_not_closed() -> None:
    async with working("a") as work:
        with pytest.raises(WrongInputError, match="no door is between 'b' and 'c': say 'blocked'"):
            await work.fleet.operators.found(
                WayReport(finding="door_closed", between=["b", "c"]), None
            )
    with pytest.raises(ValidationError, match="a way is between two places, not 'b' twice"):
        WayReport(finding="blocked", between=["b", "b"])


async def test_a_way_is_not_closed_until_what_is_over() -> None:
    async with working("a") as work:
        work.site.shown_s = 105.0
        past = WayReport(finding="blocked", between=["b", "c"], until_s=1.0)
        with pytest.raises(WrongInputError, match=r"must be after 105 s, .* but it is 1 s"):
            await work.fleet.operators.found(past, None)
        assert not list(work.fleet.closed_ways.now())
        await work.fleet.operators.found(past.model_copy(update={"until_s": 105.5}), None)
        assert len(list(work.fleet.closed_ways.now())) == 1


async def test_a_fault_within_ends_the_leg_and_not_the_fleet(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    async def broken(*_: object) -> None:
        raise ZeroDivisionError

    async with working("a") as work:
        monkeypatch.setattr(work.runs, "start_run_of", broken)
        work.site.standing["r0"] = (1.0, 0.0, 0.0)
        await work.fleet.requesters.submit(visit(), None)
        await work.until("visit", RequestStatus.FAILED)
        reason = await work.fleet.read(lambda all_: all_.view("visit").reason)
        events = await work.journal.read(0, 1000)
    stood = {each.at for each in events if isinstance(each, ev.LegEnded)}
    assert stood == {"f/a"}, "it has never set out"
    assert "a fault of Mend's own" in (reason or "")
    assert "could not be carried out" in caplog.text


async def test_what_somebody_had_left_out_is_not_done() -> None:
    async with working("a") as work:
        await work.fleet.requesters.submit(asked(), None)
        (await work.runs.nth(1)).ended.set_result(("finished", True))
        bringing = await work.runs.nth(2)
        assert bringing.behavior == "hand_over_item"
        bringing.ended.set_result(("finished", False))
        # It is tried again later: until then its robot waits at the place.
        going = await work.runs.nth(3)
        assert (going.behavior, going.parameters) == ("go_to", {"place": "d", "near_m": MEETS_M})
        going.ended.set_result(("finished", True))
        assert (await work.runs.nth(4)).behavior == "hand_over_item"
        assert await work.status("tea") is RequestStatus.UNDER_WAY


async def test_a_robot_with_nothing_to_do_makes_way_for_one_that_comes() -> None:
    async with working("b", "e") as work:
        await work.fleet.requesters.submit(visit(place="c"), None)
        first = await work.runs.nth(1)
        assert first.robot == "r0"
        first.ended.set_result(("finished", True))
        await work.until("visit", RequestStatus.DONE)
        await work.fleet.operators.take_out("r0", "it is to stay", None)
        await work.fleet.requesters.submit(visit("again", place="c"), None)
        assert (await work.runs.nth(2)).robot == "r1"
        await work.fleet.operators.put_back("r0", None)
        away = await work.runs.nth(3)
        assert (away.robot, away.behavior, away.parameters) == ("r0", "go_to", {"place": "b"})
        away.ended.set_result(("finished", True))
        async with asyncio.timeout(PATIENCE_S):
            while await work.fleet.read(_place_of_r0) != "f/b":  # noqa: ASYNC110 - as above
                await asyncio.sleep(0)
        assert len(work.runs.runs) == 3


def _place_of_r0(dispatcher: Dispatcher) -> str:
    return dispatcher.building.graph.places[dispatcher.fleet.robots["r0"].place].name


async def test_who_says_that_an_elevator_is_dead_names_one_that_there_is() -> None:
    async with working("a") as work:
        with pytest.raises(NotFoundError, match="there is no elevator 'lift9'"):
            await work.fleet.operators.found(
                WayReport(finding="elevator_dead", elevator="lift9"), None
            )


async def test_no_plan_is_made_or_read_in_the_event_loop(monkeypatch: pytest.MonkeyPatch) -> None:
    threads: dict[str, set[int]] = defaultdict(set)

    def watched(name: str) -> Callable[..., Any]:
        does = getattr(Dispatcher, name)

        def noting(*args: Any, **kwargs: Any) -> Any:
            threads[name].add(get_ident())
            return does(*args, **kwargs)

        return noting

    every = ("_advance", "snapshot", "stops", "view", "views", "wakes_s", "taken_out")
    async with working("a", "c") as work:
        for name in every:
            monkeypatch.setattr(Dispatcher, name, watched(name))
        await work.fleet.requesters.submit(visit("wait", place="b", stay_s=5.0), None)
        await work.fleet.requesters.submit(asked(earliest_s=6000.0), None)
        (await work.runs.nth(1)).ended.set_result(("finished", True))
        await work.until("wait", RequestStatus.DONE)
        way = WayReport(finding="blocked", between=["f/d", "f/e"])
        await work.fleet.operators.found(way, None)
        await work.fleet.operators.take_out("r1", "a wheel squeaks", None)
        await work.fleet.operators.put_back("r1", None)
        await work.fleet.requesters.cancel("tea", None)
        await work.fleet.requests()
    assert set(threads) >= {"_advance", "snapshot", "view", "views", "wakes_s", "taken_out"}
    assert [name for name, seen in threads.items() if get_ident() in seen] == []


async def test_who_is_to_stop_while_a_plan_is_made_waits_until_it_is() -> None:
    """Else somebody else would change what is still being changed."""
    begun, may_end = ThreadEvent(), ThreadEvent()

    def takes_long(_: Dispatcher) -> None:
        begun.set()
        may_end.wait()

    async with working("a") as work:
        reading = asyncio.create_task(work.fleet.read(takes_long))
        await asyncio.to_thread(begun.wait)
        reading.cancel()
        other = asyncio.create_task(work.fleet.requests())
        await asyncio.sleep(0)
        await asyncio.sleep(0)
        assert not reading.done()
        assert not other.done()
        may_end.set()
        with pytest.raises(asyncio.CancelledError):
            await reading
        assert await other == []
