"""Robots charge by themselves before their batteries are low, and leave for what is to be done."""

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from datetime import UTC, datetime
from itertools import pairwise

import pytest
from dispatch_office import asked, fleet_of, make_leg, visit
from hypothesis import given, settings
from hypothesis import strategies as st
from test_legs_as_runs import PATIENCE_S, SCENE, FakeRuns, FakeSite, Work

from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.requests import RequestStatus
from mend.maps.building.building import (
    Building,
    BuildingDocument,
    Floor,
    FloorPlace,
    Lane,
    PlaceKind,
)
from mend.robots.link.messages import IDENTITY, Poses
from mend.server.fleets.charging import (
    BUSY_BELOW,
    IDLE_BELOW,
    LEAVES_AT,
    who_charges,
    who_wants_another_away,
)
from mend.server.fleets.errands import BROKEN_OFF
from mend.server.fleets.fleet_at_work import FleetAtWork
from mend.server.fleets.place_names import PlaceNames
from mend.server.journal import events as ev
from mend.server.journal.sqlite import SqliteJournal
from mend.server.sites.requests import FleetOptions

ROOMS = "abcde"
EVERYWHERE = {f"f/{each}" for each in ROOMS}


def building(chargers: str = "ae") -> Building:
    """The rooms a to e in a row, some of which have a charger."""
    places = {
        name: FloorPlace(
            x=10.0 * number,
            y=0.0,
            kind=PlaceKind.CHARGER if name in chargers else PlaceKind.ROOM,
        )
        for number, name in enumerate(ROOMS)
    }
    lanes = tuple(Lane(between=each) for each in pairwise(ROOMS))
    floor = Floor(places=places, lanes=lanes)
    return Building(BuildingDocument(building="office", floors={"f": floor}))


def going(of: Dispatcher, shares: dict[str, float]) -> list[tuple[str, str]]:
    return list(who_charges(of, shares, EVERYWHERE))


def test_who_has_nothing_to_do_and_holds_little_goes_to_the_nearest_charger() -> None:
    of = Dispatcher(building(), fleet_of("b", "d"))
    assert going(of, {"r0": IDLE_BELOW, "r1": 0.9}) == []
    assert going(of, {"r0": IDLE_BELOW - 0.01, "r1": 0.9}) == [("r0", "f/a")]
    assert going(of, {"r0": 0.3, "r1": 0.25}) == [("r1", "f/e"), ("r0", "f/a")]


def test_who_stands_at_a_charger_charges_there() -> None:
    of = Dispatcher(building(), fleet_of("a", "b"))
    assert going(of, {"r0": 0.3}) == [("r0", "f/a")]
    assert going(of, {"r1": 0.3}) == [("r1", "f/e")], "where another one stands is not free"


def test_a_charger_that_somebody_is_on_the_way_to_is_not_free() -> None:
    of = Dispatcher(building(), fleet_of("b", "d"))
    assert list(who_charges(of, {"r0": 0.3}, EVERYWHERE, {"f/a"})) == [("r0", "f/e")]
    assert list(who_charges(of, {"r0": 0.3}, EVERYWHERE, {"f/a", "f/e"})) == []


def wanted(of: Dispatcher, shares: dict[str, float]) -> list[tuple[str, str]]:
    return list(who_wants_another_away(of, shares, EVERYWHERE))


def test_who_holds_enough_and_has_nothing_to_do_is_to_leave_the_charger() -> None:
    of = Dispatcher(building("a"), fleet_of("a", "c"))
    assert wanted(of, {"r0": LEAVES_AT, "r1": 0.3}) == [("r1", "f/a")]
    assert wanted(of, {"r0": LEAVES_AT - 0.01, "r1": 0.3}) == [], "it charges itself"
    assert wanted(of, {"r0": 1.0, "r1": IDLE_BELOW}) == [], "nobody needs it"
    assert wanted(of, {"r1": 0.3}) == [], "somebody has the robot there"


def test_of_two_who_wait_for_a_charger_the_one_that_holds_less_comes_first() -> None:
    of = Dispatcher(building("a"), fleet_of("a", "b", "e"))
    assert wanted(of, {"r0": 1.0, "r1": 0.3, "r2": 0.2}) == [("r2", "f/a")]


def test_who_has_something_to_do_does_not_leave_a_charger_for_another_one() -> None:
    of = Dispatcher(building("a"), fleet_of("a", "c"))
    of.submit(visit(place="b"), 0.0)
    busy = {name: not stops for name, stops in of.fleet.stops().items()}
    assert [who for who, _ in wanted(of, {"r0": 1.0, "r1": 0.3})] == ["r1"] * busy["r0"]


