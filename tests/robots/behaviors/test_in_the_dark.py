"""A robot whose head camera shows nothing starts nothing, and calls nothing done."""

from robot_bench import RobotBench

from robots.link.messages import Finished, IssueDetected, Resume, StepStarted


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
