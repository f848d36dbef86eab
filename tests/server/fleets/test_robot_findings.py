"""What robots find on their ways changes the plan where another way leads to the place."""

import asyncio
from collections.abc import Callable
from datetime import UTC, datetime
from uuid import UUID

import pytest
from dispatch_office import fleet_of, visit
from test_legs_as_runs import SCENE, SITE, FakeRun, FakeRuns, FakeSite

from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.dispatch.leg import Finding, Found
from mend.fleet.dispatch.setting import Policy
from mend.fleet.dispatch.snapshot import DispatcherSnapshot
from mend.fleet.requests import RequestStatus
from mend.maps.building.building import Building, BuildingDocument, Floor, FloorPlace, Lane
from mend.maps.navigation import NavigationGraph, Place, Way
from mend.robots.link.messages import LASER, Detection
from mend.server.access.deeds import deed_of
from mend.server.fleets.closed_ways import ClosedWays
from mend.server.fleets.fleet_at_work import OTHERS_S, FleetAtWork
from mend.server.fleets.fleet_record import FleetRecord
from mend.server.fleets.fleets import KIND
from mend.server.fleets.found_ways import FoundWays
from mend.server.fleets.place_names import PlaceNames
from mend.server.fleets.robot_findings import is_led_round
from mend.server.journal import events as ev
from mend.server.journal.journal import Entry
from mend.server.journal.sqlite import SqliteJournal
from mend.server.sites.requests import FleetOptions

NOW = datetime(2026, 1, 2, tzinfo=UTC)
BC = frozenset(("f/b", "f/c"))
ROW = ("ab", "bc", "cd", "de")
RING = (*ROW, "ea")


PATIENT = Policy(slack_s=3600.0)
"""Time leaps here while a robot comes to rest: nothing is late for that."""


class Work:
    """A fleet, unless said otherwise of one robot at `a`, in rooms with such lanes between them."""

    def __init__(
        self,
        lanes: tuple[str, ...],
        snapshot: DispatcherSnapshot | None = None,
        starts: str = "a",
    ) -> None:
        places = {name: FloorPlace(x=10.0 * n, y=0.0) for n, name in enumerate("abcde")}
        floor = Floor(places=places, lanes=tuple(Lane(between=(a, b)) for a, b in lanes))
        building = Building(BuildingDocument(building="office", floors={"f": floor}))
        self.site, self.journal = FakeSite(), SqliteJournal(":memory:")
        self.runs = FakeRuns(self.site)
        self.dispatcher = (
            Dispatcher(building, fleet_of(*starts, policy=PATIENT))
            if snapshot is None
            else Dispatcher.restored(building, fleet_of(*starts, policy=PATIENT), snapshot)
        )
        names, options = PlaceNames(building, SCENE), FleetOptions()
        self.fleet = FleetAtWork(
            self.site,
            self.dispatcher,
            names,
            options,
            self.runs,
            self.journal,
            None,
            _now,
            most_open=100,
        )

    async def __aenter__(self) -> "Work":
        self.fleet.start()
        return self

    async def __aexit__(self, *_: object) -> None:
        await self.fleet.stop()
        self.journal.close()

    async def raised(self, run: FakeRun, issue: str, *between: str) -> None:
        self.site.runs[run.robot] = run.id
        seen = Detection(camera=LASER, explanation="it is barred", between=list(between))
        event = ev.IssueRaised(
            time=1.0,
            wall_time=NOW,
            run=run.id,
            node="/0",
            name="go",
            robot=run.robot,
            issue=issue,
            object=None,
            place="c",
            execution=UUID(int=2),
            step=0,
            interrupts=True,
            detection=seen,
        )
        await self.journal.append(Entry(events=[event]))

    async def found(self, run: FakeRun, finding: str, *between: str) -> None:
        event = ev.WayFound(
            time=1.0,
            wall_time=NOW,
            run=run.id,
            robot=run.robot,
            finding=finding,
            between=list(between),
        )
        await self.journal.append(Entry(events=[event]))

    async def events(self) -> list[ev.Event]:
        return await self.journal.read(0, 1000)

    async def until(self, comes: Callable[[Dispatcher], bool]) -> None:
        async with asyncio.timeout(20.0):
            while not await self.fleet.read(comes):  # noqa: ASYNC110 - nobody tells of it
                await asyncio.sleep(0)


def _now() -> datetime:
    return NOW


@pytest.mark.parametrize(
    ("issue", "words"), [("blocked", "blocked"), ("door_closed", "door closed")]
)
async def test_what_a_robot_finds_counts_until_one_has_passed_there(issue: str, words: str) -> None:
    async with Work(RING) as work:
        work.site.stands_still = True
        await work.fleet.requesters.submit(visit(place="c"), None)
        going = await work.runs.nth(1)
        await work.raised(going, issue, "f/b", "f/c")
        await work.until(lambda all_: BC in all_.closed_until_s())
        await work.until(lambda _: work.site.kept_off == {BC})
        work.site.standing["r0"] = (20.0, 0.0, 0.0)
        last = work.runs.runs[-1]
        last.ended.set_result(("finished", True))
        await work.until(lambda all_: all_.view("visit").status is RequestStatus.DONE)
        assert BC in work.dispatcher.closed_until_s(), "it may have gone round"
        await work.found(going, "open", "f/c", "f/b")
        await work.until(lambda all_: not all_.closed_until_s())
        await work.until(lambda _: not work.site.kept_off)
        told = [each for each in await work.events() if isinstance(each, ev.FleetTold)]
        way, back = "found of the way between f/b and f/c", "found of the way between f/c and f/b"
        assert [each.told for each in told] == [f"{way}: {words}", f"{back}: open"]
        assert [each.finder for each in told] == ["r0", "r0"]
        assert [deed_of(each) for each in told] == [None, None]


