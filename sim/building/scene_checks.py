"""What keeps robots from doing a task in a scene of a building."""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from mend.documents.problem import list_names
from mend.maps.building.building import Building, Floor
from mend.maps.building.cabin import CABIN_M, stop_of
from mend.maps.building.clearance import clearance_m, distances_m, lane_clearance_m
from mend.robots.base.behaviors.behavior import BaseBehavior
from mend.robots.base.behaviors.charge import Charge
from mend.robots.base.body import BasePose
from mend.robots.base.floor_ways import FloorWays
from mend.robots.execution.behavior import of_kind
from mend.robots.execution.command_error import CommandError
from mend.sim.building.building_robot import LIMITS
from mend.sim.building.chargers import is_at_charger
from mend.sim.building.item_checks import check_items
from mend.sim.building.scene import NEEDS_M
from mend.sim.building.setting import read_setting
from mend.tasks.definition import BehaviorNode, GoalNode
from mend.tasks.frames import Frame
from mend.tasks.plugins import load_plugins
from mend.tasks.scene import Base, Scene
from mend.tasks.scene_problem import SceneProblem

Where = tuple[str, ...]
_TOLD = f"a robot here needs {NEEDS_M:.2f} m on each side"


def check_scene(scene: Scene, nodes: Sequence[GoalNode | BehaviorNode]) -> list[SceneProblem]:
    """What keeps robots from doing the leaves among `nodes` in a scene."""
    problems, building = read_setting(scene)
    if building is None:
        return problems
    return [
        *_beside_floors(scene, building),
        *_beside_lanes(building),
        *_in_cabins(building),
        *_without_room(scene, building),
        *_not_for_bases(nodes),
        *_out_of_reach(scene, building, nodes),
        *_no_chargers(scene, building, nodes),
        *check_items(nodes, len(bases_of(scene))),
    ]


def ways_of(building: Building, frame: Frame, turn: int = 0) -> FloorWays:
    """The ways that a robot knows; `turn`: which of those who wait for an elevator it is."""
    return FloorWays(building, frame, LIMITS.speed_m_s, NEEDS_M, turn)


def bases_of(scene: Scene) -> Sequence[Base]:
    """Where the robots stand; one that stands alone is in the scene's origin."""
    return list(scene.robots.values()) or [Base(x=0.0, y=0.0)]


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


def _beside_lanes(building: Building) -> Iterator[SceneProblem]:
    """Lanes where a robot does not fit between the walls."""
    for name, floor in building.floors.items():
        for number, lane in enumerate(floor.lanes):
            if (away_m := lane_clearance_m(floor, lane)) < NEEDS_M:
                a, b = lane.between
                yield SceneProblem(
                    _lane_at(name, number),
                    f"the lane between '{a}' and '{b}' comes within {away_m:.2f} m of a wall: "
                    f"{_TOLD}",
                )


def _in_cabins(building: Building) -> Iterator[SceneProblem]:
    """Lanes that lead through the cabin of an elevator, and stop elsewhere."""
    for elevator, each in building.document.elevators.items():
        for name, place in each.stops.items():
            floor, stop = building.floors[name], stop_of(building, elevator, name)
            for number, lane in enumerate(floor.lanes):
                if place not in lane.between and _passes(floor, lane.between, stop):
                    a, b = lane.between
                    yield SceneProblem(
                        _lane_at(name, number),
                        f"the lane between '{a}' and '{b}' comes within "
                        f"{CABIN_M + NEEDS_M:.2f} m of '{place}', where the cabin of "
                        f"'{elevator}' stops",
                    )


def _passes(floor: Floor, between: tuple[str, str], stop: tuple[float, float]) -> bool:
    a, b = ((floor.places[each].x, floor.places[each].y) for each in between)
    return clearance_m(a, b, np.array([[*stop, *stop]])) < CABIN_M + NEEDS_M


def _without_room(scene: Scene, building: Building) -> Iterator[SceneProblem]:
    """Robots and places that are too near to a wall, or in a cabin."""
    for where, x, y, z in _poses(scene):
        name = building.floor_at(z)
        if name is None:
            continue
        away_m = float(distances_m(np.array([[x, y]]), building.floors[name].wall_segments)[0])
        if away_m < NEEDS_M:
            yield SceneProblem(where, f"a wall is {away_m:.2f} m from here: {_TOLD}")
        for elevator, each in building.document.elevators.items():
            if name not in each.stops:
                continue
            stop_x, stop_y = stop_of(building, elevator, name)
            if math.hypot(stop_x - x, stop_y - y) < CABIN_M + NEEDS_M:
                yield SceneProblem(where, f"this is in the cabin of the elevator '{elevator}'")


def _poses(scene: Scene) -> Iterator[tuple[Where, float, float, float]]:
    """Where robots begin, and places are."""
    for name, base in scene.robots.items():
        yield ("robots", name), base.x, base.y, base.z
    for name, place in scene.places.items():
        yield ("places", name, "pose"), place.pose.x, place.pose.y, place.pose.z or 0.0


def _lane_at(floor: str, number: int) -> Where:
    return ("setting", "floors", floor, "lanes", str(number))


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
    starts = [BasePose(each.x, each.y, each.yaw, each.z) for each in bases_of(scene)]
    ways, problems = ways_of(building, Frame()), []
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


def _no_chargers(
    scene: Scene, building: Building, nodes: Sequence[GoalNode | BehaviorNode]
) -> Iterator[SceneProblem]:
    """Places where robots are to be charged, and are not."""
    charged = [n.place for n in nodes if isinstance(n, BehaviorNode) and n.behavior == Charge.name]
    for name in dict.fromkeys(each for each in charged if each in scene.places):
        assert name is not None, "it is one of the places"
        pose = scene.places[name].pose
        floor = building.floor_at(pose.z or 0.0)
        if floor is not None and not is_at_charger(building, floor, pose.x, pose.y):
            yield SceneProblem(
                ("places", name), f"no charger is at '{name}', where a robot is to charge"
            )


def _why_not(ways: FloorWays, here: BasePose, to: BasePose) -> str | None:
    try:
        for ride in ways.rides(here, to):
            if ride.wait_at is not None:
                ways.path(here, ride.wait_at)
            here = ride.there
        ways.path(here, to)
    except CommandError as error:
        return str(error)
    return None
