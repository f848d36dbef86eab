"""People steer a run: it waits where they said, and goes on when they say so."""

import shutil
from pathlib import Path

import pytest
from awaited_events import when
from steered_bench import begin, bench, set_autonomy, started, steer, to_the_end, waits_before
from two_boxes import BLUE, RED

from mend.errors import ConflictError
from mend.server.client import MendClient
from mend.server.client_errors import RefusedError
from mend.server.journal import events as ev
from mend.server.runtime.steering_views import SetAutonomy, SteerNode
from mend.tasks.autonomy import AutonomyLevel
from mend.tasks.intervention import Act, Intervention


async def test_a_run_waits_before_a_breakpoint_until_it_is_let_go() -> None:
    async with bench() as service:
        run = await begin(service)
        await steer(service, run, "set_breakpoint", BLUE, "the glue is wet")
        await set_autonomy(service, run, "full")
        held = await waits_before(service, BLUE)
        assert (held.breakpoint, held.by, held.reason) == (BLUE, "ann", "the glue is wet")
        # What has no breakpoint went on.
        assert started(await service.journal.read(0, 10_000, run)) == [RED]
        summary = await service.runtime.run_summary(run)
        assert [each.node for each in summary.waits] == [BLUE]
        await steer(service, run, "go_on", BLUE)
        events = await to_the_end(service, run)
        assert started(events) == [RED, BLUE]
        assert (await service.runtime.run_summary(run)).waits == []


async def test_breakpoints_and_levels_still_hold_after_the_service_was_killed(
    tmp_path: Path,
) -> None:
    journal = tmp_path / "journal.db"
    async with bench(journal) as service:
        run = await begin(service, "in_order")
        await steer(service, run, "set_breakpoint", BLUE, "look first")
        await set_autonomy(service, run, "full")
        await waits_before(service, BLUE)
        before = await service.runtime.steering(run)
        # What is on the disk at any moment is what a killed service leaves behind.
        left = tmp_path / "left"
        left.mkdir()
        for file in (journal, journal.with_name("journal.db-wal")):
            shutil.copy(file, left)
    async with bench(left / journal.name) as service:
        after = await service.runtime.steering(run)
        assert after == before.model_copy(update={"seq": after.seq})
        assert [each.by for each in after.breakpoints] == ["ann"]
        assert [each.node for each in after.waits] == [BLUE]
        with pytest.raises(
            ConflictError, match="there is a breakpoint before 'blue_box' already, set by ann"
        ):
            await steer(service, run, "set_breakpoint", BLUE)
        await steer(service, run, "remove_breakpoint", BLUE)
        assert started(await to_the_end(service, run)) == [RED, BLUE]


async def test_without_autonomy_each_leaf_is_asked_for() -> None:
    async with bench() as service:
        run = await begin(service, "in_order")
        held = await waits_before(service, RED)
        assert (held.breakpoint, held.level) == (None, AutonomyLevel.OFF)
        await steer(service, run, "go_on", RED)
        await waits_before(service, BLUE)
        await steer(service, run, "go_on", BLUE)
        assert started(await to_the_end(service, run)) == [RED, BLUE]


@pytest.mark.parametrize("wanted", [RED, BLUE])
async def test_what_is_asked_for_is_begun_next(wanted: str) -> None:
    async with bench() as service:
        run = await begin(service)
        await waits_before(service, RED)
        await service.runtime.pause(run)
        await set_autonomy(service, run, "full")
        await steer(service, run, "do_next", wanted)
        await service.runtime.resume(run)
        events = await to_the_end(service, run)
        assert started(events)[0] == wanted
        first = next(each for each in events if isinstance(each, ev.NodeStarted))
        assert first.candidates[0].asked_for_by == "ann"


