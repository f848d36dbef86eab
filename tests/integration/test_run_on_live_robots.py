"""`mend run --world live`, as a user calls it, on example robots."""

import asyncio
import signal
from collections.abc import AsyncIterator, Sequence
from contextlib import AbstractAsyncContextManager
from pathlib import Path

import pytest
import pytest_asyncio
from example_robot import example_robot
from forked_mend import FORKED, Command, mend_command
from sampled import sample
from service_process import ServiceProcess, free_port, service_process

from mend.server.client import MendClient
from mend.server.journal import events as ev

# One event loop for all of them, and so one service.
pytestmark = [pytest.mark.slow, pytest.mark.asyncio(loop_scope="module")]

EXAMPLES = Path(__file__).parents[2] / "examples"


def mend_run(
    folder: Path, *options: str, **environment: str
) -> AbstractAsyncContextManager[Command]:
    return mend_command("run", *options, MEND_DATA_DIR=str(folder), **environment)


def door_of(service: ServiceProcess) -> str:
    return f"ws://127.0.0.1:{service.port}/ws/robot"


@pytest_asyncio.fixture(scope="module", loop_scope="module")
async def service(tmp_path_factory: pytest.TempPathFactory) -> AsyncIterator[ServiceProcess]:
    """Each test has robots of its own there."""
    async with service_process(tmp_path_factory.mktemp("service"), forked=FORKED) as service:
        yield service


def own_or_a_service(
    service: ServiceProcess, port: int, through_a_service: bool
) -> tuple[str, Sequence[str]]:
    """Where the robots of a run call, at a run's own door or a service's, and how it is told so."""
    if through_a_service:
        return door_of(service), ("--url", service.url)
    return f"ws://127.0.0.1:{port}/ws/robot", ()


LIVE = ("eket", "--world", "live")


async def test_without_a_service_it_opens_the_door_and_waits_for_its_robots(
    tmp_path: Path,
) -> None:
    port = free_port()
    door = f"ws://127.0.0.1:{port}/ws/robot"
    report = tmp_path / "report.html"
    async with mend_run(
        tmp_path, *LIVE, "--robot", "demo", "--report", str(report), MEND_PORT=str(port)
    ) as run:
        waits = await run.says("Waiting for")
        assert f"Waiting for demo at {door}: no robot 'demo' is connected" in waits
        assert "After 60 s this gives up" in waits
        async with example_robot(door):
            code, told, complaints = await run.outcome()
    assert (code, complaints) == (0, "")
    assert "purple_top" in told or "orange_top" in told
    assert told.splitlines()[-2].endswith("the run has finished: the task is done")
    assert "eket" in report.read_text()


async def test_it_says_that_another_service_has_the_port(
    tmp_path: Path, service: ServiceProcess
) -> None:
    occupied = str(service.port)
    async with mend_run(tmp_path, *LIVE, "--robot", "demo", MEND_PORT=occupied) as run:
        code, _, complaints = await run.outcome()
    assert code == 2
    assert f"cannot listen on 127.0.0.1:{service.port}" in complaints
    assert "give its address with --url" in complaints


async def test_a_service_that_is_there_does_it(tmp_path: Path, service: ServiceProcess) -> None:
    async with (
        example_robot(door_of(service), name="served"),
        mend_run(tmp_path, *LIVE, "--robot", "served", "--url", service.url) as run,
    ):
        code, told, complaints = await run.outcome()
        async with MendClient(service.url) as client:
            (kept,) = [each for each in await client.runs() if each.robots == ["served"]]
    assert (code, complaints) == (0, "")
    assert (kept.world, kept.status) == ("live", "finished")
    assert told.endswith("the run has finished: the task is done\n")


async def test_own_files_and_reports_go_with_a_service_too(
    tmp_path: Path, service: ServiceProcess
) -> None:
    shelf = EXAMPLES / "tasks" / "shelf.yaml"
    report = tmp_path / "report.html"
    async with mend_run(
        tmp_path, str(shelf), "--world", "tabletop", "--speed", "max", "--url", service.url,
        "--report", str(report), "--answers", "random",
    ) as run:  # fmt: skip
        code, _, complaints = await run.outcome()
        async with MendClient(service.url) as client:
            assert "shelf" in [each.name for each in await client.scenes()]
    assert (code, complaints) == (0, "")
    assert "shelf" in report.read_text()


