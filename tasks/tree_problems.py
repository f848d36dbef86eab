"""What cannot work in a task tree whatever the robot: things done twice, or in the wrong order."""

from collections.abc import Iterator, Sequence, Set
from dataclasses import dataclass, replace
from typing import Literal

from mend.tasks.alternatives import MOST_COMPARED_LEAVES, distinct_alternatives
from mend.tasks.definition import BehaviorNode, GoalNode
from mend.tasks.footprint import Footprint
from mend.tasks.leaf_order import LeafOrder
from mend.tasks.scene import RESTS_M, Pose, Scene, SceneObject

Nodes = Sequence[GoalNode | BehaviorNode]

UNMOVED = -1
"""Stands for a leaf of what no leaf moves."""


@dataclass(frozen=True, slots=True)
class TreeProblem:
    """One mistake: the leaf's index among the nodes, which of its parameters, one sentence."""

    leaf: int
    parameter: Literal["object", "place"]
    message: str


def find_tree_problems(nodes: Nodes, scene: Scene | None) -> list[TreeProblem]:
    """Every mistake of a tree; with a scene, also of the order in which parts are stacked.

    That order is looked at in trees of at most `MOST_COMPARED_LEAVES` leaves.
    """
    found = [*_done_twice(nodes, "place"), *_done_twice(nodes, "object")]
    if scene is not None and not found:
        found += _stacking_problems(nodes, scene)
    return found


def _stacking_problems(nodes: Nodes, scene: Scene) -> Iterator[TreeProblem]:
    distinct = distinct_alternatives(nodes)
    if sum(node.kind == "behavior" for node in distinct.nodes) <= MOST_COMPARED_LEAVES:
        for problem in _wrongly_stacked(distinct.nodes, scene):
            yield replace(problem, leaf=distinct.originals[problem.leaf])


# --- Two leaves for one thing ---------------------------------------------------------------------


def _done_twice(nodes: Nodes, parameter: Literal["object", "place"]) -> Iterator[TreeProblem]:
    """Two leaves that both have to be done, with one place, or with one object to be placed."""
    under: dict[int, dict[str, int]] = {}
    # Children come after their parents: backwards, everything under a node is known at the node.
    for index in range(len(nodes) - 1, -1, -1):
        node = nodes[index]
        if isinstance(node, BehaviorNode):
            own = _named(node, parameter, index)
        else:
            own = under.pop(index, {})
        if node.parent is None:
            continue
        above = under.setdefault(node.parent, {})
        small, large = sorted((own, above), key=len)
        if nodes[node.parent].kind != "or":
            for name in small.keys() & large.keys():
                yield _twice(nodes, parameter, name, own[name], above[name])
        large |= small
        under[node.parent] = large


def _named(node: BehaviorNode, parameter: str, index: int) -> dict[str, int]:
    """The object or place of a leaf that brings something somewhere."""
    if node.object is None or node.place is None:
        return {}
    return {node.object if parameter == "object" else node.place: index}


def _twice(
    nodes: Nodes, parameter: Literal["object", "place"], name: str, first: int, second: int
) -> TreeProblem:
    if parameter == "place":
        what = f"the place '{name}' is filled twice"
        right = "give one of them another place, or make them alternatives of one OR"
    else:
        what = f"the object '{name}' is placed twice"
        right = (
            "a task brings each object to one place, so drop one of them, or make them "
            "alternatives of one OR"
        )
    by = f"by '{nodes[first].name}' and by '{nodes[second].name}'"
    return TreeProblem(max(first, second), parameter, f"{what}, {by}: {right}")


# --- The order of what stands on what -------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _Standing:
    """A leaf's part where it starts, or where it is to be."""

    leaf: int
    part: str
    ground: Footprint
    bottom_m: float
    top_m: float
    """Where something may stand on it."""

    def carries(self, other: "_Standing") -> bool:
        return abs(self.top_m - other.bottom_m) < RESTS_M and self.ground.overlaps(other.ground)

    def takes_over(self, other: "_Standing", upper: "_Standing") -> bool:
        """Whether it carries what another one carries, where that has been."""
        return (
            self.part != upper.part and self.carries(upper) and self.ground.overlaps(other.ground)
        )

    def fills(self, other: "_Standing") -> bool:
        """Whether both are in one space."""
        return min(self.top_m, other.top_m) - max(
            self.bottom_m, other.bottom_m
        ) > RESTS_M and self.ground.overlaps(other.ground)


def _wrongly_stacked(nodes: Nodes, scene: Scene) -> Iterator[TreeProblem]:
    starts, places = _starts(nodes, scene), _places(nodes, scene)
    unmoved = _unmoved(starts, scene)
    order = LeafOrder(nodes)
    yield from _without_support(starts, places, order)
    yield from _on_nothing([*unmoved, *starts], places, order)
    movers: dict[str, set[int]] = {}
    for each in starts:
        movers.setdefault(each.part, set()).add(each.leaf)
    for lower, upper in _stacked([*starts, *unmoved]):
        if lower.leaf == UNMOVED:
            continue
        if upper.leaf == UNMOVED:
            yield TreeProblem(
                lower.leaf,
                "object",
                f"'{upper.part}' starts on '{lower.part}', and nothing takes it off: have "
                f"'{upper.part}' brought elsewhere before '{lower.part}' in a THEN, or let it "
                "start elsewhere",
            )
        elif not _taken_before(movers[upper.part], lower.leaf, order):
            yield TreeProblem(
                lower.leaf,
                "object",
                f"'{upper.part}' starts on '{lower.part}' and is not sure to be taken off before "
                f"it: put '{upper.part}' before '{lower.part}' in a THEN",
            )
    for place in places:
        for start in starts:
            if start.part != place.part and start.fills(place):
                if _taken_before(movers[start.part], place.leaf, order):
                    continue
                yield TreeProblem(
                    place.leaf,
                    "place",
                    f"'{place.part}' is to go where '{start.part}' starts: put '{start.part}' "
                    f"before it in a THEN, or choose another place",
                )


