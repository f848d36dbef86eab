"""Making buildings: the world with its robots, and what they can do in a scene."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mend.errors import WrongInputError
from mend.maps.building.building import Building
from mend.robots.base.subsystem import BaseSubsystem
from mend.robots.catalogue import Catalogue
from mend.robots.robot import Robot
from mend.sim.building.building_robot import FloorPose
from mend.sim.building.options import BuildingOptions
from mend.sim.building.scene_checks import bases_of, check_scene, ways_of
from mend.sim.building.setting import building_of
from mend.sim.building.world import BuildingWorld
from mend.sim.shared_world import SharedWorld
from mend.sim.world import WorldSetup
from mend.sim.world_options import read_options
from mend.tasks.definition import BehaviorNode, GoalNode
from mend.tasks.frames import frames_of
from mend.tasks.plugins import load_plugins
from mend.tasks.scene import Base, Scene
from mend.tasks.scene_problem import SceneProblem

if TYPE_CHECKING:
    from mend.robots.vision.color_model import ColorModel


class Buildings:
    """Makes buildings; what `BuildingAdapter` hands on."""

    def check_scene(
        self, scene: Scene, nodes: Sequence[GoalNode | BehaviorNode]
    ) -> list[SceneProblem]:
        """What keeps robots from doing the leaves among `nodes` in a scene."""
        return check_scene(scene, nodes)

    def train_colors(self, scene: Scene) -> "ColorModel":
        """Nothing here has a colour. Raises `WrongInputError`."""
        raise WrongInputError(f"'{scene.name}' is a building: nothing in it is known by its colour")

    def create_agents(self, setup: WorldSetup) -> SharedWorld:
        """Build the building and the robots in it.

        Raises `WrongInputError` for options and `ValueError` for a snapshot that do not fit.
        """
        options = read_options(BuildingOptions, "building", setup.options)
        building, frames = building_of(setup.scene), frames_of(setup.scene)
        starts = [
            (frame, _start(building, base))
            for frame, base in zip(frames.values(), bases_of(setup.scene), strict=True)
        ]
        rng = np.random.default_rng(setup.seed)
        world = BuildingWorld(building, starts, options, rng)
        robots = [
            Robot(
                name,
                body,
                [
                    BaseSubsystem(
                        body,
                        Catalogue.from_scene(frame.scene_to_robot(setup.scene)),
                        load_plugins("mend.behaviors"),
                        load_plugins("mend.monitors"),
                        ways_of(building, frame, number),
                        world.elevators.of_robot(number),
                    )
                ],
            )
            for number, (name, frame, body) in enumerate(
                zip(setup.robots, frames.values(), world.robots, strict=True)
            )
        ]
        return SharedWorld(
            world,
            robots,
            speed=setup.speed,
            interventions=setup.interventions,
            snapshot=setup.snapshot,
        )


def _start(building: Building, base: Base) -> FloorPose:
    floor = building.floor_at(base.z)
    if floor is None:
        raise WrongInputError(f"no floor of '{building.name}' is {base.z:g} m high")
    return FloorPose(floor, base.x, base.y, base.yaw)


BUILDINGS = Buildings()
