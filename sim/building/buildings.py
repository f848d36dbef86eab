"""Making buildings: the world with its robots, and what they can do in a scene."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mend.documents.problem import list_names
from mend.errors import WrongInputError
from mend.localization.methods import warm_up
from mend.maps.building.building import Building
from mend.maps.building.clearance import distances_m, lane_clearance_m
from mend.robots.base.behaviors.behavior import BaseBehavior
from mend.robots.base.body import BasePose
from mend.robots.base.floor_ways import FloorWays
from mend.robots.base.subsystem import BaseSubsystem
from mend.robots.catalogue import Catalogue
from mend.robots.execution.behavior import of_kind
from mend.robots.execution.command_error import CommandError
from mend.robots.robot import Robot
from mend.sim.building.belief import FloorMap, floor_maps
from mend.sim.building.building_robot import LIMITS, RADIUS_M
from mend.sim.building.carrying import Carrying
from mend.sim.building.floor_pose import FloorPose
from mend.sim.building.furniture import Furniture, Room, kept_clear
from mend.sim.building.options import BuildingOptions, LocalizerKind
from mend.sim.building.setting import building_of, read_setting
from mend.sim.building.world import BuildingWorld
from mend.sim.shared_world import SharedWorld
from mend.sim.world import WorldSetup
from mend.sim.world_options import read_options
from mend.tasks.definition import BehaviorNode, GoalNode
from mend.tasks.frames import Frame, frames_of
from mend.tasks.plugins import load_plugins
from mend.tasks.scene import Base, Scene
from mend.tasks.scene_problem import SceneProblem

if TYPE_CHECKING:
    from mend.robots.vision.color_model import ColorModel

Point = tuple[float, float]

FURNITURE_SPARE_M = 0.2
"""Furniture leaves robots on their lanes so much on each side."""
SPARE_M = 0.05
"""A robot is so much farther from walls than its rim at least."""


class Buildings:
    """Makes buildings; what `BuildingAdapter` hands on."""

    def check_scene(
        self, scene: Scene, nodes: Sequence[GoalNode | BehaviorNode]
    ) -> list[SceneProblem]:
        """What keeps robots from doing the leaves among `nodes` in a scene."""
        problems, building = read_setting(scene)
        if building is None:
            return problems
        return [
            *_beside_floors(scene, building),
            *_beside_lanes(scene, building),
            *_not_for_bases(nodes),
            *_out_of_reach(scene, building, nodes),
        ]

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
            for frame, base in zip(frames.values(), _bases(setup.scene), strict=True)
        ]
        rng = np.random.default_rng(setup.seed)
        places = _places_by_floor(setup.scene, building)
        stand = [at for _, at in starts]
        world = BuildingWorld(
            building,
            starts,
            options.shut_doors,
            rng,
            Furniture(_rooms(building, places, stand), options.unmapped, rng),
            Carrying(options.carried_every_s, rng),
            _maps(building, places, options.localizer),
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
                        _ways(building, frame),
                        body.whereabouts,
                    )
                ],
            )
            for name, frame, body in zip(setup.robots, frames.values(), world.robots, strict=True)
        ]
        return SharedWorld(
            world,
            robots,
            speed=setup.speed,
            interventions=setup.interventions,
            snapshot=setup.snapshot,
        )


def _bases(scene: Scene) -> Sequence[Base]:
    """Where the robots stand; one that stands alone is in the scene's origin."""
    return list(scene.robots.values()) or [Base(x=0.0, y=0.0)]


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
    """Where furniture may be put: nowhere where robots begin, go, or pass."""
    rooms = {}
    for name, floor in building.floors.items():
        begin = [(at.x, at.y) for at in stand if at.floor == name]
        clear = kept_clear(floor, [*places[name].values(), *begin])
        rooms[name] = Room(floor, clear, RADIUS_M + FURNITURE_SPARE_M)
    return rooms


def _maps(
    building: Building, places: Mapping[str, Mapping[str, Point]], kind: LocalizerKind
) -> Mapping[str, FloorMap] | None:
    if kind is LocalizerKind.EXACT:
        return None
    warm_up(kind)
    return floor_maps(building, places)


