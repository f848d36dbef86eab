"""Two PR2s in one workcell: each in its own base frame, and people who help either."""

import json
from collections.abc import Iterator

import numpy as np
import pytest
from workcell_hands import Hands, distance_m, do

from mend.robots.vision.projection import unproject
from mend.sim.workcell.options import WorkcellOptions
from mend.sim.workcell.robot_model import NEUTRAL_RAD
from mend.sim.workcell.world import WorkcellWorld
from mend.tasks.frames import frames_of
from mend.tasks.intervention import Act
from mend.tasks.scene import Base, Pose, Scatter, Scene, SceneObject, Table

pytestmark = pytest.mark.slow

EXACT = WorkcellOptions(depth_noise=0.0)


def bar(color: tuple[float, float, float], pose: Pose) -> SceneObject:
    return SceneObject(color=color, size=(0.03, 0.08, 0.04), pose=pose)


SCENE = Scene(
    name="two",
    table=Table(height=0.70, center=(0.52, 0.0), size=(0.44, 1.40)),
    scatter=Scatter(xy=0.0, yaw=0.0),
    objects={
        "here": bar((0.9, 0.1, 0.1), Pose(x=0.44, y=-0.40)),
        "there": bar((0.1, 0.2, 0.9), Pose(x=0.60, y=0.40)),
        "between": bar((0.1, 0.7, 0.1), Pose(x=0.52, y=0.0)),
    },
    places={},
    robots={"left": Base(x=0.0, y=0.0), "right": Base(x=1.04, y=0.0, yaw=np.pi)},
)
FRAMES = list(frames_of(SCENE).values())


@pytest.fixture
def world() -> Iterator[WorkcellWorld]:
    world = WorkcellWorld(SCENE, 7, EXACT)
    yield world
    world.close()


@pytest.fixture
def both(world: WorkcellWorld) -> list[Hands]:
    return [Hands(world, number, frame) for number, frame in enumerate(FRAMES)]


def test_each_takes_what_is_at_its_own_hand(world: WorkcellWorld, both: list[Hands]) -> None:
    one, two = both
    one.pick("here")
    two.pick("there")
    assert [part.name for each in world.bodies if (part := world.held_by(each))] == [
        "here",
        "there",
    ]
    shown = dict(zip(world.parts, world.shown_poses(), strict=False))
    assert {name: each.held for name, each in shown.items()} == {
        "here": True,
        "there": True,
        "between": False,
    }


def test_time_passes_once_for_both(world: WorkcellWorld, both: list[Hands]) -> None:
    for each in both:
        each.body.advance_cycle()
    assert world.time_s() == both[0].body.time_s() == 2 * world.body.control_period_s


def test_each_head_measures_a_part_in_its_own_frame(world: WorkcellWorld) -> None:
    for frame, cameras in zip(FRAMES, world.cameras, strict=True):
        image, rendering = cameras.head.capture_with_bodies()
        assert image.depth_m is not None
        rows, columns = np.nonzero(rendering.bodies == world.parts["between"].body_id)
        points = unproject(image, columns, rows)
        top = points[points[:, 2] > 0.735]
        expected = frame.to_robot(0.52, 0.0)
        assert np.allclose(top[:, :2].mean(axis=0), expected, atol=0.004)


def test_where_the_other_robot_is_no_depth_is_measured(
    world: WorkcellWorld, both: list[Hands]
) -> None:
    _, two = both
    two.pick("between")
    image, rendering = world.cameras[0].head.capture_with_bodies()
    assert image.depth_m is not None
    for other in (two.body.pr2.body_id, world.parts["between"].body_id):
        shown = rendering.bodies == other
        assert shown.sum() > 20
        assert np.isnan(image.depth_m[shown]).all()
    assert np.isfinite(image.depth_m[rendering.bodies == world.parts["here"].body_id]).all()


def test_a_part_is_held_out_to_the_one_that_stretches_its_arm_out(
    world: WorkcellWorld, both: list[Hands]
) -> None:
    _, two = both
    assert do(world, Act.HAND_OVER, "here") == ""
    two.wait(0.2)
    assert world.parts["here"].hidden
    two.go_hand_over()
    two.wait(0.1)
    two.body.close_gripper()
    two.settle()
    two.wait(0.2)
    held = world.held_by(two.body)
    assert held is not None
    assert held.name == "here"


def test_nobody_is_in_the_way_of_either_arm_but_of_the_one_that_works(
    world: WorkcellWorld, both: list[Hands]
) -> None:
    _, two = both
    two.pick("there")
    path = two.plan(two._tool_pose("there", world.parts["there"].start, 0.15))
    two.body.follow(path, 0, 0.5)
    two.wait(0.1)
    assert do(world, Act.BLOCK) == ""
    x, y, _ = world.shown_poses()[-1].pose[:3]
    tool = two.body.pr2.tool_in_scene()[:3, 3]
    assert np.hypot(x - tool[0], y - tool[1]) < 0.6
    assert do(world, Act.RELEASE) == ""


def test_what_both_held_lies_where_it_last_rested(world: WorkcellWorld, both: list[Hands]) -> None:
    starts = {name: part.pose() for name, part in world.parts.items()}
    both[0].pick("here")
    both[1].pick("there")
    saved = json.loads(json.dumps(world.snapshot()))
    assert (saved["held"], saved["also_held"]) == ("here", ["there"])
    other = WorkcellWorld(SCENE, 99, EXACT)
    other.restore(saved)
    assert other.held is None
    for name, start in starts.items():
        assert distance_m(other.parts[name].pose(), start) < 0.001
    for body in other.bodies:
        assert np.allclose(body.pr2.arm_joints(), NEUTRAL_RAD, atol=2e-3)
    assert other.snapshot()["other_generators"] == saved["other_generators"]
    other.close()


def test_a_snapshot_of_one_robot_is_for_one_robot(world: WorkcellWorld) -> None:
    alone = WorkcellWorld(SCENE.model_copy(update={"robots": {}}), 7, EXACT)
    saved = alone.snapshot()
    # As it was written before there could be several.
    del saved["also_held"], saved["other_generators"]
    alone.restore(saved)
    with pytest.raises(ValueError, match="the snapshot has 1 robots, the scene 2"):
        world.restore(saved)
    alone.close()
