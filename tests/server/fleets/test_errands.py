"""Robots that carry out no leg are sent somewhere, and plans know where they have come to."""

import asyncio
from collections.abc import Callable
from typing import Any

import pytest
from dispatch_office import asked, office, visit
from test_legs_as_runs import PATIENCE_S, Work, _fleet, working

from mend.errors import ConflictError, NotFoundError
from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.requests import RequestStatus
from mend.server.access.roles import Role
from mend.server.fleets.fleet_record import FleetRecord
from mend.server.fleets.fleets import KIND
from mend.server.journal import events as ev

OLGA = ev.Author(principal="olga", role=Role.OPERATOR)


def place_of(robot: str) -> Callable[[Dispatcher], str]:
    return lambda of: of.building.graph.places[of.fleet.robots[robot].place].name


async def until_no_errand(work: Work) -> None:
    async with asyncio.timeout(PATIENCE_S):
        while work.fleet.errands:  # noqa: ASYNC110 - nobody tells of it
            await asyncio.sleep(0)
        # What came of it is journaled before anybody else has their turn.
        await work.fleet.read(lambda _: None)


async def ends(work: Work) -> list[ev.ErrandEnded]:
    return [e for e in await work.journal.read(0, 1000) if isinstance(e, ev.ErrandEnded)]


async def test_a_robot_goes_where_it_is_sent_and_the_plan_knows() -> None:
    async with working("a") as work:
        await work.fleet.operators.send("r0", "d", OLGA)
        going = await work.runs.nth(1)
        assert (going.behavior, going.parameters) == ("go_to", {"place": "d"})
        (begun,) = [e for e in await work.journal.read(0, 1000) if isinstance(e, ev.ErrandBegun)]
        assert (begun.robot, begun.place, begun.start, begun.author) == ("r0", "f/d", "f/a", OLGA)
        going.ended.set_result(("finished", True))
        await until_no_errand(work)
        assert await work.fleet.read(place_of("r0")) == "f/d"
        (ended,) = await ends(work)
        assert (ended.came, ended.reason, ended.at) == (True, None, "f/d")


async def test_what_is_asked_meanwhile_begins_once_the_robot_is_there() -> None:
    async with working("a") as work:
        await work.fleet.operators.send("r0", "d", None)
        going = await work.runs.nth(1)
        await work.fleet.requesters.submit(asked(), None)
        assert await work.status("tea") is RequestStatus.BOOKED
        assert len(work.runs.runs) == 1
        going.ended.set_result(("finished", True))
        fetching = await work.runs.nth(2)
        assert (fetching.behavior, fetching.parameters["place"]) == ("collect_item", "b")
        begun = [e for e in await work.journal.read(0, 1000) if isinstance(e, ev.LegBegun)]
        assert [each.start for each in begun] == ["f/d"]


async def test_who_does_not_come_there_is_known_where_it_stands() -> None:
    async with working("a") as work:
        await work.fleet.operators.send("r0", "e", None)
        going = await work.runs.nth(1)
        work.site.standing["r0"] = (19.0, 0.4, 0.0)
        going.ended.set_result(("failed", False))
        await until_no_errand(work)
        assert await work.fleet.read(place_of("r0")) == "f/c"
        (ended,) = await ends(work)
        assert (ended.came, ended.reason, ended.at) == (False, "nobody came", "f/c")


async def test_who_is_at_work_or_on_its_way_or_away_is_not_sent() -> None:
    async with working("a", "e") as work:
        with pytest.raises(NotFoundError, match="this fleet has no robot 'r7'"):
            await work.fleet.operators.send("r7", "b", None)
        with pytest.raises(NotFoundError):
            await work.fleet.operators.send("r0", "attic", None)
        await work.fleet.requesters.submit(visit(place="b"), None)
        await work.runs.nth(1)
        with pytest.raises(ConflictError, match="'r0' is at work for 'visit' at f/b: send it once"):
            await work.fleet.operators.send("r0", "c", None)
        await work.fleet.operators.send("r1", "d", None)
        with pytest.raises(ConflictError, match="'r1' is on its way to f/d"):
            await work.fleet.operators.send("r1", "e", None)
        (await work.runs.nth(2)).ended.set_result(("finished", True))
        await until_no_errand(work)
        work.site.gone.add("r1")
        with pytest.raises(ConflictError, match="'r1' is not connected"):
            await work.fleet.operators.send("r1", "e", None)
        assert len(work.runs.runs) == 2


async def test_who_is_out_of_service_may_be_sent_and_stays_out_of_it() -> None:
    async with working("a") as work:
        await work.fleet.operators.take_out("r0", "its wheel squeaks", None)
        await work.fleet.operators.send("r0", "e", OLGA)
        (await work.runs.nth(1)).ended.set_result(("finished", True))
        await until_no_errand(work)
        assert not work.fleet.dispatcher.fleet.robots["r0"].works
        assert [each.came for each in await ends(work)] == [True]


async def test_who_is_taken_out_on_its_way_breaks_off() -> None:
    async with working("a") as work:
        await work.fleet.operators.send("r0", "e", None)
        going = await work.runs.nth(1)
        await work.fleet.operators.take_out("r0", "its wheel squeaks", None)
        assert going.ended.result() == ("aborted", False)
        await until_no_errand(work)
        assert [each.came for each in await ends(work)] == [False]


async def test_who_is_taken_out_before_its_run_has_begun_breaks_off_once_it_has(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async with working("a") as work:
        may_begin, begin = asyncio.Event(), work.runs.start_run_of

        async def begin_late(*run: Any) -> None:
            await may_begin.wait()
            await begin(*run)

        monkeypatch.setattr(work.runs, "start_run_of", begin_late)
        await work.fleet.operators.send("r0", "e", None)
        await work.fleet.operators.take_out("r0", "its wheel squeaks", None)
        may_begin.set()
        assert (await work.runs.nth(1)).ended.result() == ("aborted", False)
        await until_no_errand(work)


async def test_after_a_restart_the_same_errand_goes_on() -> None:
    async with working("a") as work:
        await work.fleet.operators.send("r0", "d", None)
        going = await work.runs.nth(1)
        await work.fleet.stop()
        kept = (await work.journal.documents(KIND))[str(work.site.id)]
        was = FleetRecord.model_validate_json(kept)
        assert [(each.robot, each.place, each.run) for each in was.errands] == [
            ("r0", "f/d", going.id)
        ]
        again = Dispatcher.restored(office(), work.fleet.dispatcher.setting, was.dispatcher)
        work.fleet = _fleet(work.site, work.runs, work.journal, again, was)
        work.fleet.start()
        going.ended.set_result(("finished", True))
        await until_no_errand(work)
        assert await work.fleet.read(place_of("r0")) == "f/d"
        assert len(work.runs.runs) == 1


async def test_an_errand_that_cannot_be_begun_says_why() -> None:
    async with working("a", refuse=1) as work:
        await work.fleet.operators.send("r0", "d", None)
        await until_no_errand(work)
        (ended,) = await ends(work)
        assert (ended.came, ended.reason, ended.at) == (False, "the robot is busy", "f/a")