def _taken_before(movers: Set[int], leaf: int, order: LeafOrder) -> bool:
    """Whether a part is away before a leaf begins, whichever of the leaves that move it is done."""
    before = {each for each in movers if order.is_before(each, leaf, surely=False)}
    return any(order.others_do(each, leaf, before) for each in before)


def _on_nothing(
    standing: Sequence[_Standing], places: Sequence[_Standing], order: LeafOrder
) -> Iterator[TreeProblem]:
    """Parts that are to stand on what an OR has placed only instead of them."""
    carriers: dict[int, list[_Standing]] = {}
    for lower, upper in _stacked(places):
        carriers.setdefault(upper.leaf, []).append(lower)
    for upper in places:
        below = carriers.get(upper.leaf, [])
        if not below or not all(order.exclusive(each.leaf, upper.leaf) for each in below):
            continue
        if not any(each.part != upper.part and each.carries(upper) for each in standing):
            yield TreeProblem(
                upper.leaf,
                "place",
                f"'{upper.part}' is to stand on '{below[0].part}', which an OR has placed only "
                f"instead of '{upper.part}': put both into one alternative, "
                f"'{below[0].part}' before '{upper.part}' in a THEN, or choose another place",
            )


def _without_support(
    starts: Sequence[_Standing], places: Sequence[_Standing], order: LeafOrder
) -> Iterator[TreeProblem]:
    """Parts that may be placed, or come to stand, on nothing."""
    stacked = list(_stacked(places))
    for lower, upper in stacked:
        if order.exclusive(lower.leaf, upper.leaf):
            continue
        carriers = {each.leaf for each, other in stacked if other.leaf == upper.leaf}
        if not order.is_before(lower.leaf, upper.leaf, surely=False):
            yield TreeProblem(
                upper.leaf,
                "place",
                f"'{upper.part}' is to stand on '{lower.part}', which is not sure to be placed "
                f"before it: put '{lower.part}' before '{upper.part}' in a THEN",
            )
        elif not order.others_do(lower.leaf, upper.leaf, carriers):
            yield TreeProblem(
                upper.leaf,
                "place",
                f"'{upper.part}' is to stand on '{lower.part}', and an OR may have something else "
                f"done than placing that: let each of its alternatives place what '{upper.part}' "
                f"can stand on, or put '{lower.part}' outside of the OR",
            )
    for lower in starts:
        for upper in places:
            if (
                lower.part != upper.part
                and lower.carries(upper)
                and not order.exclusive(lower.leaf, upper.leaf)
                and not any(each.takes_over(lower, upper) for each in places)
            ):
                yield TreeProblem(
                    upper.leaf,
                    "place",
                    f"'{upper.part}' is to stand on '{lower.part}' where that starts, but "
                    f"'{lower.part}' is to be brought elsewhere: choose another place",
                )


def _stacked(standing: Sequence[_Standing]) -> Iterator[tuple[_Standing, _Standing]]:
    """Every pair of which the first one carries the second one."""
    by_top: dict[int, list[_Standing]] = {}
    for each in standing:
        by_top.setdefault(round(each.top_m / RESTS_M), []).append(each)
    for upper in standing:
        level = round(upper.bottom_m / RESTS_M)
        for near in (level - 1, level, level + 1):
            for lower in by_top.get(near, ()):
                if lower.part != upper.part and lower.carries(upper):
                    yield lower, upper


def _starts(nodes: Nodes, scene: Scene) -> list[_Standing]:
    """Where the objects of leaves start."""
    return [
        _standing(index, node.object, scene.objects[node.object], None, scene)
        for index, node in enumerate(nodes)
        if isinstance(node, BehaviorNode)
        and node.object in scene.objects
        and node.place is not None
        and node.object is not None
    ]


def _unmoved(starts: Sequence[_Standing], scene: Scene) -> list[_Standing]:
    """Where everything starts that no leaf brings anywhere."""
    moved = {each.part for each in starts}
    return [
        _standing(UNMOVED, name, part, None, scene)
        for name, part in scene.objects.items()
        if name not in moved
    ]


def _places(nodes: Nodes, scene: Scene) -> list[_Standing]:
    """Where the objects of leaves are to be."""
    return [
        _standing(
            index, node.object, scene.objects[node.object], scene.places[node.place].pose, scene
        )
        for index, node in enumerate(nodes)
        if isinstance(node, BehaviorNode)
        and node.object is not None
        and node.place is not None
        and node.object in scene.objects
        and node.place in scene.places
    ]


def _standing(leaf: int, name: str, part: SceneObject, at: Pose | None, scene: Scene) -> _Standing:
    pose = part.pose if at is None else at
    bottom_m = scene.table.height if pose.z is None else pose.z
    ground = Footprint(pose.x, pose.y, pose.yaw, part.size[0], part.size[1])
    return _Standing(leaf, name, ground, bottom_m, bottom_m + part.size[2])
