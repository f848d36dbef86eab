"""A robot that is told one thing after the other, and nothing comes of it, is given up."""

import asyncio
from collections import Counter

import pytest
from pretend_service import pretend_service
from task_documents import definition_of
from told_robot import PARTS, Body, Obey, ToldRobot, at_work, end_of, works

from mend.server.dialogues.escalation import EscalationPolicy
from mend.server.journal import events as ev
from mend.server.journal.sqlite import SqliteJournal
from mend.server.robots.times import LinkTimes
from mend.server.runtime.context import RunSettings
from mend.server.runtime.livelock import MOST_FRUITLESS_COMMANDS
from mend.server.runtime.views import RunStatus
from mend.sim.tabletop.layout import lay_out


async def rejects_looks(robot: ToldRobot, command: str, body: Body) -> None:
    if body["type"] == "look":
        await robot.report(type="rejected", command=command, reason="I would rather not")


async def holds(robot: ToldRobot, command: str, body: Body) -> None:
    if body["type"] == "look":
        await robot.look(command)
    elif body["type"] in ("start", "resume"):
        await robot.report(type="holding", execution=body["execution"], at="in_place")


async def holds_and_retreats(robot: ToldRobot, command: str, body: Body) -> None:
    await holds(robot, command, body)
    if body["type"] == "interrupt":
        await robot.report(type="holding", execution=None, at="neutral")


async def knows_an_unknown_issue(robot: ToldRobot, command: str, body: Body) -> None:
    if body["type"] == "look":
        await robot.look(command)
    elif body["type"] in ("start", "resume"):
        about = {"execution": body["execution"]}
        await robot.report(type="issue", issue="bored", step=1, interrupts=False, **about)
        await robot.report(type="holding", at="in_place", **about)


async def goes_backwards(robot: ToldRobot, command: str, body: Body) -> None:
    """It begins more and more steps of one and the same leaf."""
    if body["type"] == "look":
        await robot.look(command)
    elif body["type"] in ("start", "resume"):
        about = {"execution": body["execution"]}
        await robot.report(type="step_started", step=robot.told, name="one more", **about)
        await robot.report(type="holding", at="in_place", **about)


async def _misses(robot: ToldRobot, body: Body) -> None:
    about = {"execution": body["execution"]}
    await robot.report(type="issue", issue="missed", step=1, interrupts=True, **about)
    await robot.report(type="holding", at="neutral", **about)
    robot.asks = True


async def rejects_looks_while_it_asks(robot: ToldRobot, command: str, body: Body) -> None:
    if body["type"] == "start":
        await _misses(robot, body)
    elif robot.asks:
        await robot.report(type="rejected", command=command, reason="I would rather not")
    else:
        await robot.look(command)


async def sees_its_part_wander_while_it_asks(robot: ToldRobot, command: str, body: Body) -> None:
    if body["type"] == "start":
        await _misses(robot, body)
    elif body["type"] == "look":
        await robot.look(command, x=0.3 + 0.1 * (robot.told % 5))


async def floods(robot: ToldRobot, command: str, body: Body) -> None:
    """It makes as much as it likes of each thing that it is told."""
    if body["type"] == "look":
        await robot.look(command)
    elif body["type"] in ("start", "resume"):
        for _ in range(40):
            await robot.report(type="holding", execution=body["execution"], at="in_place")


async def connects_at_each_start(robot: ToldRobot, command: str, body: Body) -> None:
    """It never says that anything was begun, and so is told to start again."""
    if body["type"] == "look":
        await robot.look(command)
    elif body["type"] == "start":
        await robot.end()
        await robot.connect(connects_at_each_start)


async def is_blind_at_the_end(robot: ToldRobot, command: str, body: Body) -> None:
    """Of all that it has done it says that it cannot see it, and does the last again."""
    last = len(body.get("finished", ())) == len(PARTS)
    if body["type"] == "look":
        await robot.look(command, **({"blind": "it is dark"} if last else {}))
    elif body["type"] == "start":
        await robot.finish(body)


async def boots_at_each_start(robot: ToldRobot, command: str, body: Body) -> None:
    if body["type"] == "look":
        await robot.look(command)
    elif body["type"] == "start":
        await robot.report(
            type="step_started", step=1, name="above pick", execution=body["execution"]
        )
        await robot.end()
        await robot.boot(boots_at_each_start)


