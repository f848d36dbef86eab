"""Runs are steered from the command line as on the console, and refusals are the service's."""

import pytest
from console_script import Command, command_of
from steered_bench import begin, bench, started, to_the_end, waits_before
from two_boxes import BLUE, RED

from mend.server.cli.steer import ACTS
from mend.server.runtime.views import RunStatus
from mend.tasks.steering_rules import SteeringAct


@pytest.fixture
def steer(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Command:
    return command_of("steer", monkeypatch, capsys)


def test_every_act_has_its_command() -> None:
    assert list(ACTS) == [each.replace("_", "-") for each in SteeringAct]


async def test_a_run_waits_goes_on_and_does_next_what_is_said(steer: Command) -> None:
    async with bench() as service:
        run = await begin(service)
        await waits_before(service, RED)
        held = await steer(service.url, "show")
        assert held.told.splitlines() == [
            "autonomy\toff\t\t\t", f"waits before\t{RED}\tred_box\t\t",
        ]  # fmt: skip
        said = await steer(
            service.url, "set-breakpoint", "blue_box", "--reason", "the glue is wet", "--as", "ann"
        )
        assert (said.code, said.complaints) == (0, "")
        assert f"breakpoint\t{BLUE}\tblue_box\tann\tthe glue is wet" in said.told
        assert (await steer(service.url, "autonomy", "full", "--run", str(run)[:8])).code == 0
        held = await steer(service.url, "show", "--run", "both")
        await waits_before(service, BLUE)
        assert (await steer(service.url, "remove-breakpoint", BLUE)).code == 0
        assert started(await to_the_end(service, run)) == [RED, BLUE]
        over = await steer(service.url, "show")
        assert (over.code, over.complaints) == (
            2, "mend: no run goes on at this service: start one with `mend run --url`\n",
        )  # fmt: skip


async def test_leaves_are_left_out_tried_again_and_done_next(steer: Command) -> None:
    async with bench() as service:
        run = await begin(service)
        await waits_before(service, RED)
        assert (await steer(service.url, "leave-out", RED, "--reason", "it is broken")).code == 0
        assert (await steer(service.url, "try-again", RED)).code == 0
        wanted = await steer(service.url, "not-next", BLUE)
        assert wanted.complaints == "mend: nobody has asked for 'blue_box' next\n"
        await service.runtime.pause(run)
        assert (await steer(service.url, "autonomy", "full")).code == 0
        following = await steer(service.url, "do-next", BLUE)
        assert f"next\t{BLUE}\tblue_box" in following.told
        by_hand = await steer(service.url, "done-by-hand", RED)
        assert by_hand.code == 2
        assert "paused" in by_hand.complaints
        await service.runtime.resume(run)
        assert started(await to_the_end(service, run)) == [BLUE, RED]


async def test_offers_say_what_is_taken_and_why_the_rest_is_not(steer: Command) -> None:
    async with bench() as service:
        await begin(service, "in_order")
        await waits_before(service, RED)
        offered = [
            line.split("\t")
            for line in (await steer(service.url, "offers", "red_box")).told.splitlines()
        ]
        assert {act: now for act, now, _ in offered}.keys() == {
            "go-on", "set-breakpoint", "remove-breakpoint", "do-next", "not-next", "try-again",
            "leave-out", "done-by-hand",
        }  # fmt: skip
        assert ["go-on", "taken"] in [each[:2] for each in offered]
        refused = {act: why for act, now, why in offered if now == "refused"}
        again = await steer(service.url, "try-again", "red_box")
        assert (again.code, again.complaints) == (2, f"mend: {refused['try-again']}\n")


async def test_what_is_named_wrongly_is_told_in_a_sentence(steer: Command) -> None:
    async with bench() as service:
        run = await begin(service)
        await waits_before(service, RED)
        assert (await steer(service.url, "go-on", "green_box")).complaints == (
            "mend: the run's tree has no node 'green_box'; leaves of it are "
            "/0 (red_box), /1 (blue_box)\n"
        )
        assert (await steer(service.url, "go-on", "/7")).code == 2
        assert (await steer(service.url, "go-on", "/x")).complaints.startswith("mend: NODE must")
        other = await begin(service)
        either = await steer(service.url, "show")
        assert either.complaints.startswith("mend: say with --run which of the runs")
        assert str(other) in either.complaints
        tree = await steer(service.url, "show", "--run", "both")
        assert "'both' may be any of the runs" in tree.complaints
        unknown = await steer(service.url, "show", "--run", "zzz")
        assert unknown.complaints.startswith("mend: no run 'zzz' goes on; these do:")
        assert (await service.runtime.run(run)).status is RunStatus.RUNNING


async def test_a_service_that_is_not_there_is_told_in_a_sentence(steer: Command) -> None:
    nowhere = await steer("http://127.0.0.1:9", "show")
    assert (nowhere.code, nowhere.complaints.count("\n")) == (2, 1)
