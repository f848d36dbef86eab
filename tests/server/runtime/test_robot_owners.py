"""Which run has a robot: one at a time, none for ever."""

import asyncio
from typing import Any

import pytest
from pretend_robots import PretendRobot, Sink
from pretend_service import PretendService, pretend_service
from task_documents import definition_of

from mend.errors import ConflictError, WrongInputError
from mend.server.errors import BusyError
from mend.server.journal.run_index import RunPage
from mend.server.runtime.ports import RealRobots
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunStatus, RunSummary

ONE_PART = definition_of({"behavior": "pick_and_place", "object": "part_1", "place": "spot_1"})


def request_of(*robots: str) -> RunRequest:
    return RunRequest(tree="tree", world="live", robots=list(robots))


def connect(service: PretendService, *robots: str) -> None:
    for name in robots:
        service.robots.robots[name] = PretendRobot(name, slow=True)


async def outcomes(service: PretendService, *requests: RunRequest) -> list[Any]:
    starts = [service.runtime.start_run(each) for each in requests]
    return await asyncio.gather(*starts, return_exceptions=True)


async def test_of_two_runs_that_want_one_robot_at_once_one_gets_it() -> None:
    async with pretend_service(ONE_PART) as service:
        connect(service, "duo")
        came_of_it = await outcomes(service, request_of("duo"), request_of("duo"))
        (run,) = [each for each in came_of_it if isinstance(each, RunSummary)]
        (refusal,) = [each for each in came_of_it if isinstance(each, ConflictError)]
        assert str(refusal) == f"the robot 'duo' is busy with run {run.id}"
        assert [each.id for each in await service.runtime.runs(RunPage())] == [run.id]


async def test_a_robot_is_free_again_after_two_runs_wanted_it_at_once() -> None:
    async with pretend_service(ONE_PART) as service:
        connect(service, "duo")
        came_of_it = await outcomes(service, request_of("duo"), request_of("duo"))
        run = next(each for each in came_of_it if isinstance(each, RunSummary))
        await service.runtime.abort(run.id)
        await service.runtime.wait_for_end(run.id)
        again = await service.runtime.start_run(request_of("duo"))
        assert again.status is RunStatus.RUNNING


async def test_a_run_that_cannot_be_journaled_leaves_its_robot_free(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async with pretend_service(ONE_PART) as service:
        connect(service, "duo")

        async def refuse(*_: object) -> None:
            raise ConflictError("not now")

        with monkeypatch.context() as patched:
            patched.setattr(service.journal, "append", refuse)
            with pytest.raises(ConflictError):
                await service.runtime.start_run(request_of("duo"))
        assert (await service.runtime.start_run(request_of("duo"))).status is RunStatus.RUNNING


async def test_a_robot_is_named_once() -> None:
    async with pretend_service(ONE_PART) as service:
        connect(service, "duo")
        with pytest.raises(WrongInputError, match="'duo' more than once"):
            await service.runtime.start_run(request_of("duo", "duo"))
        assert service.journal.head == 0


async def test_a_run_that_cannot_have_all_its_robots_keeps_none(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async with pretend_service(ONE_PART) as service:
        connect(service, "one", "two")
        assign = service.robots.assign

        def assign_one(robot: str, sink: Sink) -> None:
            if robot == "two":
                raise ConflictError("the robot 'two' is busy with another run")
            assign(robot, sink)

        with monkeypatch.context() as patched:
            patched.setattr(service.robots, "assign", assign_one)
            failed = await service.runtime.start_run(request_of("one", "two"))
        assert failed.status is RunStatus.FAILED
        both = await service.runtime.start_run(request_of("one", "two"))
        assert both.status is RunStatus.RUNNING


async def test_a_run_that_is_asked_for_while_the_service_stops_does_not_begin() -> None:
    async with pretend_service(ONE_PART) as service:
        connect(service, "duo")
        starting = asyncio.create_task(service.runtime.start_run(request_of("duo")))
        await service.runtime.close()
        with pytest.raises(BusyError, match="shutting down"):
            await starting
        assert service.journal.head == 0


async def test_a_robot_can_be_had_as_soon_as_its_run_is_known_to_have_ended(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    parted = asyncio.Event()

    async def part(_: RealRobots) -> None:
        await parted.wait()

    monkeypatch.setattr(RealRobots, "release", part)
    async with pretend_service(ONE_PART) as service:
        service.robots.robots["duo"] = PretendRobot("duo")
        run = (await service.runtime.start_run(request_of("duo"))).id
        while not (await service.runtime.run(run)).status.ended:  # noqa: ASYNC110
            await asyncio.sleep(0)
        again = asyncio.create_task(service.runtime.start_run(request_of("duo")))
        # Long enough for everything but the parting.
        await asyncio.wait([again], timeout=0.2)
        parted.set()
        assert (await again).id != run