@pytest.mark.parametrize(
    "obey",
    [
        rejects_looks,
        holds,
        knows_an_unknown_issue,
        goes_backwards,
        boots_at_each_start,
        connects_at_each_start,
        is_blind_at_the_end,
        rejects_looks_while_it_asks,
        sees_its_part_wander_while_it_asks,
    ],
)
async def test_a_robot_with_which_nothing_comes_on_is_given_up(obey: Obey) -> None:
    journal = SqliteJournal(":memory:")
    async with at_work(obey, journal) as (service, robot, run):
        ended = await service.runtime.wait_for_end(run)
        events = await journal.read(0, 100_000, run)
        assert service.refusals.counts["fruitless_commands"] == 1
        while robot.heard[-1]["type"] != "interrupt":  # noqa: ASYNC110
            await asyncio.sleep(0.01)
        assert robot.heard[-1]["retreat"]
    journal.close()
    assert ended.status is RunStatus.FAILED
    assert ended.result is not None
    assert ended.result.reason == (
        f"the robot 'arm' is given up: it was told {MOST_FRUITLESS_COMMANDS} things one after the "
        "other, and nothing was done and nobody answered meanwhile"
    )
    most = MOST_FRUITLESS_COMMANDS + 3 * len(PARTS) + 5
    assert MOST_FRUITLESS_COMMANDS <= robot.told <= most
    assert len(events) <= 4 * MOST_FRUITLESS_COMMANDS
    # Also where another robot goes on, that is to be read somewhere.
    assert any(isinstance(each, ev.RobotLost) for each in events)


async def test_a_robot_reports_no_more_for_being_told_the_same_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    most = 100
    monkeypatch.setattr("mend.server.robots.known_robot.MOST_UNASKED_REPORTS", most)
    journal = SqliteJournal(":memory:")
    async with at_work(floods, journal) as (_, robot, run):
        await robot.ended()
        events = await journal.read(0, 100_000, run)
    journal.close()
    assert len(events) <= most + 10


async def test_another_robot_goes_on_without_one_that_is_given_up() -> None:
    journal = SqliteJournal(":memory:")
    ended, robot, _ = await end_of(holds_and_retreats, journal, another_obeys=works)
    journal.close()
    assert ended.status is RunStatus.FINISHED
    assert robot.told <= MOST_FRUITLESS_COMMANDS + len(PARTS) + 5


