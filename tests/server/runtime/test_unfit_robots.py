"""A robot that does nothing any more is given up at once, with what it says of that."""

from told_robot import Body, ToldRobot, at_work

from mend.server.journal import events as ev
from mend.server.journal.sqlite import SqliteJournal
from mend.server.runtime.views import RunStatus

WHY = "its monitor for 'slipping' failed"


async def is_unfit(robot: ToldRobot, command: str, body: Body) -> None:
    """Its first step is its last."""
    if body["type"] == "look":
        await robot.look(command)
    elif body["type"] == "start":
        await robot.report(
            type="step_started", step=1, name="above pick", execution=body["execution"]
        )
        await robot.report(type="rejected", command=command, reason=WHY, for_good=True)


async def test_the_run_fails_with_the_reason_and_no_attempt_is_counted() -> None:
    journal = SqliteJournal(":memory:")
    async with at_work(is_unfit, journal) as (service, _, run):
        ended = await service.runtime.wait_for_end(run)
        events = await journal.read(0, 100_000, run)
    assert ended.status is RunStatus.FAILED
    assert ended.result is not None
    assert ended.result.reason.endswith(f" is of no more use: {WHY}")
    [lost] = [each for each in events if isinstance(each, ev.RobotLost)]
    assert lost.reason == f"is of no more use: {WHY}"
    assert [each for each in events if isinstance(each, ev.RobotBack)] == []
    assert len([each for each in events if isinstance(each, ev.NodeStarted)]) == 1
    assert not any(each.failed_attempt for each in events if isinstance(each, ev.NodeReset))