async def test_what_is_left_out_is_told_at_the_end_and_may_be_tried_again_before() -> None:
    async with bench() as service:
        run = await begin(service)
        await waits_before(service, RED)
        await steer(service, run, "leave_out", RED, "it is broken")
        with pytest.raises(ConflictError, match="'red_box' is done already"):
            await steer(service, run, "leave_out", RED)
        await steer(service, run, "try_again", RED)
        await steer(service, run, "leave_out", BLUE)
        await steer(service, run, "go_on", RED)
        events = await to_the_end(service, run)
        assert started(events) == [RED]
        end = events[-1]
        assert isinstance(end, ev.RunFinished)
        assert [(each.node, each.left_out_by) for each in end.missing] == [(BLUE, "ann")]


async def test_what_is_done_by_hand_is_done_once_a_robot_sees_it() -> None:
    async with bench() as service:
        run = await begin(service)
        await waits_before(service, RED)
        deed = Intervention(act=Act.PLACE, object="blue_box", place="blue_box")
        await service.runtime.intervene(run, deed)
        await when(service, lambda each: isinstance(each, ev.InterventionDone))
        await steer(service, run, "done_by_hand", BLUE, "it was in my way")
        done = await when(service, lambda each: isinstance(each, ev.NodeDone))
        assert isinstance(done, ev.NodeDone)
        assert (done.node, done.by) == (BLUE, "human")
        await steer(service, run, "go_on", RED)
        assert started(await to_the_end(service, run)) == [RED]


async def test_what_is_said_to_be_done_and_not_seen_is_anybodys_again() -> None:
    async with bench(help_window_s=1.0) as service:
        run = await begin(service)
        await waits_before(service, RED)
        await steer(service, run, "done_by_hand", BLUE)
        back = await when(service, lambda each: isinstance(each, ev.NodeReset))
        assert isinstance(back, ev.NodeReset)
        assert "ann said that it was done, but no robot has seen it" in back.reason
        await set_autonomy(service, run, "full")
        assert sorted(started(await to_the_end(service, run))) == [RED, BLUE]


async def test_over_rest_a_refusal_is_one_sentence_and_offers_say_what_is_taken() -> None:
    async with bench() as service, MendClient(service.url) as client:
        run = await begin(service, "in_order")
        await waits_before(service, RED)
        offers = await client.steering_offers(run, RED)
        assert {each.act for each in offers.offered} == {
            "go_on",
            "set_breakpoint",
            "leave_out",
            "done_by_hand",
        }
        view = await client.steer(run, SteerNode(act="set_breakpoint", node=RED), "ann")
        assert [(each.node, each.by) for each in view.breakpoints] == [(RED, "ann")]
        with pytest.raises(RefusedError) as refused:
            await client.steer(run, SteerNode(act="go_on", node=BLUE), "ann")
        assert refused.value.problem.status == 409
        assert "'red_box' comes before 'blue_box'" in refused.value.problem.detail
        with pytest.raises(RefusedError) as missing:
            await client.steer(run, SteerNode(act="go_on", node="/7"), "ann")
        assert missing.value.problem.status == 404
        level = SetAutonomy(act="set_autonomy", level=AutonomyLevel.LOW)
        assert (await client.steer(run, level, "ann")).autonomy == "low"
        assert (await client.steering(run)).waits == (await client.run(run)).waits


async def test_what_would_break_the_order_is_refused_with_a_sentence() -> None:
    async with bench() as service:
        run = await begin(service, "in_order")
        await waits_before(service, RED)
        for act in ("go_on", "do_next", "leave_out", "done_by_hand"):
            with pytest.raises(ConflictError, match="'red_box' comes before 'blue_box'"):
                await steer(service, run, act, BLUE)
        offers = await service.runtime.steering_of(run, BLUE)
        assert [each.act for each in offers.offered] == ["set_breakpoint"]
        await service.runtime.abort(run)
        with pytest.raises(ConflictError, match="the run has ended"):
            await steer(service, run, "set_breakpoint", BLUE)