async def test_a_robot_whose_program_is_killed_again_and_again_goes_on_while_it_gets_on(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    most = 30
    monkeypatch.setattr("mend.server.runtime.livelock.MOST_FRUITLESS_COMMANDS", most)
    kills = 12

    async def killed(robot: ToldRobot, command: str, body: Body) -> None:
        if body["type"] == "look":
            await robot.look(command, there=body["finished"])
        elif body["type"] == "start" and robot.boots % kills:
            await robot.end()
            await robot.boot(killed)
        elif body["type"] == "start":
            robot.boots += 1
            await robot.finish(body)

    journal = SqliteJournal(":memory:")
    ended, robot, _ = await end_of(killed, journal)
    journal.close()
    assert ended.status is RunStatus.FINISHED
    assert robot.told > 2 * most


async def test_a_run_that_people_pause_and_resume_goes_on(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    most = 10
    monkeypatch.setattr("mend.server.runtime.livelock.MOST_FRUITLESS_COMMANDS", most)
    resumed = 0

    async def pauses(robot: ToldRobot, command: str, body: Body) -> None:
        nonlocal resumed
        if body["type"] == "look":
            await robot.look(command, there=body["finished"])
        elif body["type"] == "interrupt":
            await robot.report(type="holding", execution=robot.executing, at="in_place")
            await robot.service.runtime.resume(await robot.run)
        elif body["type"] == "resume" and resumed >= most:
            await robot.finish(body)
        elif body["type"] in ("start", "resume"):
            robot.executing = body["execution"]
            resumed += 1
            await robot.service.runtime.pause(await robot.run)

    journal = SqliteJournal(":memory:")
    ended, robot, _ = await end_of(pauses, journal)
    journal.close()
    assert ended.status is RunStatus.FINISHED
    assert robot.told > 3 * most


async def test_a_robot_that_asks_for_an_hour_is_not_given_up() -> None:
    """Its part stands before it, and it looks every other second whether that changes."""
    parts = [("part_1", "spot_1")]
    leaf = {"behavior": "pick_and_place", "object": "part_1", "place": "spot_1"}
    hour = EscalationPolicy(answer_within_s=1800.0)
    async with pretend_service(
        definition_of({"then": [leaf]}),
        {"part_1": [("missed", 4)]},
        policy=hour,
        scene=lay_out(parts, seed=1),
        wrong=True,
    ) as service:
        ended, events = await service.run_to_end(answers="none")
        [robot] = service.robots.robots.values()
    looks = [each for each in robot.commands if each.type == "look"]
    assert ended.status is RunStatus.FINISHED
    assert events[-1].time > 3600.0
    assert len(looks) > 5 * MOST_FRUITLESS_COMMANDS


async def test_a_long_order_that_is_done_again_as_its_beginning_is_gone_is_progress() -> None:
    parts = [f"part_{number}" for number in range(110)]
    taken: list[str] = []

    async def obey(robot: ToldRobot, command: str, body: Body) -> None:
        if body["type"] == "start":
            await robot.finish(body)
            return
        finished = body["finished"]
        gone = [each for each in finished if each["object"] == parts[0]]
        if len(finished) == len(parts) and not taken:
            taken.append(parts[0])
            there = [each for each in finished if each not in gone]
            await robot.look(command, there=there, gone=gone)
        else:
            await robot.look(command, there=finished)

    journal = SqliteJournal(":memory:")
    ended, robot, _ = await end_of(obey, journal, parts=parts)
    journal.close()
    assert taken
    assert ended.status is RunStatus.FINISHED, ended.result
    assert robot.told > 2 * MOST_FRUITLESS_COMMANDS


@pytest.mark.parametrize(("attempts", "leaves", "fails"), [(100, 3, 80), (3, 110, 1)])
async def test_a_leaf_may_be_tried_as_often_as_the_run_says(
    attempts: int, leaves: int, fails: int
) -> None:
    tried: Counter[str] = Counter()

    async def obey(robot: ToldRobot, command: str, body: Body) -> None:
        if body["type"] == "look":
            await robot.look(command, there=body["finished"])
        elif body["type"] == "start":
            tried[body["node"]] += 1
            if tried[body["node"]] > fails:
                await robot.finish(body)
            else:
                await robot.report(type="rejected", command=command, reason="not this time")

    parts = [f"part_{number}" for number in range(leaves)]
    journal = SqliteJournal(":memory:")
    ended, _, _ = await end_of(obey, journal, kind="and", parts=parts, max_attempts=attempts)
    journal.close()
    assert ended.status is RunStatus.FINISHED, ended.result


async def test_a_robot_that_comes_back_after_it_was_given_up_lets_go_of_what_it_has() -> None:
    gone, let_go, go_on = (asyncio.Event() for _ in range(3))

    async def leaves(robot: ToldRobot, _command: str, body: Body) -> None:
        if body["type"] == "look":
            await robot.end()
            gone.set()
        elif body["type"] == "interrupt" and body["retreat"]:
            await robot.report(type="holding", execution=None, at="neutral")
            let_go.set()

    async def waits(robot: ToldRobot, command: str, body: Body) -> None:
        if body["type"] == "start":
            await go_on.wait()
        await works(robot, command, body)

    journal = SqliteJournal(":memory:")
    async with at_work(
        leaves,
        journal,
        another_obeys=waits,
        settings=RunSettings(robot_lost_timeout_s=0.01),
        times=LinkTimes(absence_s=0.01),
    ) as (service, robot, run):
        await gone.wait()
        proxy = service.runtime._runs[run].proxies["arm"]
        while not proxy.gone_for_good:  # noqa: ASYNC110
            await asyncio.sleep(0.01)
        holding = {"execution": "of an earlier run", "state": "holding", "step": 3}
        await robot.connect(leaves, executing=holding)
        await let_go.wait()
        go_on.set()
        ended = await service.runtime.wait_for_end(run)
    journal.close()
    assert ended.status is RunStatus.FINISHED


async def test_an_answer_gives_a_robot_as_much_time_again() -> None:
    journal = SqliteJournal(":memory:")
    async with at_work(rejects_looks_while_it_asks, journal) as (service, _, run):
        dialogues = service.runtime.dialogues
        while not (asked := await dialogues.page("open", 10, 0)) or not asked[0].prompt:  # noqa: ASYNC110
            await asyncio.sleep(0)
        state = service.runtime._runs[run].context.state
        before = state.progress
        await dialogues.answer(asked[0].dialogue, asked[0].prompt.prompt, "yes", "ben")
        assert state.progress == before + 1
    journal.close()
