"""Parts start where the scene says, scattered by the seed, and lie still."""

from workcell_hands import TABLE_M

from mend.sim.workcell.world import WorkcellWorld
from mend.tasks.scene import Pose, Scatter, Scene


def test_parts_start_on_the_table_within_the_scatter(world: WorkcellWorld, scene: Scene) -> None:
    for name, part in world.parts.items():
        x, y, z = part.pose().position
        pose = scene.objects[name].pose
        assert abs(x - pose.x) <= scene.scatter.xy + 0.001
        assert abs(y - pose.y) <= scene.scatter.xy + 0.001
        assert abs(z - TABLE_M) < 0.001
        assert part.at_rest()


def test_another_seed_lays_parts_out_differently(world: WorkcellWorld, scene: Scene) -> None:
    other = WorkcellWorld(scene, seed=8)
    assert all(
        world.parts[name].pose().position != other.parts[name].pose().position
        for name in scene.objects
    )
    other.close()


def test_scattered_parts_never_overlap(scene: Scene) -> None:
    wild = scene.model_copy(update={"scatter": Scatter(xy=0.12, yaw=1.5)})
    world = WorkcellWorld(wild, seed=1)
    for part in world.parts.values():
        assert abs(part.pose().position[2] - TABLE_M) < 0.001
        assert part.pose().tilt_rad < 0.01
    world.close()


def test_a_part_may_start_above_the_table(scene: Scene) -> None:
    definition = scene.objects["bar"].model_copy(
        update={"pose": Pose(x=0.45, y=-0.55, z=TABLE_M + 0.08)}
    )
    stacked = scene.model_copy(
        update={"objects": {**scene.objects, "bar": definition}, "scatter": Scatter()}
    )
    world = WorkcellWorld(stacked, seed=0)
    assert abs(world.parts["bar"].pose().position[2] - TABLE_M - 0.08) < 0.001
    world.close()


def test_time_begins_when_everything_lies_still(world: WorkcellWorld) -> None:
    assert world.body.time_s() == 0.0
    assert not world.body.moving
