"""A robot that is wrong in silence is found out, and one that says that it is lost is not."""

from dataclasses import replace

import numpy as np
import pytest
from believed_poses import FAR_M, FAR_S, BelievedPoses
from building_bench import BuildingBench


@pytest.fixture
def bench() -> BuildingBench:
    return BuildingBench(localizer="enml")


def test_who_is_carried_away_unawares_is_wrong_in_silence(bench: BuildingBench) -> None:
    robot, poses = bench.world.robots[0], BelievedPoses(bench.world.robots)
    poses.look(0.0, 0.25)
    robot.stand(replace(robot.at, x=robot.at.x + FAR_M + 1.0))
    for number in range(1, round(FAR_S / 0.25) + 2):
        poses.look(0.25 * number, 0.25)
    assert poses.silent == {"silent": 1}
    assert poses.silent_s == pytest.approx(FAR_S + 0.25)
    assert max(poses.off_m) == pytest.approx(FAR_M + 1.0, abs=0.01)
    assert "3.00 m (max)" in poses.told


def test_who_says_that_it_is_lost_is_not_silent(bench: BuildingBench) -> None:
    robot, poses = bench.world.robots[0], BelievedPoses(bench.world.robots)
    assert robot.belief is not None
    at, wheels = np.array([robot.at.x, robot.at.y, 0.0]), np.zeros(3)
    robot.stand(replace(robot.at, x=robot.at.x + FAR_M + 1.0))
    robot.belief.whereabouts.start_anew(at, wheels, lost=True)
    for number in range(1, 41):
        poses.look(0.25 * number, 0.25)
    assert not poses.silent
    assert poses.still_lost == 1
    robot.belief.whereabouts.start_anew(at, wheels, lost=False)
    poses.look(12.0, 0.25)
    assert poses.lost_s == [pytest.approx(11.75)]
    assert poses.still_lost == 0


def test_who_was_told_a_lie_is_counted_apart(bench: BuildingBench) -> None:
    robot, poses = bench.world.robots[0], BelievedPoses(bench.world.robots)
    poses.lied_to.add(0)
    robot.stand(replace(robot.at, x=robot.at.x + FAR_M + 1.0))
    poses.look(10.0, 10.0)
    assert poses.silent == {"silent after a lie": 1}
