"""Several live robots on one run: who works when, who looks last, and what if one dies."""

import asyncio
from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager

import pytest
from gated_robot import GatedRobot, gated_robot
from live_service import LiveService, live_service
from pretend_service import OneTree
from task_documents import definition_of

from mend.server.journal import events as ev
from mend.server.journal.sqlite import SqliteJournal
from mend.server.robots.times import LinkTimes
from mend.server.runtime.context import RunSettings
from mend.server.runtime.requests import RunRequest
from mend.tasks.scene import Base, Place, Pose, Scene, SceneObject

TOKEN = "t" * 32
PATIENT = RunSettings()
SHORT = RunSettings(robot_lost_timeout_s=0.2)
TIMES = LinkTimes(absence_s=0.1)

NEAR, FAR, MIDDLE = (0.35, 0.65, 0.5)
"""How far from the left robot a part starts and is placed: the right one is 1 m away."""


def scene(**parts: tuple[float, float]) -> Scene:
    """Parts by name, each with its x and its y; its place is 0.1 m to its left."""
    return Scene(
        name="pair",
        objects={
            name: SceneObject(color=(0.9, 0.1, 0.1), size=(0.04, 0.04, 0.05), pose=Pose(x=x, y=y))
            for name, (x, y) in parts.items()
        },
        places={name: Place(pose=Pose(x=x, y=y + 0.1)) for name, (x, y) in parts.items()},
        robots={"left": Base(x=0.0, y=0.0), "right": Base(x=1.0, y=0.0, yaw=3.1416)},
    )


def tree_of(*parts: str) -> OneTree:
    leaves = [{"behavior": "pick_and_place", "object": each, "place": each} for each in parts]
    where = {
        each: ({"near": NEAR, "far": FAR}.get(each.partition("_")[0], MIDDLE), -0.2 + 0.2 * number)
        for number, each in enumerate(parts)
    }
    return OneTree(definition_of({"and": leaves}), scene(**where))


@pytest.fixture
async def journal() -> AsyncIterator[SqliteJournal]:
    journal = SqliteJournal(":memory:")
    yield journal
    journal.close()


class Pair:
    """A run of two robots, and what became of it."""

    def __init__(self, service: LiveService, one: GatedRobot, two: GatedRobot) -> None:
        self.service, self.one, self.two = service, one, two

    async def begin(self) -> None:
        async with asyncio.timeout(60):
            while not all(map(self.service.registry.connected, ("one", "two"))):  # noqa: ASYNC110
                await asyncio.sleep(0.01)
        request = RunRequest(tree="t", world="live", robots={"left": "one", "right": "two"})
        self.run = (await self.service.runtime.start_run(request)).id

    async def end(self) -> Sequence[ev.Event]:
        await asyncio.wait_for(self.service.runtime.wait_for_end(self.run), 60)
        return await self.service.journal.read(0, 10_000, self.run)


@asynccontextmanager
async def pair(
    journal: SqliteJournal, tree: OneTree, settings: RunSettings = PATIENT, **of_both: None
) -> AsyncIterator[Pair]:
    async with (
        live_service(journal, tree, token=TOKEN, settings=settings, times=TIMES) as service,
        gated_robot(service.url, TOKEN, "one", **of_both) as one,
        gated_robot(service.url, TOKEN, "two", **of_both) as two,
    ):
        yield Pair(service, one, two)


def most_at_once(events: Sequence[ev.Event]) -> int:
    """How many leaves were under way at once at most."""
    active = most = 0
    for each in events:
        active += isinstance(each, ev.NodeStarted)
        active -= isinstance(each, ev.NodeDone | ev.NodeReset)
        most = max(most, active)
    return most


async def test_robots_that_say_what_room_they_take_work_at_once(journal: SqliteJournal) -> None:
    async with pair(journal, tree_of("near", "far")) as both:
        both.one.may_finish.clear()
        both.two.may_finish.clear()
        await both.begin()
        await both.one.until(started=1)
        await both.two.until(started=1)
        both.one.may_finish.set()
        both.two.may_finish.set()
        events = await both.end()
    assert (both.one.started, both.two.started) == (["near"], ["far"])
    assert isinstance(events[-1], ev.RunFinished)


async def test_robots_that_do_not_say_it_work_one_after_the_other(journal: SqliteJournal) -> None:
    async with pair(journal, tree_of("near", "middle", "far"), room=None) as both:
        await both.begin()
        events = await both.end()
    assert isinstance(events[-1], ev.RunFinished)
    assert most_at_once(events) == 1


@pytest.mark.parametrize("late", ["one", "two"])
async def test_a_run_is_over_when_each_robot_has_looked_at_what_it_sees(
    journal: SqliteJournal, late: str
) -> None:
    async with pair(journal, tree_of("near", "far")) as both:
        both.one.may_finish.clear()
        both.two.may_finish.clear()
        await both.begin()
        for each in (both.one, both.two):
            await each.until(started=1)
        slow, quick = (both.one, both.two) if late == "one" else (both.two, both.one)
        before = slow.looks, quick.looks
        slow.may_look.clear()
        both.one.may_finish.set()
        both.two.may_finish.set()
        await slow.until(looks=before[0] + 1)
        await quick.until(looks=before[1] + 1)
        slow.may_look.set()
        events = await both.end()
    finished = events[-1]
    assert isinstance(finished, ev.RunFinished)
    assert (finished.missing, finished.unseen) == ([], [])