def _beside_floors(scene: Scene, building: Building) -> list[SceneProblem]:
    """Robots and places that are on no floor."""
    heights = list_names([f"{each.height:g} m" for each in building.floors.values()])
    stand: list[tuple[tuple[str, ...], float]]
    stand = [(("robots", name, "z"), each.z) for name, each in scene.robots.items()]
    stand += [
        (("places", name, "pose", "z"), each.pose.z or 0.0) for name, each in scene.places.items()
    ]
    return [
        SceneProblem(where, f"no floor is {z:g} m high; the floors are at {heights}")
        for where, z in stand
        if building.floor_at(z) is None
    ]


def _beside_lanes(scene: Scene, building: Building) -> list[SceneProblem]:
    """Lanes and places where a robot does not fit between the walls."""
    needs_m = RADIUS_M + SPARE_M
    told = f"a robot here needs {needs_m:.2f} m on each side"
    problems = [
        SceneProblem(
            ("setting", "floors", name, "lanes", str(number)),
            f"the lane between '{lane.between[0]}' and '{lane.between[1]}' comes within "
            f"{away_m:.2f} m of a wall: {told}",
        )
        for name, floor in building.floors.items()
        for number, lane in enumerate(floor.lanes)
        if (away_m := lane_clearance_m(floor, lane)) < needs_m
    ]
    stand: list[tuple[tuple[str, ...], float, float, float]]
    stand = [(("robots", name), each.x, each.y, each.z) for name, each in scene.robots.items()]
    stand += [
        (("places", name, "pose"), each.pose.x, each.pose.y, each.pose.z or 0.0)
        for name, each in scene.places.items()
    ]
    for where, x, y, z in stand:
        floor_name = building.floor_at(z)
        if floor_name is None:
            continue
        walls = building.floors[floor_name].wall_segments
        away_m = float(distances_m(np.array([[x, y]]), walls)[0])
        if away_m < needs_m:
            problems.append(SceneProblem(where, f"a wall is {away_m:.2f} m from here: {told}"))
    return problems


def _not_for_bases(nodes: Sequence[GoalNode | BehaviorNode]) -> list[SceneProblem]:
    """Behaviors that no base can do, each once."""
    can = of_kind(load_plugins("mend.behaviors"), BaseBehavior)  # type: ignore[type-abstract]
    others = {
        node.behavior: node
        for node in nodes
        if isinstance(node, BehaviorNode) and node.behavior not in can
    }
    return [
        SceneProblem(
            () if node.place is None else ("places", node.place),
            f"no robot of a building can do '{name}'; what they can do is {list_names(can)}",
        )
        for name, node in others.items()
    ]


def _out_of_reach(
    scene: Scene, building: Building, nodes: Sequence[GoalNode | BehaviorNode]
) -> list[SceneProblem]:
    """Places of leaves to which no robot knows a way, and why the first does not."""
    starts = [BasePose(each.x, each.y, each.yaw, each.z) for each in _bases(scene)]
    ways, problems = _ways(building, Frame()), []
    named = [each.place for each in nodes if isinstance(each, BehaviorNode)]
    for name in dict.fromkeys(each for each in named if each in scene.places):
        assert name is not None, "it is one of the places"
        pose = scene.places[name].pose
        reasons = [
            _why_not(ways, each, BasePose(pose.x, pose.y, 0.0, pose.z or 0.0)) for each in starts
        ]
        if all(reasons):
            problems.append(
                SceneProblem(("places", name), f"no robot gets to '{name}': {reasons[0]}")
            )
    return problems


def _why_not(ways: FloorWays, here: BasePose, to: BasePose) -> str | None:
    try:
        ways.path(here, to)
    except CommandError as error:
        return str(error)
    return None


def _ways(building: Building, frame: Frame) -> FloorWays:
    return FloorWays(building, frame, LIMITS.speed_m_s, RADIUS_M + SPARE_M)


BUILDINGS = Buildings()
