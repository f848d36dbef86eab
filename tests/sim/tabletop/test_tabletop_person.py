"""Every intervention does what it says, or says in a sentence why it cannot."""

import math

import numpy as np
import pytest
from tabletop_hands import TABLE_M, Hands

from mend.robots.arm.body import ToolPose
from mend.sim.acts import HAND_OVER_S
from mend.sim.tabletop.world import TabletopWorld
from mend.tasks.intervention import Act, Intervention
from mend.tasks.scene import Pose


def do(world: TabletopWorld, act: Act, name: str | None = None, **more: object) -> str:
    return world.intervene(Intervention(act=act, object=name, **more))  # type: ignore[arg-type]


def position(world: TabletopWorld, name: str) -> tuple[float, float, float]:
    pose = world.pose_of(name)
    assert pose is not None
    return pose.x, pose.y, pose.z


def test_a_stolen_part_is_gone_from_the_table(world: TabletopWorld) -> None:
    assert do(world, Act.STEAL, "red") == ""
    assert world.pose_of("red") is None
    assert not (world.cameras[0].head.capture_with_ids()[1] == 0).any()


def test_a_part_vanishes_from_between_the_fingers(hands: Hands) -> None:
    hands.pick("red")
    assert do(hands.world, Act.STEAL, "red") == ""
    assert hands.world.held is None
    assert hands.body.gripper_opening_m() == 0.0
    assert not (hands.world.cameras[0].forearm.capture_with_ids()[1] == 0).any()


def test_a_pulled_part_is_seen_sliding_out_before_it_is_gone(hands: Hands) -> None:
    hands.pick("red")
    x, y, _ = hands.tool()
    assert do(hands.world, Act.STEAL, "red", manner="pull") == ""
    distances = []
    for _ in range(20):
        hands.body.advance_cycle()
        pose = hands.world.pose_of("red")
        if pose is None:
            break
        distances.append(math.hypot(pose.x - x, pose.y - y))
    assert hands.world.pose_of("red") is None
    assert len(distances) >= 3
    assert distances == sorted(distances)
    assert hands.world.held is None


def test_fingers_that_close_on_a_part_that_is_pulled_away_hold_nothing(hands: Hands) -> None:
    pose = hands.world.pose_of("red")
    assert pose is not None
    hands.open()
    hands.go(pose.x, pose.y, TABLE_M + 0.025, pose.yaw + math.pi / 2)
    hands.body.close_gripper()
    while hands.body.gripper_opening_m() > 0.05:
        hands.body.advance_cycle()
    assert do(hands.world, Act.STEAL, "red", manner="pull") == ""
    hands.settle()
    hands.wait(1.5)
    assert hands.world.held is None
    assert hands.world.pose_of("red") is None
    assert hands.body.gripper_opening_m() == 0.0


def test_a_part_that_is_gone_cannot_be_stolen_again(world: TabletopWorld) -> None:
    do(world, Act.STEAL, "red")
    assert do(world, Act.STEAL, "red") == "'red' is gone already"


def test_put_back_brings_a_part_to_where_it_started(hands: Hands) -> None:
    start = position(hands.world, "red")
    hands.pick("red")
    do(hands.world, Act.STEAL, "red")
    assert do(hands.world, Act.PUT_BACK, "red") == ""
    assert position(hands.world, "red") == pytest.approx(start)


def test_place_puts_a_part_to_its_place(world: TabletopWorld) -> None:
    assert do(world, Act.PLACE, "red", place="middle") == ""
    pose = world.pose_of("red")
    assert pose is not None
    assert (pose.x, pose.y, pose.z, pose.yaw) == (0.65, -0.3, TABLE_M, 0.5)


def test_place_takes_the_part_from_the_robot(hands: Hands) -> None:
    hands.pick("red")
    assert do(hands.world, Act.PLACE, "red", place="left") == ""
    assert hands.world.held is None
    assert position(hands.world, "red") == pytest.approx((0.5, 0.1, TABLE_M))


def test_a_part_put_where_another_lies_rests_on_top_of_it(world: TabletopWorld) -> None:
    do(world, Act.PLACE, "green", place="left")
    do(world, Act.PLACE, "red", place="left")
    assert position(world, "red")[2] == pytest.approx(TABLE_M + 0.08)


def test_move_puts_a_part_anywhere_on_the_table(world: TabletopWorld) -> None:
    assert do(world, Act.MOVE, "red", to=Pose(x=0.8, y=0.2, yaw=1.0)) == ""
    assert position(world, "red") == pytest.approx((0.8, 0.2, TABLE_M))


WAY = {"between": ("F1/hall", "F1/lobby")}
OF_BUILDINGS: list[tuple[Act, dict[str, object]]] = [
    (Act.PUT_IN, {}),
    (Act.TAKE_OUT, {}),
    (Act.CHARGE, {}),
    (Act.BAR, WAY),
    (Act.CLEAR, WAY),
    (Act.SEND_PERSON, {}),
    (Act.MISDIRECT, {"elevator": "e1"}),
]


