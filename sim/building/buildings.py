"""Making buildings: the world with its robots, and what they can do in a scene."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mend.errors import WrongInputError
from mend.localization.methods import warm_up
from mend.maps.building.building import Building, Floor
from mend.maps.building.cabin import cabin_walls, stop_of, waiting_points
from mend.robots.base.subsystem import BaseSubsystem
from mend.robots.catalogue import Catalogue
from mend.robots.robot import Robot
from mend.sim.building.belief import FloorMap, floor_maps
from mend.sim.building.building_robot import RADIUS_M
from mend.sim.building.carrying import Carrying
from mend.sim.building.floor_pose import FloorPose
from mend.sim.building.furniture import Furniture, Room, kept_clear
from mend.sim.building.goods import Goods
from mend.sim.building.options import BuildingOptions, LocalizerKind
from mend.sim.building.scene import NEEDS_M
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

Point = tuple[float, float]

FURNITURE_SPARE_M = 0.2
"""Furniture leaves robots on their lanes so much on each side."""


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
        places = _places_by_floor(setup.scene, building)
        stand = [at for _, at in starts]
        world = BuildingWorld(
            building,
            starts,
            options,
            rng,
            Furniture(_rooms(building, places, stand), options.unmapped, rng),
            Carrying(options.carried_every_s, rng),
            Goods(setup.seed, options.forgetful, rng),
            {
                name: FloorPose(floor, x, y)
                for floor, each in places.items()
                for name, (x, y) in each.items()
            },
            _maps(building, places, options.localizer),
            setup.robots,
        )
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
                        body.whereabouts,
                        world.baskets[number],
                        world.batteries[number],
                        world.companions[number],
                    )
                ],
            )
            for number, (name, frame, body) in enumerate(
                zip(setup.robots, frames.values(), world.robots, strict=True)
            )
        ]
        return SharedWorld.of(setup, world, robots)


def _start(building: Building, base: Base) -> FloorPose:
    floor = building.floor_at(base.z)
    if floor is None:
        raise WrongInputError(f"no floor of '{building.name}' is {base.z:g} m high")
    return FloorPose(floor, base.x, base.y, base.yaw)


def _places_by_floor(scene: Scene, building: Building) -> dict[str, dict[str, Point]]:
    """Where a scene's places are, by floor and name."""
    found: dict[str, dict[str, Point]] = {name: {} for name in building.floors}
    for name, place in scene.places.items():
        floor = building.floor_at(place.pose.z or 0.0)
        if floor is not None:
            found[floor][name] = (place.pose.x, place.pose.y)
    return found


def _rooms(
    building: Building, places: Mapping[str, Mapping[str, Point]], stand: Sequence[FloorPose]
) -> dict[str, Room]:
    """Where furniture may be put: nowhere where robots begin, go, wait or pass."""
    rooms = {}
    for name, floor in building.floors.items():
        begin = [(at.x, at.y) for at in stand if at.floor == name]
        around = [point for stop in _stops(building, name) for point in _round_cabin(floor, stop)]
        clear = kept_clear(floor, [*places[name].values(), *begin, *around])
        rooms[name] = Room(floor, clear, RADIUS_M + FURNITURE_SPARE_M)
    return rooms


def _stops(building: Building, floor: str) -> list[Point]:
    """Where cabins stop on a floor."""
    elevators = building.document.elevators
    return [stop_of(building, n, floor) for n, each in elevators.items() if floor in each.stops]


def _round_cabin(floor: Floor, stop: Point) -> list[Point]:
    """The corners of a cabin, and where robots wait for it."""
    corners = [(x, y) for x, y, *_ in cabin_walls(stop).tolist()]
    return [*corners, *waiting_points(floor, stop, NEEDS_M)]


def _maps(
    building: Building, places: Mapping[str, Mapping[str, Point]], kind: LocalizerKind
) -> Mapping[str, FloorMap] | None:
    if kind is LocalizerKind.EXACT:
        return None
    warm_up(kind)
    return floor_maps(building, places)


BUILDINGS = Buildings()