def test_who_finds_no_charger_free_goes_on() -> None:
    of = Dispatcher(building("a"), fleet_of("a", "b"))
    assert going(of, {"r1": 0.01}) == []
    assert list(who_charges(of, {"r0": 0.01}, {"f/b"})) == []


def test_who_has_something_to_do_goes_on_until_it_would_have_to_ask() -> None:
    of = Dispatcher(building(), fleet_of("b"))
    of.submit(visit(place="d"), 0.0)
    assert going(of, {"r0": BUSY_BELOW}) == []
    assert going(of, {"r0": BUSY_BELOW - 0.01}) == [("r0", "f/a")]


def test_who_has_something_aboard_brings_it_first() -> None:
    of = Dispatcher(building(), fleet_of("b"))
    of.submit(asked("tea", "b", "d"), 0.0)
    make_leg(of, 0.0, 5.0)
    assert going(of, {"r0": 0.01}) == []


def test_who_does_not_work_charges_nowhere() -> None:
    of = Dispatcher(building(), fleet_of("b", "d"))
    of.robot_failed("r0", None, "a squeak", 1.0)
    assert going(of, {"r0": 0.1}) == []


@given(
    st.lists(st.sampled_from(ROOMS), min_size=1, max_size=4),
    st.lists(st.floats(0.0, 1.0), min_size=4, max_size=4),
    st.sets(st.sampled_from(ROOMS), max_size=3),
)
@settings(deadline=None, max_examples=60)
def test_each_goes_to_a_charger_of_its_own_where_nobody_else_stands(
    starts: list[str], holds: list[float], chargers: set[str]
) -> None:
    of = Dispatcher(building("".join(chargers)), fleet_of(*starts))
    shares = {f"r{n}": holds[n] for n in range(len(starts))}
    found = going(of, shares)
    assert len({to for _, to in found}) == len(found) == len({who for who, _ in found})
    for who, to in found:
        others = {f"f/{at}" for n, at in enumerate(starts) if f"r{n}" != who}
        assert to.removeprefix("f/") in chargers
        assert to not in others
        assert shares[who] < IDLE_BELOW


# --- a fleet at work ------------------------------------------------------------------------------


@asynccontextmanager
async def charging(*starts: str) -> AsyncIterator[Work]:
    site, journal = FakeSite(), SqliteJournal(":memory:")
    site.stands_still = True
    runs = FakeRuns(site)
    places, now = PlaceNames(building(), SCENE), datetime(2026, 1, 2, tzinfo=UTC)
    dispatcher = Dispatcher(building(), fleet_of(*starts))
    fleet = FleetAtWork(
        site,  # type: ignore[arg-type]
        dispatcher,
        places,
        FleetOptions(),
        runs,
        journal,
        None,
        lambda: now,
        most_open=100,
    )
    try:
        yield Work(site, runs, journal, fleet)
    finally:
        await fleet.stop()
        journal.close()


async def until(comes: Callable[[], bool]) -> None:
    async with asyncio.timeout(PATIENCE_S):
        while not comes():  # noqa: ASYNC110 - nobody tells of it
            await asyncio.sleep(0)


async def test_a_robot_with_nothing_to_do_charges_and_then_does_what_comes() -> None:
    async with charging("b") as work:
        work.site.batteries["r0"] = 0.3
        work.fleet.start()
        at_charger = await work.runs.nth(1)
        assert (at_charger.behavior, at_charger.parameters) == ("charge", {"place": "a"})
        begun = [e for e in await work.journal.read(0, 1000) if isinstance(e, ev.ErrandBegun)]
        assert [(each.robot, each.place, each.charges) for each in begun] == [("r0", "f/a", True)]
        work.site.batteries["r0"] = 0.95
        at_charger.ended.set_result(("finished", True))
        await until(lambda: not work.fleet.errands)
        await work.fleet.requesters.submit(visit(place="c"), None)
        (await work.runs.nth(2)).ended.set_result(("finished", True))
        await work.until("visit", RequestStatus.DONE)


@pytest.mark.parametrize("share", [LEAVES_AT, 0.8])
async def test_who_holds_enough_leaves_for_what_is_to_be_done(share: float) -> None:
    async with charging("b") as work:
        work.site.batteries["r0"] = 0.3
        work.fleet.start()
        at_charger = await work.runs.nth(1)
        await work.fleet.requesters.submit(visit(place="c"), None)
        await until(lambda: bool(work.fleet.dispatcher.fleet.stops()["r0"]))
        assert not at_charger.ended.done(), "it holds too little to leave"
        work.site.batteries["r0"] = share
        work.site.changed()
        going_on = await work.runs.nth(2)
        assert at_charger.ended.result() == ("aborted", False)
        assert (going_on.behavior, going_on.parameters["place"]) == ("go_to", "c")


