"""What somebody pushes between the fingers is let go of, looked at and grasped anew."""

import math

from robot_bench import RobotBench

from mend.robots.link.messages import Finished, IssueDetected, StepStarted

CLOSE = 3


def bench_where_it_is_pushed(times: int) -> RobotBench:
    """At so many of the first closings something pushes, and the fingers close askew."""
    bench = RobotBench()

    def push() -> None:
        closings = [each for each in bench.of(StepStarted) if each.step == CLOSE]
        progress = bench.robot.task_progress
        closing = progress is not None and progress.step == CLOSE
        pushes = closing and len(closings) <= times
        bench.body.force_n, bench.body.askew_m = (20.0, 0.012) if pushes else (0.0, 0.0)

    bench.body.at_cycle = push
    bench.start("pink_bar")
    bench.run()
    return bench


def closings(bench: RobotBench) -> int:
    return sum(each.step == CLOSE for each in bench.of(StepStarted))


def test_what_is_pushed_askew_is_grasped_anew_and_placed() -> None:
    bench = bench_where_it_is_pushed(times=1)
    assert bench.of(IssueDetected) == []
    assert bench.of(Finished) == [Finished(execution="e1")]
    assert closings(bench) == 2
    resting = bench.body.parts["pink_bar"]
    assert math.dist((resting.x, resting.y), (0.55, 0.05)) < 0.004


def test_after_two_new_grasps_the_verdict_stands() -> None:
    bench = bench_where_it_is_pushed(times=9)
    assert closings(bench) == 3
    assert [each.issue for each in bench.of(IssueDetected)] == []
    assert bench.of(Finished) == [Finished(execution="e1")]
