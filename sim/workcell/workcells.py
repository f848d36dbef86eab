"""Making workcells: the world with its robots, and what they can do in a scene."""

from collections.abc import Sequence

from mend.robots.arm.body import Reach
from mend.robots.arm.feasibility.robots import ArmKind, check_for_each_robot
from mend.robots.vision.color_model import ColorModel
from mend.robots.vision.lookalikes import find_lookalikes
from mend.sim.arm_robots import arm_robots
from mend.sim.not_for_arms import not_for_arms
from mend.sim.shared_world import SharedWorld
from mend.sim.workcell.arm_planner import neutral_arm
from mend.sim.workcell.cameras import head_viewpoint
from mend.sim.workcell.colors import learn_colors
from mend.sim.workcell.options import WorkcellOptions
from mend.sim.workcell.reach import ARM_ROOM, pr2_reach
from mend.sim.workcell.world import WorkcellWorld
from mend.sim.world import WorldSetup
from mend.sim.world_options import read_options
from mend.tasks.definition import BehaviorNode, GoalNode
from mend.tasks.scene import Scene
from mend.tasks.scene_problem import SceneProblem


class Workcells:
    """Makes workcells; what `WorkcellAdapter` hands on."""

    def reach(self, scene: Scene) -> Reach:  # noqa: ARG002
        """How far each robot reaches."""
        return pr2_reach()

    def create_agents(self, setup: WorldSetup) -> SharedWorld:
        """Build the world and the robots in it.

        Raises `WorldUnavailableError`, `WrongInputError` for options and `ValueError` for a
        snapshot that do not fit.
        """
        options = read_options(WorkcellOptions, "workcell", setup.options)
        world = WorkcellWorld(setup.scene, setup.seed, options)
        colors = learn_colors(setup.scene, options.camera_noise)
        return SharedWorld.of(setup, world, arm_robots(setup, world.bodies, colors))

    def check_scene(
        self, scene: Scene, nodes: Sequence[GoalNode | BehaviorNode]
    ) -> list[SceneProblem]:
        """What keeps all robots from doing the leaves among `nodes` in a scene."""
        if beyond := not_for_arms(scene, nodes):
            return beyond
        lookalikes = find_lookalikes(scene, nodes, learn_colors(scene))
        kind = ArmKind(
            pr2_reach(), lambda _: neutral_arm(), lambda _: head_viewpoint(), lambda _: ARM_ROOM
        )
        return [*check_for_each_robot(scene, nodes, kind), *lookalikes]

    def train_colors(self, scene: Scene) -> ColorModel:
        """Learn the colours of a scene's objects from rendered pictures of them."""
        return learn_colors(scene, camera_noise=0.0)


WORKCELLS = Workcells()
