"""The workcell as a kind of world that runs can name (entry point `mend.worlds`)."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from robots.catalogue import Catalogue
from robots.feasibility.check import check_scene
from robots.robot import Robot
from robots.vision.color_model import ColorModel
from robots.vision.lookalikes import find_lookalikes
from sim.simulated_agent import SimulatedAgent
from sim.workcell.arm_planner import neutral_arm
from sim.workcell.options import read_options
from sim.workcell.robot_model import MODEL, check_installed, robot_urdf
from sim.world import WorldSetup
from tasks.definition import BehaviorNode, GoalNode
from tasks.plugins import load_plugins
from tasks.scene import Scene
from tasks.scene_problem import SceneProblem


class WorkcellAdapter:
    """Makes workcells; PyBullet blocks its whole process and may crash it."""

    own_process = True
    lays_out_anything = False

    model = MODEL

    def model_folder(self) -> Path:
        """The trimmed PR2's files; made on the first call on a machine."""
        return robot_urdf().parent

    def check_available(self) -> None:
        """Raise `WorldUnavailableError` where PyBullet or the robot's description is missing."""
        check_installed()

    def check_options(self, options: dict[str, Any]) -> None:
        """Raises `ValueError` for options that it does not take."""
        read_options(options)

    def create_agent(self, setup: WorldSetup) -> SimulatedAgent:
        """Build the world and the robot in it.

        Raises `WorldUnavailableError`, and `ValueError` for options or a snapshot that do not fit.
        """
        check_installed()
        # Only here, so that the world can be listed where the physics engine is not installed.
        from sim.workcell.colors import learn_colors
        from sim.workcell.world import WorkcellWorld

        options = read_options(setup.options)
        world = WorkcellWorld(setup.scene, setup.seed, options)
        robot = Robot(
            setup.robot,
            world.body,
            learn_colors(setup.scene, options.camera_noise),
            Catalogue.from_scene(setup.scene),
            load_plugins("mend.behaviors"),
            load_plugins("mend.monitors"),
            # As fast as possible, nobody watches: a picture that no monitor needs costs only time.
            films=setup.speed is not None,
        )
        return SimulatedAgent(
            robot,
            world,
            speed=setup.speed,
            interventions=setup.interventions,
            snapshot=setup.snapshot,
        )

    def check_scene(
        self, scene: Scene, nodes: Sequence[GoalNode | BehaviorNode]
    ) -> list[SceneProblem]:
        """What keeps the robot from doing the leaves among `nodes` in a scene."""
        check_installed()
        from sim.workcell.cameras import head_viewpoint
        from sim.workcell.colors import learn_colors

        lookalikes = find_lookalikes(scene, nodes, learn_colors(scene))
        return [*check_scene(scene, nodes, neutral_arm(), head_viewpoint()), *lookalikes]

    def train_colors(self, scene: Scene) -> ColorModel:
        """Learn the colours of a scene's objects from rendered pictures of them."""
        check_installed()
        from sim.workcell.colors import learn_colors

        return learn_colors(scene, camera_noise=0.0)


adapter = WorkcellAdapter()
