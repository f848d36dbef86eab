"""Before the first step: what keeps the arm from its way is in it, if nobody knows what it is."""

from drawn_scene import TABLE_Z
from robot_bench import RobotBench

from robots.link.messages import Finished, IssueDetected, Looked, Resume

BESIDE = ((0.75, -0.45, TABLE_Z), (0.06, 0.06, 0.2))
"""Outside the tool point's way, where a forearm may touch it."""


def blocked_bench() -> RobotBench:
    bench = RobotBench()
    bench.body.avoids_the_unknown = True
    bench.body.grey_boxes = [BESIDE]
    bench.start("pink_bar")
    bench.run()
    return bench


def test_something_unknown_without_which_there_is_a_path_is_in_the_way() -> None:
    (issue,) = blocked_bench().of(IssueDetected)
    assert (issue.issue, issue.step) == ("blocked", 0)
    assert issue.detection is not None
    assert issue.detection.explanation == "something unknown is in the arm's way"


def test_the_way_is_not_clear_before_that_is_gone() -> None:
    bench = blocked_bench()
    bench.look(expect="way_clear", within_s=1.0)
    bench.run()
    assert bench.of(Looked)[-1].fulfilled is False
    bench.body.grey_boxes = []
    bench.look(expect="way_clear", within_s=1.0)
    bench.run()
    assert bench.of(Looked)[-1].fulfilled is True
    bench.send(Resume(execution="e1"))
    bench.run()
    assert bench.of(Finished) == [Finished(execution="e1")]


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