async def test_the_only_robot_leaves_its_charger_for_what_has_become_due_meanwhile() -> None:
    async with charging("b") as work:
        work.site.batteries["r0"] = 0.3
        work.fleet.start()
        at_charger = await work.runs.nth(1)
        await work.fleet.requesters.submit(visit(place="c"), None)
        await until(lambda: bool(work.fleet.dispatcher.fleet.stops()["r0"]))
        for time_s, share in ((5.0, LEAVES_AT - 0.01), (6.0, LEAVES_AT)):
            assert not at_charger.ended.done()
            work.site.batteries["r0"] = share
            said = Poses(time=time_s, tool=IDENTITY, opening_m=0.0, battery=share)
            work.fleet.saw("r0", said)
            await asyncio.sleep(0)
        assert (await work.runs.nth(2)).parameters["place"] == "c"


async def test_who_holds_little_by_now_charges_though_nothing_else_happens() -> None:
    async with charging("b") as work:
        work.site.batteries["r0"] = IDLE_BELOW
        work.fleet.start()
        await until(lambda: not work.fleet._book.changed.is_set())
        for time_s, share in ((5.0, IDLE_BELOW), (6.0, IDLE_BELOW - 0.01)):
            assert not work.fleet.errands
            work.site.batteries["r0"] = share
            said = Poses(time=time_s, tool=IDENTITY, opening_m=0.0, battery=share)
            work.fleet.saw("r0", said)
            await asyncio.sleep(0)
        assert (await work.runs.nth(1)).behavior == "charge"


async def test_nobody_is_sent_to_a_charger_that_another_one_is_on_its_way_to() -> None:
    async with charging("b", "c") as work:
        work.site.batteries |= {"r0": 0.3, "r1": 0.9}
        work.fleet.start()
        await work.runs.nth(1)
        work.site.batteries["r1"] = 0.3
        work.site.changed()
        assert (await work.runs.nth(2)).parameters == {"place": "e"}
        assert [each.place for each in work.fleet.errands.values()] == ["f/a", "f/e"]


async def test_who_leaves_its_charger_is_not_said_to_have_been_stopped_by_a_person() -> None:
    async with charging("b") as work:
        work.site.batteries["r0"] = 0.3
        work.fleet.start()
        await work.runs.nth(1)
        await work.fleet.break_off_errands()
        assert not work.fleet.errands
        told = [e for e in await work.journal.read(0, 1000) if isinstance(e, ev.ErrandEnded)]
        assert [(each.came, each.reason) for each in told] == [(False, BROKEN_OFF)]


async def test_an_errand_that_ends_while_it_is_broken_off_ends_once_and_others_begin() -> None:
    async with charging("b") as work:
        work.site.batteries["r0"] = 0.3
        work.fleet.start()
        await work.runs.nth(1)
        await work.fleet.requesters.submit(visit(place="c"), None)
        work.runs.aborted.clear()
        work.site.batteries["r0"] = LEAVES_AT
        work.site.changed()
        await until(lambda: not work.fleet.errands)
        work.runs.aborted.set()
        (await work.runs.nth(2)).ended.set_result(("finished", True))
        await work.until("visit", RequestStatus.DONE)
        await until(lambda: work.site.rests("r0"))
        await work.fleet.operators.send("r0", "f/d", None)
        assert (await work.runs.nth(3)).parameters["place"] == "d"
        told = [e for e in await work.journal.read(0, 1000) if isinstance(e, ev.ErrandEnded)]
        assert len(told) == 1


async def test_who_could_not_charge_does_not_try_it_again_at_once() -> None:
    async with charging("b") as work:
        work.site.batteries["r0"] = 0.3
        work.fleet.start()
        (await work.runs.nth(1)).ended.set_result(("failed", False))
        await until(lambda: not work.fleet.errands)
        await work.fleet.requesters.submit(visit(place="c"), None)
        instead = await work.runs.nth(2)
        assert instead.behavior == "go_to"


async def test_robots_whose_batteries_nobody_knows_of_stay() -> None:
    async with charging("b") as work:
        work.fleet.start()
        await work.fleet.requesters.submit(visit(place="c"), None)
        assert (await work.runs.nth(1)).behavior == "go_to"
