"""The search for an object: what something hides is where it was last seen whole."""

from drawn_scene import TABLE_Z
from robot_bench import RobotBench

from mend.robots.link.messages import Finished, IssueDetected, Looked


def hidden_bench() -> RobotBench:
    """Where the pink bar was seen something tall stands before it now."""
    bench = RobotBench()
    bench.look()
    bench.run()
    bench.body.grey_boxes = [((0.36, -0.25, TABLE_Z), (0.05, 0.2, 0.2))]
    return bench


def test_what_something_hides_is_taken_where_it_was_last_seen() -> None:
    bench = hidden_bench()
    bench.look()
    bench.run()
    assert "pink_bar" not in bench.of(Looked)[-1].objects
    bench.start("pink_bar")
    bench.run()
    assert bench.of(IssueDetected) == []
    assert len(bench.of(Finished)) == 1


def test_what_was_taken_away_while_hidden_is_missed() -> None:
    bench = hidden_bench()
    bench.body.vanish("pink_bar")
    bench.start("pink_bar")
    bench.run()
    (issue,) = bench.of(IssueDetected)
    assert issue.issue == "missed"


def test_what_was_never_seen_is_not_taken_to_be_anywhere() -> None:
    bench = RobotBench()
    bench.body.grey_boxes = [((0.36, -0.25, TABLE_Z), (0.05, 0.2, 0.2))]
    bench.start("pink_bar")
    bench.run()
    (issue,) = bench.of(IssueDetected)
    assert issue.issue == "missing"
