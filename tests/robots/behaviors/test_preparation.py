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
