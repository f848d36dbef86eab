"""The check of a scene with several robots: what one of them can do is no problem."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from math import dist

from mend.robots.arm.behaviors.planning import Planner
from mend.robots.arm.body import ArmRoom, Reach
from mend.robots.arm.feasibility.check import CheckedRobot, check_for_robots
from mend.robots.arm.shared_space import Flat, home, leaf_space
from mend.robots.vision.viewpoint import Viewpoint
from mend.tasks.definition import BehaviorNode, GoalNode
from mend.tasks.frames import Frame, frames_of
from mend.tasks.leaf_order import LeafOrder
from mend.tasks.scene import Scene, SceneObject, Table
from mend.tasks.scene_problem import SceneProblem

_ROOM_AT_HOME_M = 0.10
"""So far apart are the spaces of arms that rest out of each other's way."""


@dataclass(frozen=True, slots=True)
class ArmKind:
    """What all robots of a world are, in their base frames; `Table` as one of them has it."""

    reach: Reach
    planner: Callable[[Table], Planner]
    head: Callable[[Table], Viewpoint]
    room: Callable[[Table], ArmRoom]


def check_for_each_robot(
    scene: Scene, nodes: Sequence[GoalNode | BehaviorNode], kind: ArmKind
) -> list[SceneProblem]:
    """What keeps all robots of a scene from doing the leaves among `nodes`.

    Of a leaf that nobody can do, it is told what keeps the robot from it that is nearest.
    """
    members = [_Member(name, each, kind, scene) for name, each in frames_of(scene).items()]
    robots = [each.checked() for each in members]
    if len(members) == 1:
        return check_for_robots(scene, nodes, robots, lambda _object, _place: (0,))
    ways = _Ways(scene, nodes)

    def asked(name: str, place: str | None) -> Sequence[int]:
        return _asked(members, ways, name, place)

    return (
        _resting_together(members)
        or _never_begun(members, ways)
        or check_for_robots(scene, nodes, robots, asked)
    )


class _Member:
    """One of several robots, where it stands in the scene."""

    def __init__(self, name: str, frame: Frame, kind: ArmKind, scene: Scene) -> None:
        self.name = name
        self._frame = frame
        self._kind = kind
        self._own = frame.scene_to_robot(scene)
        self._room = kind.room(self._own.table)
        self.home = home(frame, self._room)

    def checked(self) -> CheckedRobot:
        table = self._own.table
        return CheckedRobot(self._own, self._kind.planner(table), self._kind.head(table))

    def away_m(self, x: float, y: float) -> float:
        """How far a point of the scene is from the middle of its ring."""
        return dist(self._frame.to_robot(x, y), self._kind.reach.origin)

    def reaches(self, ends: Sequence[Flat]) -> bool:
        reach = self._kind.reach
        return all(reach.min_m <= self.away_m(*each) <= reach.max_m for each in ends)

    def keeps_out_of(self, others: Sequence["_Member"], way: "_Way") -> bool:
        """Whether it can do a leaf without going where others rest."""
        space = leaf_space(self._frame, self._room, way.ends, way.part)
        return not any(space.intersects(each.home) for each in others if each is not self)


@dataclass(frozen=True, slots=True)
class _Way:
    """What a leaf takes, and from where to where; `again` where a leaf before has moved it."""

    leaf: BehaviorNode
    part: SceneObject
    ends: Sequence[Flat]
    again: bool


class _Ways:
    """The ways of all leaves that take something."""

    def __init__(self, scene: Scene, nodes: Sequence[GoalNode | BehaviorNode]) -> None:
        self.scene = scene
        self.all = list(_ways(scene, nodes))
        first = reversed(self.all)
        self._of = {(each.leaf.object, each.leaf.place): each for each in first}

    def of(self, name: str, place: str | None) -> _Way | None:
        return self._of.get((name, place))


def _ways(scene: Scene, nodes: Sequence[GoalNode | BehaviorNode]) -> Iterator[_Way]:
    order = LeafOrder(nodes)
    before: dict[str, list[tuple[int, Flat]]] = {}
    for index, leaf in order.leaves:
        if leaf.object is None or leaf.object not in scene.objects:
            continue
        ends = _in_scene(scene, leaf.object, leaf.place)
        moved = before.setdefault(leaf.object, [])
        to = [end for each, end in moved if not order.exclusive(each, index)]
        yield _Way(leaf, scene.objects[leaf.object], [*to[-1:], *ends[len(to[-1:]) :]], bool(to))
        moved.append((index, ends[-1]))


def _in_scene(scene: Scene, name: str, place: str | None) -> list[Flat]:
    """Where an object starts, and its place if it has one."""
    poses = [scene.objects[name].pose]
    if place is not None and place in scene.places:
        poses.append(scene.places[place].pose)
    return [(each.x, each.y) for each in poses]


def _resting_together(members: Sequence[_Member]) -> list[SceneProblem]:
    """Robots that stand so that their arms would rest in one place."""
    return [
        SceneProblem(
            ("robots", two.name),
            f"the robots '{one.name}' and '{two.name}' rest their arms in one place, at "
            f"({one.home.centroid.x:.2f}, {one.home.centroid.y:.2f}): have them stand on different "
            "sides of the table",
        )
        for one, two in combinations(members, 2)
        if one.home.distance(two.home) < _ROOM_AT_HOME_M
    ]


def _never_begun(members: Sequence[_Member], ways: _Ways) -> list[SceneProblem]:
    """Leaves that nobody may ever begin; else robots that may never begin any that they reach."""
    reached = {each.name: [way for way in ways.all if each.reaches(way.ends)] for each in members}
    free = {
        each.name: [way for way in reached[each.name] if each.keeps_out_of(members, way)]
        for each in members
    }
    found = []
    for way in ways.all:
        able = [name for name, some in reached.items() if way in some]
        if able and not any(way in free[name] for name in able):
            found.append(
                SceneProblem(
                    ("objects", way.leaf.object or ""),
                    f"no robot may ever handle {way.leaf.object}: {_named(able)} would go where "
                    "another arm rests: move the part, its place or the robots",
                )
            )
    return found or [
        SceneProblem(
            ("robots", each.name),
            f"the robot '{each.name}' may never begin anything: for all that it reaches it would "
            "go where another arm rests: have it stand farther from the others",
        )
        for each in members
        if reached[each.name] and not free[each.name]
    ]


def _named(robots: Sequence[str]) -> str:
    return " and ".join(f"'{each}'" for each in robots)


def _asked(members: Sequence[_Member], ways: _Ways, name: str, place: str | None) -> Sequence[int]:
    """Those in whose rings a leaf's object and its place are, the nearest first; else the nearest.

    Nobody, where a leaf before has moved the object: where it stands then the check does not know.
    Without leaves nobody either where one robot may pass a part on to another.
    """
    way = ways.of(name, place)
    ends = _in_scene(ways.scene, name, place) if way is None else way.ends
    near = sorted(
        range(len(members)), key=lambda number: max(members[number].away_m(*e) for e in ends)
    )
    able = [number for number in near if members[number].reaches(ends)]
    passed_on = way is None and all(any(each.reaches([end]) for each in members) for end in ends)
    if (able and way is not None and way.again) or (not able and passed_on):
        return ()
    return able or near[:1]
