"""A robot whose head camera shows nothing starts nothing, and calls nothing done."""

import pytest
from drawn_scene import Resting
from robot_bench import RobotBench

from mend.robots.link.messages import Finished, IssueDetected, Looked, Resume, StepStarted

ITS_PLACE = (0.55, 0.05)


def issues(bench: RobotBench) -> list[tuple[str, int]]:
    return [(each.issue, each.step) for each in bench.of(IssueDetected)]


def test_in_the_dark_no_step_is_taken() -> None:
    bench = RobotBench()
    bench.body.head_covered = True
    bench.start("pink_bar")
    bench.run()
    assert issues(bench) == [("blind", 0)]
    assert bench.of(StepStarted) == []
    bench.send(Resume(execution="e1"))
    bench.run()
    assert issues(bench) == [("blind", 0)] * 2
    bench.body.head_covered = False
    bench.send(Resume(execution="e1"))
    bench.run()
    assert bench.of(Finished) == [Finished(execution="e1")]


def test_one_dark_picture_is_no_reason_to_stop() -> None:
    bench = RobotBench()
    bench.body.head_covered = True
    head = bench.body.cameras["head"]

    def light_up() -> None:
        if head.pictures_taken:
            bench.body.head_covered = False

    bench.body.at_cycle = light_up
    bench.start("pink_bar")
    bench.run()
    assert issues(bench) == []
    assert len(bench.of(Finished)) == 1


def test_what_was_put_down_in_the_dark_is_done_once_it_is_seen_and_by_the_robot() -> None:
    bench = RobotBench()
    bench.start("pink_bar")
    bench.run_to(6)
    bench.body.head_covered = True
    bench.run()
    assert issues(bench) == [("blind", 8)]
    assert bench.of(Finished) == []
    bench.body.head_covered = False
    bench.send(Resume(execution="e1"))
    bench.run()
    assert bench.of(Finished) == [Finished(execution="e1", found_in_place=False)]


@pytest.mark.parametrize("looked_at", [True, False])
def test_what_was_put_where_nothing_is_measured_is_done_once_that_is_seen(looked_at: bool) -> None:
    bench = RobotBench()
    bench.start("pink_bar")
    bench.run_to(6)
    bench.body.head_covered_at = ITS_PLACE
    bench.run()
    (issue,) = bench.of(IssueDetected)
    assert (issue.issue, issue.step) == ("blind", 8)
    why = "my head camera measures no depth where pink_bar is to be"
    assert issue.detection.explanation == why
    assert bench.of(Finished) == []
    bench.look(expect="view_clear")
    bench.run()
    assert bench.of(Looked)[-1].blind == why
    bench.send(Resume(execution="e1"))
    bench.run()
    assert issues(bench) == [("blind", 8), ("blind", 0)]
    bench.body.head_covered_at = None
    if looked_at:
        bench.look(expect="view_clear")
        bench.run()
        assert (bench.of(Looked)[-1].fulfilled, bench.of(Looked)[-1].blind) == (True, None)
    bench.send(Resume(execution="e1"))
    bench.run()
    assert bench.of(Finished) == [Finished(execution="e1", found_in_place=False)]
    assert issues(bench) == [("blind", 8), ("blind", 0)]


def test_what_is_seen_elsewhere_needs_no_sight_of_its_place() -> None:
    bench = RobotBench()
    bench.start("pink_bar")
    bench.run_to(6)
    bench.body.head_covered_at = ITS_PLACE
    bench.run()
    bench.body.parts["pink_bar"] = Resting(0.55, 0.25)
    bench.look(expect="view_clear")
    bench.run()
    assert (bench.of(Looked)[-1].fulfilled, bench.of(Looked)[-1].blind) == (True, None)
    bench.send(Resume(execution="e1"))
    bench.run()
    assert bench.of(Finished) == []
    assert [issue for issue, _ in issues(bench)][:2] == ["blind", "blind"]


def test_what_was_taken_away_in_the_dark_is_told_and_not_called_done() -> None:
    bench = RobotBench()
    bench.start("pink_bar")
    bench.run_to(6)
    bench.body.head_covered = True
    bench.run()
    bench.body.vanish("pink_bar")
    bench.body.head_covered = False
    bench.send(Resume(execution="e1"))
    bench.run()
    assert bench.of(Finished) == []
    assert [issue for issue, _ in issues(bench)] == ["blind", "missing"]
