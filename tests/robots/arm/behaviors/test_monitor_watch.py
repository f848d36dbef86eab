"""A step whose grip is judged ends with a picture from after the arm has arrived."""

from robot_bench import RobotBench

from mend.robots.link.messages import IssueDetected, StepStarted

CARRY, PLACE = 5, 6
SELDOM_S = 1.0


def bench_at_the_end_of_carrying() -> RobotBench:
    """A robot whose forearm camera takes a picture a second, just before it is above the place."""
    bench = RobotBench(period_s=SELDOM_S)
    bench.start("pink_bar")
    bench.run_to(CARRY, 0.97)
    return bench


def test_what_is_lost_after_the_last_picture_on_the_way_is_noticed_above_the_place() -> None:
    bench = bench_at_the_end_of_carrying()
    bench.body.vanish("pink_bar")
    issue = bench.run_until(IssueDetected)
    assert (issue.issue, issue.step) == ("dropped", CARRY)
    assert PLACE not in [each.step for each in bench.of(StepStarted)]


def test_what_is_held_is_placed_after_one_picture_above_the_place() -> None:
    bench = bench_at_the_end_of_carrying()
    taken = bench.body.cameras["forearm"].pictures_taken
    while bench.of(StepStarted)[-1].step < PLACE:
        bench.run_until(StepStarted)
    assert bench.body.cameras["forearm"].pictures_taken == taken + 1