async def test_what_a_robot_goes_round_by_itself_is_closed_to_all() -> None:
    async with Work(RING) as work:
        await work.fleet.requesters.submit(visit(place="c"), None)
        going = await work.runs.nth(1)
        await work.found(going, "blocked", "f/b", "f/c")
        await work.until(lambda _: work.site.kept_off == {BC})


@pytest.mark.parametrize(
    ("x", "works", "finding", "closes"),
    [
        (15.0, True, "blocked", False),
        (15.0, False, "blocked", True),
        (18.0, True, "blocked", True),
        (5.0, True, "blocked", True),
        (15.0, True, "door_closed", True),
    ],
    ids=["before it", "failed before it", "farther on", "elsewhere", "a door"],
)
def test_what_another_robot_bars_that_works_is_closed_to_nobody(
    x: float, finding: str, *, works: bool, closes: bool
) -> None:
    dispatcher = Work(RING, starts="ae").dispatcher
    dispatcher.submit(visit(place="c"), 0.0)
    (leg,) = dispatcher.legs_to_begin(0.0)
    dispatcher.began(leg, 0.0)
    (other,) = {"r0", "r1"} - {leg.robot}
    if not works:
        dispatcher.robot_failed(other, None, "a squeak", 1.0)
    at = {other: (x, 0.3, 0.0), leg.robot: (14.2, 0.0, 0.0)}
    found_ways = FoundWays(dispatcher, ClosedWays(dispatcher, ()), at.get)
    found = Found(finding=Finding(finding), between=("f/b", "f/c"), by=leg.robot)
    assert found_ways.take(found, 2.0) is closes
    assert (BC in dispatcher.closed_until_s()) is closes


async def test_what_was_closed_before_a_restart_is_kept_off_after_it() -> None:
    async with Work(RING) as work:
        await work.fleet.requesters.submit(visit(place="c"), None)
        await work.found(await work.runs.nth(1), "blocked", "f/b", "f/c")
        await work.until(lambda _: work.site.kept_off == {BC})
        kept = (await work.journal.documents(KIND))[str(SITE)]
        snapshot = FleetRecord.model_validate_json(kept).dispatcher
    async with Work(RING, snapshot) as again:
        await again.until(lambda _: again.site.kept_off == {BC})


async def test_where_no_other_way_leads_people_help_and_the_plan_stays() -> None:
    async with Work(ROW) as work:
        await work.fleet.requesters.submit(visit(place="c"), None)
        going = await work.runs.nth(1)
        await work.raised(going, "blocked", "f/b", "f/c")
        # What comes after it has been heard too says that this one was.
        await work.raised(going, "door_closed", "f/d", "f/e")
        await work.until(lambda all_: bool(all_.closed_until_s()))
        assert BC not in work.dispatcher.closed_until_s()


async def test_before_people_are_asked_a_robot_from_the_other_side_goes_instead() -> None:
    async with Work(ROW, starts="ae") as work:
        await work.fleet.requesters.submit(visit(place="b"), None)
        going = await work.runs.nth(1)
        assert (going.robot, work.site.asks_after_s) == ("r0", OTHERS_S)
        work.site.standing["r0"] = (0.0, 0.0, 0.0)
        await work.found(going, "blocked", "f/a", "f/b")
        instead = await work.runs.nth(2)
        assert (instead.robot, instead.parameters["place"]) == ("r1", "b")
        assert going.ended.result() == ("aborted", False)
        await work.raised(going, "blocked", "f/a", "f/b")
        instead.ended.set_result(("finished", True))
        await work.until(lambda all_: all_.view("visit").status is RequestStatus.DONE)
        changes = [e for e in await work.events() if isinstance(e, ev.PlanChanged)]
        taken = [
            each for each in changes if each.reason.startswith("r1 takes over 'visit' from r0")
        ]
        assert len(taken) == 1
        told = [each.told for each in await work.events() if isinstance(each, ev.FleetTold)]
        assert told == ["found of the way between f/a and f/b: blocked"]
        assert len(work.runs.runs) == 2


async def test_others_are_asked_once_and_what_nobody_takes_over_people_are_asked_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    tried: list[Found] = []
    monkeypatch.setattr(Dispatcher, "take_over", lambda _self, found, _now_s: tried.append(found))
    async with Work(ROW, starts="ae") as work:
        await work.fleet.requesters.submit(visit(place="b"), None)
        going = await work.runs.nth(1)
        await work.found(going, "blocked", "f/a", "f/b")
        await work.raised(going, "blocked", "f/a", "f/b")
        # What comes after it has been heard too says that this one was.
        await work.raised(going, "door_closed", "f/d", "f/e")
        await work.until(lambda all_: bool(all_.closed_until_s()))
        assert [each.between for each in tried] == [("f/a", "f/b")]


@pytest.mark.parametrize(("one_way", "led"), [(False, True), (True, False)])
def test_a_way_that_leads_only_back_leads_round_nothing(one_way: bool, led: bool) -> None:
    places = [Place(name, float(n), 0.0) for n, name in enumerate("abc")]
    ways = [Way("a", "b"), Way("b", "c"), Way("c", "a", one_way=one_way)]
    found = Found(finding=Finding.BLOCKED, between=("b", "c"), by="r0")
    assert is_led_round(NavigationGraph(places, ways), (), found, "c") is led
