"""The floating gripper moves straight, grasps what it closes on and drops what it lets go."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tabletop_hands import TABLE_M, Hands

from mend.robots.arm.body import ToolPose
from mend.robots.vision.blindness import table_px
from mend.sim.tabletop.world import TabletopWorld
from mend.tasks.frames import frames_of
from mend.tasks.scene import Base, Scene, Table


def test_a_segment_is_straight_and_takes_longer_when_slower(hands: Hands) -> None:
    hands.go(0.4, -0.4, 1.0, 0.0)
    path = hands.body.plan_path([ToolPose(0.7, -0.1, 1.2, 0.0)])
    assert path is not None
    cycles = {}
    for speed in (1.0, 0.25):
        hands.go(0.4, -0.4, 1.0, 0.0)
        hands.body.follow(path, 0, speed)
        cycles[speed] = 0
        while hands.body.moving:
            hands.body.advance_cycle()
            cycles[speed] += 1
            x, y, z = hands.tool()
            share = (x - 0.4) / 0.3
            assert (y, z) == pytest.approx((-0.4 + 0.3 * share, 1.0 + 0.2 * share))
    assert cycles[0.25] == 4 * cycles[1.0]


def test_progress_grows_to_one_and_is_one_at_rest(hands: Hands) -> None:
    assert hands.body.progress == 1.0
    path = hands.body.plan_path([ToolPose(0.5, -0.2, 1.0, 0.0)])
    assert path is not None
    hands.body.follow(path, 0, 0.5)
    seen = []
    while hands.body.moving:
        seen.append(hands.body.progress)
        hands.body.advance_cycle()
    assert seen == sorted(seen)
    assert seen[0] == 0.0
    assert 0.0 < seen[-1] < 1.0
    assert hands.body.progress == 1.0


def test_stop_ends_the_motion_where_the_arm_is(hands: Hands) -> None:
    path = hands.body.plan_path([ToolPose(0.5, -0.2, 1.0, 0.0)])
    assert path is not None
    hands.body.follow(path, 0, 0.3)
    hands.body.advance_cycle()
    before = hands.tool()
    hands.body.stop()
    hands.wait(1.0)
    assert hands.tool() == before
    assert not hands.body.moving


def test_speed_changes_from_the_next_cycle_on(hands: Hands) -> None:
    path = hands.body.plan_path([ToolPose(0.5, -0.2, 1.0, 0.0)])
    assert path is not None
    hands.body.follow(path, 0, 1.0)
    hands.body.advance_cycle()
    fast = hands.body.progress
    hands.body.set_speed(0.1)
    hands.body.advance_cycle()
    assert hands.body.progress - fast == pytest.approx(fast / 10)


@pytest.mark.parametrize(
    "pose",
    [
        ToolPose(1.2, -0.2, 1.0, 0.0),
        ToolPose(0.05, -0.19, 1.0, 0.0),
        ToolPose(0.5, -0.2, TABLE_M - 0.01, 0.0),
        ToolPose(0.5, -0.2, 3.0, 0.0),
    ],
    ids=["too far", "too near", "in the table", "too high"],
)
def test_no_path_leads_out_of_reach(world: TabletopWorld, pose: ToolPose) -> None:
    assert world.body.plan_path([ToolPose(0.5, -0.2, 1.0, 0.0), pose]) is None


def test_a_path_of_another_body_is_refused(world: TabletopWorld) -> None:
    class OtherPath:
        segments = 1

    with pytest.raises(TypeError, match="planned by this body"):
        world.body.follow(OtherPath(), 0, 1.0)


@pytest.mark.parametrize("name", ["red", "green", "plate"])
def test_a_grasped_part_comes_along(hands: Hands, name: str) -> None:
    hands.pick(name)
    assert hands.world.held == name
    hands.go(0.5, 0.1, 1.0, 0.4)
    pose = hands.world.pose_of(name)
    assert pose is not None
    assert (pose.x, pose.y) == pytest.approx((0.5, 0.1), abs=1e-6)
    grasped = hands.world.scene.objects[name].knob or hands.world.scene.objects[name].size
    assert hands.body.gripper_opening_m() == pytest.approx(min(grasped[:2]))


def test_closing_fingers_centre_a_part(hands: Hands) -> None:
    hands.pick("red", off_m=0.02)
    assert hands.world.held == "red"
    pose = hands.world.pose_of("red")
    assert pose is not None
    assert (pose.x, pose.y) == pytest.approx(hands.tool()[:2])


@pytest.mark.parametrize(
    ("off_m", "turn"), [(0.035, 0.0), (0.0, math.pi / 2 - 0.5)], ids=["beside", "across"]
)
def test_fingers_that_do_not_go_around_a_part_close_on_nothing(
    scene: Scene, off_m: float, turn: float
) -> None:
    wide = scene.objects["red"].model_copy(update={"size": (0.10, 0.03, 0.05)})
    world = TabletopWorld(
        scene.model_copy(update={"objects": {**scene.objects, "red": wide}}), seed=1
    )
    hands = Hands(world)
    before = world.pose_of("red")
    hands.pick("red", off_m=off_m, turn=turn)
    assert world.held is None
    assert world.pose_of("red") == before
    assert hands.body.gripper_opening_m() == 0.0


def test_closing_again_does_not_lose_what_is_held(hands: Hands) -> None:
    hands.pick("red")
    opening = hands.body.gripper_opening_m()
    hands.close()
    assert hands.world.held == "red"
    assert hands.body.gripper_opening_m() == opening


def test_a_part_that_is_let_go_falls_onto_the_table(hands: Hands) -> None:
    hands.pick("green")
    hands.go(0.5, 0.1, 1.0, 0.0)
    hands.open()
    pose = hands.world.pose_of("green")
    assert pose is not None
    assert hands.world.held is None
    assert (pose.x, pose.y, pose.z) == pytest.approx((0.5, 0.1, TABLE_M))


def test_a_part_that_is_let_go_falls_onto_another(hands: Hands) -> None:
    hands.pick("red")
    hands.go(0.6, -0.1, 1.0, 0.0)
    hands.open()
    pose = hands.world.pose_of("red")
    assert pose is not None
    assert pose.z == pytest.approx(TABLE_M + 0.08)


def test_a_part_that_is_let_go_inside_another_comes_to_rest_on_top_of_it(hands: Hands) -> None:
    hands.pick("red")
    hands.go(0.6, -0.1, TABLE_M + 0.03, 0.0)
    hands.open()
    pose = hands.world.pose_of("red")
    assert pose is not None
    assert pose.z == pytest.approx(TABLE_M + 0.08)


def test_what_rests_on_a_part_falls_when_it_is_taken_away(hands: Hands) -> None:
    hands.pick("red")
    hands.go(0.6, -0.1, 1.0, 0.0)
    hands.open()
    hands.go(0.6, -0.1, 1.1, 0.0)
    green = hands.world.pose_of("green")
    assert green is not None
    hands.go(green.x, green.y, green.z + 0.04, green.yaw)
    hands.close()
    assert hands.world.held == "green"
    hands.go(0.5, 0.1, 1.1, 0.0)
    hands.open()
    red = hands.world.pose_of("red")
    assert red is not None
    assert red.z == pytest.approx(TABLE_M)


def test_a_part_beyond_the_edge_falls_to_the_floor(scene: Scene) -> None:
    world = TabletopWorld(scene, seed=7)
    hands = Hands(world)
    hands.pick("red")
    hands.body.follow(hands.body.plan_neutral(), 0, 1.0)
    hands.settle()
    hands.open()
    pose = world.pose_of("red")
    assert pose is not None
    assert pose.z == 0.0


def test_neutral_hides_nothing_from_the_head_camera(world: TabletopWorld) -> None:
    with_arm = world.cameras[0].head.capture_with_ids()[1]
    for name in world.scene.objects:
        index = list(world.scene.objects).index(name)
        rows, columns = np.nonzero(with_arm == index)
        assert len(rows) > 20
        assert rows.min() > 0
        assert rows.max() < 479
        assert columns.min() > 0
        assert columns.max() < 639


@pytest.mark.parametrize("size", [(0.4, 0.4), (0.5, 1.2), (0.6, 1.6), (0.9, 0.9)])
def test_neutral_hides_nothing_of_the_table_from_robots_at_other_sides(
    size: tuple[float, float],
) -> None:
    near_m = 0.30
    x, y = near_m + size[0] / 2, -0.2
    table = Table(center=(x, y), size=size)
    bases = {
        "here": Base(x=0.0, y=0.0),
        "across": Base(x=2 * x, y=2 * y, yaw=math.pi),
        "end": Base(x=x, y=y + size[1] / 2 + near_m, yaw=-math.pi / 2),
    }
    scene = Scene(name="shared", table=table, objects={}, places={}, robots=bases)
    for body, frame in zip(
        TabletopWorld(scene, seed=0).bodies, frames_of(scene).values(), strict=True
    ):
        image = body.cameras["head"].capture()
        hidden = np.zeros(image.bgr.shape[:2], np.bool_) if image.others is None else image.others
        assert not (hidden & table_px(image, frame.table_to_robot(table))).any()


@given(x=st.floats(0.45, 0.65), y=st.floats(-0.5, 0.1), yaw=st.floats(-1.5, 1.5))
@settings(max_examples=25, deadline=None)
def test_the_tool_frame_points_down_and_opens_along_its_yaw(x: float, y: float, yaw: float) -> None:
    scene = Scene(name="empty", objects={}, places={})
    world = TabletopWorld(scene, seed=0)
    hands = Hands(world)
    hands.go(x, y, 1.0, yaw)
    pose = world.body.tool_pose()
    assert pose[:3, 3] == pytest.approx((x, y, 1.0))
    assert pose[:3, 0] == pytest.approx((0.0, 0.0, -1.0))
    assert pose[:3, 1] == pytest.approx((math.cos(yaw), math.sin(yaw), 0.0))
    assert np.linalg.det(pose[:3, :3]) == pytest.approx(1.0)
