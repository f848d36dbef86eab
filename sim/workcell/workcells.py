"""Making workcells: the world with its robot, and what that can do in a scene."""

from collections.abc import Sequence

from mend.robots.arm.feasibility.check import check_scene
from mend.robots.arm.subsystem import ArmSubsystem
from mend.robots.catalogue import Catalogue
from mend.robots.robot import Robot
from mend.robots.vision.color_model import ColorModel
from mend.robots.vision.lookalikes import find_lookalikes
from mend.sim.not_for_arms import not_for_arms
from mend.sim.shared_world import SharedWorld
from mend.sim.workcell.arm_planner import neutral_arm
from mend.sim.workcell.cameras import head_viewpoint
from mend.sim.workcell.colors import learn_colors
from mend.sim.workcell.options import WorkcellOptions
from mend.sim.workcell.world import WorkcellWorld
from mend.sim.world import WorldSetup
from mend.sim.world_options import read_options
from mend.tasks.definition import BehaviorNode, GoalNode
from mend.tasks.frames import Frame, frames_of
from mend.tasks.plugins import load_plugins
from mend.tasks.scene import Scene
from mend.tasks.scene_problem import SceneProblem

ONE_ROBOT = (
    "the workcell has one robot, at (0, 0): leave out 'robots', or run the task in the tabletop"
)


class Workcells:
    """Makes workcells; what `WorkcellAdapter` hands on."""

    def create_agents(self, setup: WorldSetup) -> SharedWorld:
        """Build the world and the robot in it.

        Raises `WorldUnavailableError`, `WrongInputError` for options and `ValueError` for a
        snapshot that do not fit.
        """
        options = read_options(WorkcellOptions, "workcell", setup.options)
        world = WorkcellWorld(setup.scene, setup.seed, options)
        (name,) = setup.robots
        robot = Robot(
            name,
            world.body,
            [
                ArmSubsystem(
                    world.body,
                    learn_colors(setup.scene, options.camera_noise),
                    Catalogue.from_scene(setup.scene),
                    load_plugins("mend.behaviors"),
                    load_plugins("mend.monitors"),
                    # As fast as possible, nobody watches: a picture for no monitor costs only time.
                    films=setup.speed is not None,
                )
            ],
        )
        return SharedWorld(
            world,
            [robot],
            speed=setup.speed,
            interventions=setup.interventions,
            snapshot=setup.snapshot,
        )

    def check_scene(
        self, scene: Scene, nodes: Sequence[GoalNode | BehaviorNode]
    ) -> list[SceneProblem]:
        """What keeps the robot from doing the leaves among `nodes` in a scene."""
        if list(frames_of(scene).values()) != [Frame()]:
            return [SceneProblem(("robots",), ONE_ROBOT)]
        if beyond := not_for_arms(scene, nodes):
            return beyond
        lookalikes = find_lookalikes(scene, nodes, learn_colors(scene))
        return [*check_scene(scene, nodes, neutral_arm(), head_viewpoint()), *lookalikes]

    def train_colors(self, scene: Scene) -> ColorModel:
        """Learn the colours of a scene's objects from rendered pictures of them."""
        return learn_colors(scene, camera_noise=0.0)


WORKCELLS = Workcells()
