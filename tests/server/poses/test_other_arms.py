"""Several arms of one run are shown together, each where it stands."""

import math
from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from shown_run import AT, SHOWS, driving_state, hello, poses

from mend.robots.link.messages import PoseLayout, PoseValues
from mend.server.models.robot_models import DrawnModel
from mend.server.poses.bases import joined, seen_from
from mend.server.poses.feed import PoseFeed, RunPoses
from mend.server.poses.frame import DecodedFrame, decode
from mend.tasks.scene import Base

LEFT = Base(x=0.0, y=0.0)
OPPOSITE = Base(x=1.5, y=0.2, yaw=math.pi)


@pytest.fixture
def asked() -> list[tuple[str, float]]:
    return []


@pytest.fixture
def run(asked: list[tuple[str, float]]) -> RunPoses:
    feed = PoseFeed(
        lambda robot, rate: asked.append((robot, rate)),
        lambda model: DrawnModel(f"/models/{model}", own_colors=False),
    )
    return feed.open(driving_state(("left", LEFT), ("right", OPPOSITE)))


def shown(run: RunPoses) -> DecodedFrame:
    assert run.frame is not None
    return decode(run.frame)


async def test_the_layout_names_the_other_arms(run: RunPoses) -> None:
    run.robot_connected(hello(robot="left"))
    assert run.layout is not None
    assert run.layout.arms == []
    run.robot_connected(hello(robot="right"))
    assert run.layout.robot == "left"
    [arm] = run.layout.arms
    assert (arm.robot, arm.model, arm.joints) == ("right", "/models/pr2", ["elbow"])


async def test_each_arm_is_where_it_stands_and_as_it_was_told(
    run: RunPoses, asked: list[tuple[str, float]]
) -> None:
    for name in ("left", "right"):
        run.robot_connected(hello(robot=name))
    run.take("left", 1.0, poses(0.25))
    assert run.frame is None
    run.take("right", 1.0, poses(0.75))
    frame = shown(run)
    [arm] = frame.arms
    assert list(frame.joints) == [0.25]
    assert (arm.number, list(arm.joints), arm.age_s) == (0, [0.75], 0.0)
    assert arm.base == pytest.approx((1.5, 0.2, 0.0, 0.0, 0.0, 1.0, 0.0), abs=1e-6)
    assert arm.tool == pytest.approx(AT)
    assert {name for name, _ in asked} == {"left", "right"}


async def test_what_another_arm_holds_is_where_that_has_it(run: RunPoses) -> None:
    for name in ("left", "right"):
        run.robot_connected(hello(robot=name))
    run.take("left", 1.0, poses())
    run.take("right", 1.0, poses(held=True))
    [cup] = shown(run).objects
    assert cup.held
    # Half a turn about: 0.5 m ahead and 0.1 m to the left of it.
    assert cup.pose[:3] == pytest.approx((1.0, 0.1, 0.7), abs=1e-6)


async def test_an_arm_that_says_nothing_more_stays_and_tells_how_long_ago_that_was(
    run: RunPoses,
) -> None:
    for name in ("left", "right"):
        run.robot_connected(hello(robot=name))
    run.take("right", 1.0, poses(0.75))
    run.take("left", 1.0, poses())
    run.take("left", 6.0, poses())
    run.end()
    [arm] = shown(run).arms
    assert (list(arm.joints), arm.age_s) == ([0.75], 5.0)


async def test_poses_that_do_not_fit_what_their_robot_shows_are_left_out(run: RunPoses) -> None:
    for name in ("left", "right"):
        run.robot_connected(hello(robot=name))
    run.take("right", 1.0, poses(joints=3))
    run.take("left", 1.0, poses())
    assert shown(run).arms == []


async def test_a_base_without_an_arm_is_no_arm(run: RunPoses) -> None:
    run.robot_connected(hello(robot="left"))
    run.robot_connected(hello(PoseLayout(drives=True), robot="right"))
    assert run.layout is not None
    assert run.layout.arms == []
    assert run.layout.robots == ["left", "right"]


async def test_an_arm_that_comes_back_with_other_joints_is_laid_out_anew(run: RunPoses) -> None:
    for name in ("left", "right"):
        run.robot_connected(hello(robot=name))
    run.take("right", 1.0, poses())
    run.robot_connected(
        hello(SHOWS.model_copy(update={"joints": ["a", "b"]}), robot="right", boot="b2")
    )
    assert run.layout is not None
    assert run.layout.arms[0].joints == ["a", "b"]
    run.take("left", 2.0, poses())
    run.end()
    assert shown(run).arms == []


def quaternion(values: Sequence[float]) -> tuple[float, ...]:
    return tuple(Rotation.from_quat(values).as_quat())


metres = st.floats(-10.0, 10.0)
part = st.floats(-1.0, 1.0)
turns = (
    st.tuples(part, part, part, part)
    .filter(lambda values: np.linalg.norm(values) > 0.1)
    .map(quaternion)
)
a_pose = st.builds(lambda at, turn: (*at, *turn), st.tuples(metres, metres, metres), turns)


@given(a_pose, a_pose)
def test_poses_are_joined_as_transforms_are_and_taken_apart_again(
    frame: PoseValues, pose: PoseValues
) -> None:
    found = joined(frame, pose)
    turned = Rotation.from_quat(frame[3:])
    assert found[:3] == pytest.approx(turned.apply(pose[:3]) + frame[:3], abs=1e-9)
    expected = turned * Rotation.from_quat(pose[3:])
    assert (Rotation.from_quat(found[3:]) * expected.inv()).magnitude() < 1e-6
    assert seen_from(frame, found) == pytest.approx(pose, abs=1e-9)