async def test_the_other_does_the_leaves_of_a_robot_that_died_while_it_rested(
    journal: SqliteJournal,
) -> None:
    tree = tree_of("middle_a", "middle_b")
    async with (
        live_service(journal, tree, token=TOKEN, settings=SHORT, times=TIMES) as service,
        gated_robot(service.url, TOKEN, "one") as one,
    ):
        one.may_finish.clear()
        async with gated_robot(service.url, TOKEN, "two") as two:
            two.may_look.clear()
            both = Pair(service, one, two)
            await both.begin()
            await one.until(started=1)
        one.may_finish.set()
        events = await both.end()
    assert sorted(one.started) == ["middle_a", "middle_b"]
    assert isinstance(events[-1], ev.RunFinished)


async def test_nobody_goes_where_a_robot_died_on_its_way(journal: SqliteJournal) -> None:
    tree = tree_of("near", "far")
    async with (
        live_service(journal, tree, token=TOKEN, settings=SHORT, times=TIMES) as service,
        gated_robot(service.url, TOKEN, "one") as one,
    ):
        async with gated_robot(service.url, TOKEN, "two") as two:
            two.may_finish.clear()
            both = Pair(service, one, two)
            await both.begin()
            await two.until(started=1)
        events = await both.end()
    failed = events[-1]
    assert isinstance(failed, ev.RunFailed)
    assert one.started == ["near"]
    assert failed.reason == (
        "'far' could not be done: no robot can do it: the arm of 'two' may be in the way, "
        "which was given up there"
    )


async def test_a_robot_whose_program_comes_back_in_time_does_its_leaf_again(
    journal: SqliteJournal,
) -> None:
    tree = tree_of("near", "far")
    async with (
        live_service(journal, tree, token=TOKEN, times=TIMES) as service,
        gated_robot(service.url, TOKEN, "one") as one,
    ):
        async with gated_robot(service.url, TOKEN, "two") as two:
            two.may_finish.clear()
            both = Pair(service, one, two)
            await both.begin()
            await two.until(started=1)
        async with asyncio.timeout(60):
            while service.registry.connected("two"):  # noqa: ASYNC110
                await asyncio.sleep(0.01)
        async with gated_robot(service.url, TOKEN, "two", boot="b2") as again:
            events = await both.end()
    assert again.started == ["far"]
    assert isinstance(events[-1], ev.RunFinished)
    resets = [each for each in events if isinstance(each, ev.NodeReset)]
    assert [(each.name, each.failed_attempt) for each in resets] == [("far", False)]


async def test_after_a_new_start_of_the_service_both_go_on_by_themselves(
    journal: SqliteJournal,
) -> None:
    tree = tree_of("middle_a", "middle_b")
    async with pair(journal, tree) as both:
        both.one.may_finish.clear()
        both.two.may_finish.clear()
        await both.begin()
        await first_start(journal)
    async with (
        live_service(journal, tree, token=TOKEN, times=TIMES) as service,
        gated_robot(service.url, TOKEN, "one", boot="b2") as one,
        gated_robot(service.url, TOKEN, "two", boot="b2") as two,
    ):
        again = Pair(service, one, two)
        again.run = both.run
        events = await again.end()
    assert isinstance(events[-1], ev.RunFinished)
    assert most_at_once(events) == 1


async def test_where_the_last_service_left_an_arm_nobody_goes_until_its_robot_is_back(
    journal: SqliteJournal,
) -> None:
    tree = tree_of("middle_a", "middle_b")
    async with pair(journal, tree) as both:
        both.one.may_finish.clear()
        both.two.may_finish.clear()
        await both.begin()
        begun = await first_start(journal)
    other = {"one": "two", "two": "one"}[begun.robot]
    async with (
        live_service(journal, tree, token=TOKEN, settings=SHORT, times=TIMES) as service,
        gated_robot(service.url, TOKEN, other, boot="b2") as alone,
    ):
        again = Pair(service, alone, alone)
        again.run = both.run
        events = await again.end()
    failed = events[-1]
    assert isinstance(failed, ev.RunFailed)
    assert alone.started == []
    assert f"the arm of '{begun.robot}' may be in the way" in failed.reason


async def first_start(journal: SqliteJournal) -> ev.NodeStarted:
    """Wait until some leaf has begun."""
    async with asyncio.timeout(60):
        with journal.subscribe(0) as records:
            async for record in records:
                event = ev.any_event.validate_json(record.text)
                if isinstance(event, ev.NodeStarted):
                    return event
    raise AssertionError("a subscription has no end")
