"""Making tabletops: the world with its robots, and what they can do in a scene."""

from collections.abc import Sequence

from mend.robots.arm.body import Reach
from mend.robots.arm.feasibility.robots import ArmKind, check_for_each_robot
from mend.robots.vision.color_model import ColorModel
from mend.robots.vision.lookalikes import find_lookalikes
from mend.sim.arm_robots import arm_robots
from mend.sim.not_for_arms import not_for_arms
from mend.sim.shared_world import SharedWorld
from mend.sim.tabletop.body import StraightPlanner
from mend.sim.tabletop.colors import learn_colors
from mend.sim.tabletop.manipulator import Home
from mend.sim.tabletop.options import TabletopOptions
from mend.sim.tabletop.scenery import head_viewpoint
from mend.sim.tabletop.world import TabletopWorld, reach_for
from mend.sim.world import WorldSetup
from mend.sim.world_options import read_options
from mend.tasks.definition import BehaviorNode, GoalNode
from mend.tasks.scene import Scene
from mend.tasks.scene_problem import SceneProblem


class Tabletops:
    """Makes tabletop worlds; what `TabletopAdapter` hands on."""

    def reach(self, scene: Scene) -> Reach:
        """How far each robot reaches."""
        return reach_for(scene, None)

    def check_scene(
        self, scene: Scene, nodes: Sequence[GoalNode | BehaviorNode]
    ) -> list[SceneProblem]:
        """What keeps all robots from doing the leaves among `nodes` in a scene."""
        if beyond := not_for_arms(scene, nodes):
            return beyond
        reach = self.reach(scene)
        lookalikes = find_lookalikes(scene, nodes, learn_colors(scene, TabletopOptions()))
        kind = ArmKind(
            reach,
            lambda table: StraightPlanner(reach, table),
            head_viewpoint,
            lambda table: Home.beside(table).room,
        )
        return [*check_for_each_robot(scene, nodes, kind), *lookalikes]

    def train_colors(self, scene: Scene) -> ColorModel:
        """Learn the colours of a scene's objects from rendered pictures of them.

        Raises `WrongInputError` for an object without a colour of its own.
        """
        return learn_colors(scene, TabletopOptions())

    def create_agents(self, setup: WorldSetup) -> SharedWorld:
        """Build the world and the robots in it.

        Raises `WrongInputError` for options and `ValueError` for a snapshot that do not fit.
        """
        options = read_options(TabletopOptions, "tabletop", setup.options)
        world = TabletopWorld(setup.scene, setup.seed, options)
        colors = learn_colors(setup.scene, options)
        return SharedWorld.of(setup, world, arm_robots(setup, world.bodies, colors))


TABLETOPS = Tabletops()
