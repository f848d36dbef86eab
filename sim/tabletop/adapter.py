"""The tabletop as a kind of world that runs can name (entry point `mend.worlds`)."""

from collections.abc import Iterable, Sequence
from typing import Any

from pydantic import ValidationError

from robots.catalogue import Catalogue
from robots.feasibility.check import check_scene
from robots.robot import Robot
from robots.vision.color_model import ColorModel
from robots.vision.lookalikes import find_lookalikes
from sim.simulated_agent import SimulatedAgent
from sim.tabletop.body import StraightPlanner
from sim.tabletop.colors import learn_colors
from sim.tabletop.layout import lay_out
from sim.tabletop.scenery import head_viewpoint
from sim.tabletop.world import TabletopOptions, TabletopWorld, reach_for
from sim.world import WorldSetup
from tasks.definition import BehaviorNode, GoalNode
from tasks.plugins import load_plugins
from tasks.scene import Scene
from tasks.scene_problem import SceneProblem


class TabletopAdapter:
    """Makes tabletop worlds; they run anywhere and never block for long."""

    own_process = False
    lays_out_anything = True

    def check_available(self) -> None:
        """Always passes: nothing but Mend itself is needed."""

    def lay_out(self, names: Iterable[tuple[str, str | None]], seed: int) -> Scene:
        """Make up a scene for the (object, place) names of a tree.

        Raises `LayoutError` for more than there is room and colours for.
        """
        return lay_out(names, seed)

    def check_scene(
        self, scene: Scene, nodes: Sequence[GoalNode | BehaviorNode]
    ) -> list[SceneProblem]:
        """What keeps the robot from doing the leaves among `nodes` in a scene."""
        planner = StraightPlanner(reach_for(scene, None), scene.table)
        lookalikes = find_lookalikes(scene, nodes, learn_colors(scene, TabletopOptions()))
        return [*check_scene(scene, nodes, planner, head_viewpoint(scene.table)), *lookalikes]

    def train_colors(self, scene: Scene) -> ColorModel:
        """Learn the colours of a scene's objects from rendered pictures of them.

        Raises `ColorModelError` for an object without a colour of its own.
        """
        return learn_colors(scene, TabletopOptions())

    def check_options(self, options: dict[str, Any]) -> None:
        """Raises `ValueError` for options that it does not take."""
        _read_options(options)

    def create_agent(self, setup: WorldSetup) -> SimulatedAgent:
        """Build the world and the robot in it.

        Raises `ValueError` for options or a snapshot that do not fit.
        """
        options = _read_options(setup.options)
        world = TabletopWorld(setup.scene, setup.seed, options)
        robot = Robot(
            setup.robot,
            world.body,
            learn_colors(setup.scene, options),
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


def _read_options(options: dict[str, Any]) -> TabletopOptions:
    try:
        return TabletopOptions.model_validate(options)
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"])
        raise ValueError(f"world option '{where}' of the tabletop: {first['msg']}") from error


adapter = TabletopAdapter()
