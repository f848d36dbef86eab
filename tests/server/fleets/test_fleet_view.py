"""What clients see of a fleet: where its robots are and are to go, and what is closed."""

from functools import partial

import pytest
from dispatch_office import asked, office, visit
from test_errands import OLGA
from test_legs_as_runs import Work, _fleet, working

from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.requests import LegAction
from mend.server.fleets.fleet_record import FleetRecord
from mend.server.fleets.fleets import KIND
from mend.server.fleets.operator_requests import WayReport
from mend.server.fleets.views import FleetView
from mend.server.poses.bases import SeenBase


async def view_of(work: Work) -> FleetView:
    return await work.fleet.read(partial(FleetView.of, work.fleet))


async def test_robots_say_where_they_are_and_how_sure() -> None:
    async with working("a", "e") as work:
        turned = (0.0, 0.0, 0.5**0.5, 0.5**0.5)
        work.site.bases["r0"] = SeenBase((1.0, 2.0, 3.5, *turned), 0.5, [0.04, 0.0, 0.01])
        first, second = (await view_of(work)).robots
        assert first.pose is not None
        assert (first.pose.x, first.pose.y, first.pose.z) == (1.0, 2.0, 3.5)
        assert first.pose.yaw == pytest.approx(1.5708, abs=1e-4)
        assert (first.pose.age_s, first.pose.covariance) == (0.5, [0.04, 0.0, 0.01])
        assert (first.home, first.connected) == ("f/a", True)
        assert second.pose is None


async def test_time_goes_on_with_what_robots_show_where_they_report_nothing() -> None:
    async with working("a") as work:
        assert (await view_of(work)).now_s == 0.0
        work.site.shown_s = 42.0
        assert (await view_of(work)).now_s == 42.0
        work.site.time.heard(50.0)
        assert (await view_of(work)).now_s == 50.0


async def test_what_a_robot_is_at_is_told_apart_from_where_it_is_sent() -> None:
    async with working("a", "e") as work:
        await work.fleet.requesters.submit(asked(), None)
        await work.runs.nth(1)
        await work.fleet.operators.send("r1", "d", None)
        first, second = (await view_of(work)).robots
        assert first.at_work is not None
        assert second.at_work is not None
        assert (first.at_work.place, first.at_work.action) == ("f/b", LegAction.COLLECT)
        assert first.at_work.request == "tea"
        assert (second.at_work.place, second.at_work.action) == ("f/d", None)
        assert [each.action for each in first.stops] == [LegAction.COLLECT, LegAction.HAND_OVER]
        assert all(each.done_s >= each.begins_s for each in first.stops)


async def test_closed_ways_are_told_with_who_found_them_until_they_are_open() -> None:
    async with working("a") as work:
        closing = WayReport(finding="blocked", between=["c", "b"], until_s=900.0)
        await work.fleet.operators.found(closing, OLGA)
        (closed,) = (await view_of(work)).closed
        assert (closed.between, closed.finding, closed.by) == (
            ["f/b", "f/c"],
            "blocked",
            "olga",
        )
        assert closed.until_s == pytest.approx(900.0)
        await work.fleet.operators.found(WayReport(finding="open", between=["b", "c"]), OLGA)
        assert (await view_of(work)).closed == []
        kept = (await work.journal.documents(KIND))[str(work.site.id)]
        assert FleetRecord.model_validate_json(kept).closed_ways == ()


async def test_who_found_a_way_closed_is_known_after_a_restart() -> None:
    async with working("a") as work:
        await work.fleet.operators.found(WayReport(finding="blocked", between=["b", "c"]), OLGA)
        await work.fleet.stop()
        kept = (await work.journal.documents(KIND))[str(work.site.id)]
        was = FleetRecord.model_validate_json(kept)
        again = Dispatcher.restored(office(), work.fleet.dispatcher.setting, was.dispatcher)
        work.fleet = _fleet(work.site, work.runs, work.journal, again, was)
        work.fleet.start()
        (closed,) = (await view_of(work)).closed
        assert (closed.finding, closed.by) == ("blocked", "olga")


async def test_records_of_an_older_mend_have_neither_errands_nor_closed_ways() -> None:
    async with working("a") as work:
        await work.fleet.requesters.submit(visit(), None)
        await work.runs.nth(1)
        kept = (await work.journal.documents(KIND))[str(work.site.id)]
        document = FleetRecord.model_validate_json(kept).model_dump_json(
            exclude={"errands", "closed_ways"}
        )
        was = FleetRecord.model_validate_json(document)
        assert (was.errands, was.closed_ways) == ((), ())