async def test_robots_that_are_not_there_are_told_with_those_that_are(
    tmp_path: Path, service: ServiceProcess
) -> None:
    async with (
        example_robot(door_of(service), name="lonely"),
        MendClient(service.url) as client,
    ):
        # Those of other tests may not have gone yet.
        while [each.robot for each in await client.robots() if each.connected] != ["lonely"]:  # noqa: ASYNC110
            await asyncio.sleep(0.05)
        at = ("--url", service.url)
        async with mend_run(tmp_path, *LIVE, *at) as unnamed:
            nobody = await unnamed.outcome()
        async with mend_run(tmp_path, *LIVE, *at, "--robot", "dmo", "--wait", "0") as misspelt:
            wrong = await misspelt.outcome()
        async with mend_run(tmp_path, "ekett", "--world", "live", "--robot", "dmo", *at) as other:
            tree = await other.outcome()
    assert nobody[0] == wrong[0] == tree[0] == 2
    assert nobody[2] == (
        "mend: --world live needs --robot NAME, once for each robot; connected and free: 'lonely'\n"
    )
    assert "mend: no robot 'dmo' is connected (connected and free: 'lonely'); " in wrong[2]
    # What no waiting would mend is told at once.
    assert tree[2] == "mend: there is no task tree 'ekett'\n"


KIT = ("kit", "--scene", str(EXAMPLES / "two_arms" / "kit_for_two.yaml"), "--world", "live")


@pytest.mark.parametrize("through_a_service", sample([False], [False, True]))
async def test_two_robots_stand_where_the_scene_says_and_share_the_work(
    tmp_path: Path, service: ServiceProcess, *, through_a_service: bool
) -> None:
    port = free_port()
    door, at = own_or_a_service(service, port, through_a_service)
    robots = ("--robot", "right=demo-2", "--robot", "left=demo-1")
    async with (
        example_robot(door, name="demo-1"),
        example_robot(door, name="demo-2"),
        mend_run(tmp_path, *KIT, *robots, *at, "--json", MEND_PORT=str(port)) as run,
    ):
        code, told, _ = await run.outcome()
    assert code == 0
    started, *events = [ev.any_event.validate_json(each) for each in told.splitlines()]
    assert isinstance(started, ev.RunStarted)
    assert started.robots == ["demo-1", "demo-2"]
    assert list(started.scene["robots"]) == ["left", "right"]
    begun = [each.robot for each in events if isinstance(each, ev.NodeStarted)]
    assert len(begun) == 20
    assert set(begun) == {"demo-1", "demo-2"}
    finished = events[-1]
    assert isinstance(finished, ev.RunFinished)
    assert (finished.missing, finished.unseen) == ([], [])


# A run at its own door is ended so in `test_cli.py`.
@pytest.mark.parametrize("through_a_service", sample([True], [False, True]))
async def test_ctrl_c_aborts_it_and_ends_the_waiting(
    tmp_path: Path, service: ServiceProcess, *, through_a_service: bool
) -> None:
    port = free_port()
    door, at = own_or_a_service(service, port, through_a_service)
    options = (*LIVE, "--robot", "broken-off", *at)
    async with mend_run(tmp_path, *options, MEND_PORT=str(port)) as waiting:
        await waiting.says("Waiting for")
        waiting.process.send_signal(signal.SIGINT)
        assert (await waiting.outcome())[0] == 130
    async with (
        mend_run(tmp_path, *options, MEND_PORT=str(port)) as running,
        example_robot(door, "--step-s", "60", name="broken-off"),
    ):
        await running.says("green_leg")
        running.process.send_signal(signal.SIGINT)
        code, told, _ = await running.outcome()
    assert code == 130
    assert "aborted" in told
