"""The courtyard as a kind of world that runs can name."""

from collections.abc import Iterable, Sequence

from courtyard.floor import HALF_M
from courtyard.world import Courtyard
from mend.documents.strict_model import StrictModel
from mend.robots.base.subsystem import BaseSubsystem
from mend.robots.catalogue import Catalogue
from mend.robots.robot import Robot
from mend.sim.shared_world import SharedWorld
from mend.sim.world import WorldSetup
from mend.tasks.definition import BehaviorNode, GoalNode
from mend.tasks.frames import frames_of
from mend.tasks.plugins import load_plugins
from mend.tasks.scene import Scene
from mend.tasks.scene_problem import SceneProblem


class NoOptions(StrictModel):
    """A run can choose nothing about it."""


class CourtyardAdapter:
    """Makes courtyards: one cart for each robot of the scene."""

    own_process = False
    lays_out_anything = False
    options = NoOptions

    def check_available(self) -> None:
        """Always passes."""

    def lay_out(self, names: Iterable[tuple[str, str | None]], seed: int) -> Scene:  # noqa: ARG002
        """Nothing can be made up. Raises `ValueError`."""
        raise ValueError("a courtyard needs a scene that says where its places are")

    def check_scene(
        self,
        scene: Scene,
        nodes: Sequence[GoalNode | BehaviorNode],  # noqa: ARG002
    ) -> list[SceneProblem]:
        """What lies beyond the walls."""
        return [
            SceneProblem(("places", name), f"the place is beyond the walls, {HALF_M:g} m away")
            for name, each in scene.places.items()
            if max(abs(each.pose.x), abs(each.pose.y)) > HALF_M - 0.5
        ]

    def create_agents(self, setup: WorldSetup) -> SharedWorld:
        """Build the courtyard and the carts in it."""
        frames = frames_of(setup.scene).values()
        world = Courtyard(frames)
        behaviors, monitors = load_plugins("mend.behaviors"), load_plugins("mend.monitors")
        robots = []
        for name, frame, cart in zip(setup.robots, frames, world.carts, strict=True):
            catalogue = Catalogue.from_scene(frame.scene_to_robot(setup.scene))
            base = BaseSubsystem(cart, catalogue, behaviors, monitors)
            robots.append(Robot(name, cart, [base]))
        return SharedWorld(
            world,
            robots,
            speed=setup.speed,
            interventions=setup.interventions,
            snapshot=setup.snapshot,
        )


adapter = CourtyardAdapter()
