"""What the arm feels: a brush asks nobody, a wall is told after three ever gentler tries."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from robot_bench import RobotBench

from mend.robots.arm.behaviors.contact import ContactWatch, Track, hindering_n, is_arrival
from mend.robots.arm.body import ToolPose
from mend.robots.execution.execution_state import ExecutionState
from mend.robots.link.messages import Finished, Holding, IssueDetected, Resume

PERIOD_S = 1 / 240


def push_where(bench: RobotBench, pushes: Callable[[ToolPose], float]) -> list[float]:
    """The arm feels what `pushes` says of where it is; the speed at which each push began."""
    begun: list[float] = []

    def act() -> None:
        was, bench.body.force_n = bench.body.force_n, pushes(bench.body.tool)
        if bench.body.force_n > 5.0 >= was:
            begun.append(bench.body.speeds[-1] if bench.body.speeds else 0.0)

    bench.body.at_cycle = act
    return begun


def test_a_single_brush_asks_nobody() -> None:
    bench = RobotBench()
    left = [8]

    def brush(_: ToolPose) -> float:
        progress = bench.robot.task_progress
        if progress is None or progress.step != 5 or progress.fraction < 0.5 or left[0] == 0:
            return 0.0
        left[0] -= 1
        return 60.0

    push_where(bench, brush)
    bench.start("pink_bar")
    bench.run()
    assert left[0] < 8
    assert bench.of(IssueDetected) == []
    assert bench.of(Finished) == [Finished(execution="e1")]
    resting = bench.body.parts["pink_bar"]
    assert math.dist((resting.x, resting.y), (0.55, 0.05)) < 0.004


def test_a_wall_is_tried_three_times_ever_slower_and_then_told() -> None:
    bench = RobotBench()
    pushed = push_where(bench, lambda tool: 45.0 if tool.y > -0.15 else 0.0)
    bench.start("pink_bar")
    issue = bench.run_until(IssueDetected)
    assert (issue.issue, issue.step) == ("blocked", 5)
    assert issue.detection is not None
    assert "45 N push against the arm, felt in 3 tries" in issue.detection.explanation
    assert len(pushed) == 3
    assert bench.body.tool.y < -0.15
    bench.run()
    assert bench.of(Holding) == [Holding(execution="e1", at="in_place")]
    assert pushed == pytest.approx([0.75, 0.3, 0.15])


def test_behind_a_wall_that_is_taken_away_it_goes_on() -> None:
    bench = RobotBench()
    push_where(bench, lambda tool: 45.0 if tool.y > -0.15 else 0.0)
    bench.start("pink_bar")
    bench.run_until(IssueDetected)
    bench.run()
    bench.body.at_cycle = lambda: None
    bench.body.force_n = 0.0
    bench.send(Resume(execution="e1"))
    bench.run()
    assert bench.of(Finished) == [Finished(execution="e1")]


def on_the_way_down(bench: RobotBench, do: Callable[[], None]) -> list[float]:
    """Once the empty hand is halfway down something happens, and something keeps it from there.

    The speed at which each push began; nothing pushes any more where the arm comes down later.
    """
    happened: list[ToolPose] = []

    def pushes(tool: ToolPose) -> float:
        progress = bench.robot.task_progress
        if progress is None or progress.step != 2:
            return 0.0
        if not happened and progress.fraction >= 0.5:
            happened.append(tool)
            do()
        return 35.0 if any(_is_under(tool, each) for each in happened) else 0.0

    return push_where(bench, pushes)


def _is_under(tool: ToolPose, where: ToolPose) -> bool:
    return math.dist((tool.x, tool.y), (where.x, where.y)) < 0.05 and tool.z <= where.z


def test_a_hand_that_meets_what_is_not_its_part_says_that_the_part_is_missing() -> None:
    bench = RobotBench()
    pushed = on_the_way_down(bench, lambda: bench.body.vanish("pink_bar"))
    bench.start("pink_bar")
    bench.run()
    assert [each.issue for each in bench.of(IssueDetected)] == ["missing"]
    assert len(pushed) == 1


def test_a_hand_that_meets_something_takes_its_part_where_that_is_now() -> None:
    bench = RobotBench()

    def push_aside() -> None:
        bench.body.parts["pink_bar"].y += 0.09

    on_the_way_down(bench, push_aside)
    bench.start("pink_bar")
    bench.run()
    assert bench.of(IssueDetected) == []
    resting = bench.body.parts["pink_bar"]
    assert math.dist((resting.x, resting.y), (0.55, 0.05)) < 0.004


def test_what_an_empty_hand_meets_and_no_camera_shows_is_blocked() -> None:
    bench = RobotBench()
    pushed = on_the_way_down(bench, lambda: None)
    bench.start("pink_bar")
    bench.run()
    (issue,) = bench.of(IssueDetected)
    assert issue.issue == "blocked"
    assert issue.detection is not None
    assert issue.detection.felt
    assert "35 N push against the arm, felt in 3 tries" in issue.detection.explanation
    assert pushed == pytest.approx([0.5, 0.2, 0.1])
    assert bench.of(Holding) == [Holding(execution="e1", at="neutral")]


def test_a_hand_that_is_held_up_on_its_way_to_look_stops_there() -> None:
    bench = RobotBench()
    on_the_way_down(bench, lambda: None)
    push = bench.body.at_cycle

    def act() -> None:
        push()
        if bench.robot.task_progress is not None and bench.robot.task_progress.step == 0:
            bench.body.force_n = 60.0 if bench.body.tool.y < -0.5 else 0.0

    bench.body.at_cycle = act
    bench.start("pink_bar")
    bench.run()
    assert [each.issue for each in bench.of(IssueDetected)] == ["blocked"]
    assert bench.of(Holding) == [Holding(execution="e1", at="in_place")]


def test_it_tries_anew_after_somebody_has_helped() -> None:
    bench = RobotBench()
    on_the_way_down(bench, lambda: None)
    bench.start("pink_bar")
    bench.run()
    bench.body.at_cycle = lambda: None
    bench.body.force_n = 0.0
    bench.send(Resume(execution="e1"))
    bench.run()
    assert bench.of(Finished) == [Finished(execution="e1")]


def test_the_weight_of_what_is_carried_is_no_contact() -> None:
    bench = RobotBench()
    push_where(bench, lambda _: 8.0)
    bench.start("pink_bar")
    bench.run()
    assert bench.of(IssueDetected) == []
    assert len(bench.of(Finished)) == 1


def in_step(bench: RobotBench, step: int, push: Callable[[ToolPose], float]) -> None:
    def pushes(tool: ToolPose) -> float:
        progress = bench.robot.task_progress
        return push(tool) if progress is not None and progress.step == step else 0.0

    push_where(bench, pushes)


def placing(pushed_from_m: float) -> RobotBench:
    """A hand that is pushed as soon as it is less than so far above the end of placing."""
    bench = RobotBench()
    bench.start("pink_bar")
    bench.run_to(5, 0.5)
    execution = bench.robot._execution
    assert execution is not None
    place_z = min(pose.z for pose in execution.way)
    in_step(bench, 6, lambda tool: 40.0 if tool.z < place_z + pushed_from_m else 0.0)
    return bench


@pytest.mark.parametrize("early_m", [0.002, 0.006])
def test_contact_near_the_end_of_placing_is_what_was_to_be_come_down_on(early_m: float) -> None:
    bench = placing(early_m)
    bench.run()
    assert bench.of(IssueDetected) == []
    assert bench.of(Finished) == [Finished(execution="e1")]


def test_contact_well_above_the_place_is_blocked() -> None:
    bench = placing(0.03)
    issue = bench.run_until(IssueDetected)
    assert (issue.issue, issue.step) == ("blocked", 6)


def test_a_part_lost_while_backing_off_is_dropped() -> None:
    bench = RobotBench()
    pushed = push_where(bench, lambda tool: 45.0 if tool.y > -0.15 else 0.0)
    push = bench.body.at_cycle

    def act() -> None:
        push()
        if pushed and bench.body.tool.y < -0.16:
            bench.body.vanish("pink_bar")

    bench.body.at_cycle = act
    bench.start("pink_bar")
    bench.run()
    assert [each.issue for each in bench.of(IssueDetected)] == ["dropped"]


def lose_while_pulled(bench: RobotBench, gone: Callable[[], bool]) -> None:
    """Somebody pulls at what is held until it is gone."""

    def pull() -> None:
        bench.body.force_n = 60.0 if bench.body.in_hand is not None else 0.0
        if gone():
            bench.body.vanish("pink_bar")

    bench.body.at_cycle = pull
    bench.run()
    assert [each.issue for each in bench.of(IssueDetected)] == ["dropped"]


def test_a_part_pulled_away_while_it_is_put_down_is_dropped() -> None:
    bench = RobotBench()
    bench.start("pink_bar")
    bench.run_to(6, 0.3)
    execution = bench.robot._execution
    assert execution is not None
    lose_while_pulled(bench, lambda: execution.state is ExecutionState.BACKING_OFF)


def test_a_part_pulled_away_before_the_hand_has_moved_is_dropped() -> None:
    bench = RobotBench()
    bench.start("pink_bar")
    bench.run_to(4, 0.0)
    pulled_s = bench.body.time_s()
    lose_while_pulled(bench, lambda: bench.body.time_s() > pulled_s + 0.6)


@given(
    limit_n=st.floats(8.0, 30.0), forces=st.lists(st.floats(0.0, 1.0), min_size=1, max_size=2000)
)
def test_forces_below_the_limit_never_add_up(limit_n: float, forces: list[float]) -> None:
    watch = ContactWatch(limit_n)
    assert not any(watch.feel(share * limit_n, PERIOD_S) for share in forces)


@given(limit_n=st.floats(8.0, 30.0), more_n=st.floats(5.0, 200.0), quiet=st.integers(0, 500))
def test_a_force_above_the_limit_is_felt_in_time_whatever_went_before(
    limit_n: float, more_n: float, quiet: int
) -> None:
    watch = ContactWatch(limit_n)
    for _ in range(quiet):
        watch.feel(1.0, PERIOD_S)
    cycles = 1
    while not watch.feel(limit_n + more_n, PERIOD_S):
        cycles += 1
    assert cycles * PERIOD_S <= 0.3 / more_n + 2 * PERIOD_S
    assert watch.strongest_n == limit_n + more_n


@pytest.mark.parametrize(
    ("force", "hinders_n"),
    [((0.0, 0.0, 40.0), 0.0), ((0.0, 0.0, -40.0), 40.0), ((30.0, 0.0, 40.0), 30.0)],
)
def test_what_helps_along_the_way_hinders_nothing(force, hinders_n) -> None:
    here, up = ToolPose(0.5, 0.1, 0.8, 0.0), ToolPose(0.5, 0.1, 0.94, 0.0)
    assert hindering_n(np.array(force), here, up) == pytest.approx(hinders_n)


def test_the_way_back_is_the_way_that_it_came() -> None:
    track = Track()
    for step in range(50):
        track.note(ToolPose(0.5, 0.0, 1.0 - 0.003 * step, 0.0))
    back = track.way_back()
    heights = [pose.z for pose in back]
    assert heights == sorted(heights)
    assert 0.10 <= heights[-1] - (1.0 - 0.003 * 49) <= 0.12
    assert Track().way_back() == []


@pytest.mark.parametrize(
    ("here", "arrives"),
    [
        ((0.5, 0.1, 0.805), True),
        ((0.5, 0.1, 0.797), True),
        ((0.5, 0.1, 0.83), False),
        ((0.52, 0.1, 0.802), False),
    ],
)
def test_only_what_is_met_at_the_end_of_the_way_is_an_arrival(here, arrives) -> None:
    assert is_arrival(ToolPose(*here, 0.0), ToolPose(0.5, 0.1, 0.8, 0.0)) is arrives
