"""The plan before the first step: what keeps the arm from its way, and could be taken away."""

import math

import pytest
from drawn_scene import PARTS, TABLE_Z, Resting
from robot_bench import RobotBench
from scripted_body import PLACES

from mend.robots.arm.grasp import OPEN_BESIDE_M, OPEN_LEAST_M
from mend.robots.link.messages import Finished, IssueDetected, Looked, Resume

BESIDE = ((0.75, -0.45, TABLE_Z), (0.06, 0.06, 0.2))
"""Outside the tool point's way, where a forearm may touch it."""


def blocked_bench() -> RobotBench:
    bench = RobotBench()
    bench.body.bars = frozenset({None})
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


def barred_by(name: str) -> RobotBench:
    """A bench at whose pink bar the arm does not get past a part."""
    bench = RobotBench()
    bench.body.bars = frozenset({name})
    bench.start("pink_bar")
    bench.run()
    return bench


def test_a_known_part_without_which_there_is_a_path_is_in_the_way_too() -> None:
    (issue,) = barred_by("green_leg").of(IssueDetected)
    assert (issue.issue, issue.step) == ("blocked", 0)
    assert issue.detection is not None
    assert issue.detection.part == "green_leg"
    assert issue.detection.explanation == "green_leg is in the arm's way"


def test_a_known_part_is_in_the_way_until_it_is_gone() -> None:
    bench = barred_by("green_leg")
    bench.look(expect="way_clear", within_s=1.0)
    bench.run()
    assert bench.of(Looked)[-1].fulfilled is False
    bench.body.vanish("green_leg")
    bench.look(expect="way_clear", within_s=1.0)
    bench.run()
    assert bench.of(Looked)[-1].fulfilled is True


def test_what_the_object_stands_on_cannot_be_cleared_out_of_its_way() -> None:
    bench = RobotBench()
    leg, bar = bench.body.parts["green_leg"], bench.body.parts["pink_bar"]
    bar.x, bar.y, bar.z, bar.yaw = leg.x, leg.y, TABLE_Z + 0.08, math.pi / 2
    bench.body.bars = frozenset({"green_leg"})
    bench.start("pink_bar")
    bench.run()
    (issue,) = bench.of(IssueDetected)
    assert issue.issue == "unreachable"


@pytest.mark.parametrize(("gap_m", "beside_m"), [(0.0235, OPEN_LEAST_M), (0.035, OPEN_BESIDE_M)])
def test_the_gripper_opens_as_wide_as_there_is_room_to_spare(gap_m: float, beside_m: float) -> None:
    """Opened wide, the fingers reach 22 mm beyond the part."""
    bench = RobotBench()
    place, width_m = PLACES["left"], PARTS["pink_bar"].size[1]
    y = place.y + width_m / 2 + gap_m + PARTS["green_leg"].size[0] / 2
    bench.body.parts["green_leg"] = Resting(place.x, y, yaw=math.pi / 2)
    bench.start("pink_bar")
    bench.run()
    assert bench.of(Finished) == [Finished(execution="e1")]
    assert bench.body.gripper_opening_m() == pytest.approx(width_m + 2 * beside_m)