@pytest.mark.parametrize(
    ("act", "name", "more", "sentence"),
    [
        (Act.STEAL, "blue", {}, "the scene has no object 'blue'"),
        (Act.PLACE, "red", {}, "it does not say at which place to put 'red'"),
        (Act.PLACE, "red", {"place": "roof"}, "the scene has no place 'roof'"),
        (Act.MOVE, "red", {"to": Pose(x=3.0, y=0.0)}, "(3.0, 0.0) is not on the table"),
        (Act.RELEASE, None, {}, "nobody stands in the way"),
        *(
            (act, None, more, f"there is nothing at a table for which anybody could do '{act}'")
            for act, more in OF_BUILDINGS
        ),
    ],
)
def test_what_cannot_be_done_is_said_and_changes_nothing(
    world: TabletopWorld, act: Act, name: str | None, more: dict[str, object], sentence: str
) -> None:
    before = world.snapshot()
    assert do(world, act, name, **more) == sentence
    assert world.snapshot() == before


def test_a_part_is_held_out_between_open_fingers_at_rest_and_can_be_gripped(
    hands: Hands,
) -> None:
    hands.body.follow(hands.body.plan_hand_over(), 0, 1.0)
    assert do(hands.world, Act.HAND_OVER, "far") == ""
    hands.body.advance_cycle()
    assert not (hands.world.cameras[0].forearm.capture_with_ids()[1] == 3).any()
    hands.settle()
    hands.wait(0.2)
    assert (hands.world.cameras[0].forearm.capture_with_ids()[1] == 3).sum() > 50
    hands.close()
    assert hands.world.held == "far"
    hands.wait(HAND_OVER_S + 1)
    assert hands.world.held == "far"


def test_nobody_offers_a_part_to_closed_fingers(hands: Hands) -> None:
    hands.close()
    do(hands.world, Act.HAND_OVER, "far")
    hands.wait(1.0)
    assert not (hands.world.cameras[0].forearm.capture_with_ids()[1] == 3).any()


def test_a_part_that_nobody_takes_is_put_back_down(hands: Hands) -> None:
    start = position(hands.world, "far")
    do(hands.world, Act.HAND_OVER, "far")
    hands.wait(HAND_OVER_S + 0.5)
    assert position(hands.world, "far") == pytest.approx(start)
    assert (hands.world.cameras[0].head.capture_with_ids()[1] == 3).any()


def test_one_part_is_handed_over_at_a_time(world: TabletopWorld) -> None:
    do(world, Act.HAND_OVER, "far")
    assert do(world, Act.HAND_OVER, "red") == "somebody is handing over 'far' already"


def test_what_the_robot_holds_cannot_be_handed_over(hands: Hands) -> None:
    hands.pick("red")
    assert do(hands.world, Act.HAND_OVER, "red") == "the robot holds 'red' already"


def test_a_blocked_arm_pushes_and_gets_no_further(hands: Hands) -> None:
    hands.go(0.4, -0.4, 1.0, 0.0)
    assert do(hands.world, Act.BLOCK) == ""
    path = hands.body.plan_path([ToolPose(0.7, -0.1, 1.0, 0.0)])
    assert path is not None
    hands.body.follow(path, 0, 1.0)
    for _ in range(6):
        hands.body.advance_cycle()
    x, y, z = hands.tool()
    assert 0.4 < x < 0.6
    assert (x - 0.4, z) == pytest.approx((y + 0.4, 1.0))
    assert hands.body.contact_force_n() > 10
    assert hands.body.contact_force()[0] < 0.0
    assert do(hands.world, Act.RELEASE) == ""
    assert hands.body.contact_force_n() == 0.0
    hands.body.follow(path, 0, 1.0)
    hands.settle()
    assert hands.tool() == pytest.approx((0.7, -0.1, 1.0))


def test_a_blocked_arm_can_always_go_up_and_home(hands: Hands) -> None:
    hands.go(0.5, -0.4, 0.8, 0.0)
    do(hands.world, Act.BLOCK)
    hands.go(0.5, -0.4, 1.0, 0.0)
    assert hands.tool() == pytest.approx((0.5, -0.4, 1.0))
    hands.body.follow(hands.body.plan_neutral(), 0, 1.0)
    hands.settle()
    assert hands.tool()[1] < -0.8
    assert hands.body.contact_force_n() == 0.0


def test_an_arm_that_is_held_up_gives_the_motion_up(hands: Hands) -> None:
    hands.go(0.4, -0.4, 1.0, 0.0)
    do(hands.world, Act.BLOCK)
    hands.go(0.7, -0.1, 1.0, 0.0)
    x, y, _ = hands.tool()
    assert 0.4 < x < 0.6
    assert x - 0.4 == pytest.approx(y + 0.4)


def test_somebody_in_the_way_is_seen_by_the_head_camera(world: TabletopWorld) -> None:
    before = world.cameras[0].head.capture().depth_m
    do(world, Act.BLOCK)
    after = world.cameras[0].head.capture().depth_m
    assert before is not None
    assert after is not None
    assert ((before - after) > 0.05).sum() > 100


def test_nobody_else_can_block_an_arm_that_is_blocked(world: TabletopWorld) -> None:
    do(world, Act.BLOCK)
    assert do(world, Act.BLOCK) == "somebody stands in the way already"


def test_a_covered_camera_shows_nothing_until_its_view_is_clear(world: TabletopWorld) -> None:
    head = world.body.cameras["head"]
    assert do(world, Act.COVER) == ""
    assert do(world, Act.COVER) == "the head camera is covered already"
    dark = head.capture()
    assert dark.bgr.max() == 0
    assert dark.depth_m is not None
    assert not np.isfinite(dark.depth_m).any()
    assert do(world, Act.UNCOVER) == ""
    assert do(world, Act.UNCOVER) == "nothing covers the head camera"
    assert head.capture().bgr.max() > 0
