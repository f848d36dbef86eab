"""Parts that one robot alone can fetch and another alone can place: set down between the two.

Such a leaf becomes two, one after the other, as a transfer is in deliveries: the first robot takes
the part to a free spot that both reach, the second takes it from there.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from math import dist

import numpy as np

from mend.robots.arm.body import Reach
from mend.tasks.definition import BehaviorNode, GoalNode, TaskTreeDefinition
from mend.tasks.footprint import Footprint
from mend.tasks.frames import Frame, frames_of
from mend.tasks.scene import Place, Pose, Scene

_STEP_M = 0.01
_FREE_AROUND_M = 0.12
"""Room for the fingers and the palm of either robot around what is set down."""
_FROM_RIM_M = 0.02
"""So far within both reaches and the table's rim a spot is at least."""
_LONGEST_NAME = 64

Node = GoalNode | BehaviorNode


@dataclass(frozen=True, slots=True)
class WithTransfers:
    """A task and its scene, with the leaves and the spots that transfers need."""

    tree: TaskTreeDefinition
    scene: Scene


def plan_transfers(tree: TaskTreeDefinition, scene: Scene, reach: Reach) -> WithTransfers:
    """Split each leaf that no single robot can do; `reach` is every robot's, in its base frame.

    A leaf stays as it is where no spot is free.
    """
    if len(scene.robots) < 2:
        return WithTransfers(tree, scene)
    planner = _Transfers(scene, [_Ring(frame, reach) for frame in frames_of(scene).values()])
    nodes = planner.split(tree)
    if not planner.spots:
        return WithTransfers(tree, scene)
    places = {**scene.places, **planner.spots}
    return WithTransfers(
        tree.model_copy(update={"nodes": nodes}), scene.model_copy(update={"places": places})
    )


@dataclass(frozen=True, slots=True)
class _Ring:
    """What one robot reaches of the scene's plane."""

    frame: Frame
    reach: Reach

    def has(self, x: float, y: float, from_rim_m: float = 0.0) -> bool:
        away_m = dist(self.frame.to_robot(x, y), self.reach.origin)
        return self.reach.min_m + from_rim_m <= away_m <= self.reach.max_m - from_rim_m


@dataclass(slots=True)
class _Transfers:
    """The transfers of one task. `spots`: the places that they need, by name."""

    scene: Scene
    rings: list[_Ring]
    spots: dict[str, Place] = field(default_factory=dict)
    _at: dict[str, Pose] = field(default_factory=dict)
    """Where a part is once the leaves before are done."""

    def split(self, tree: TaskTreeDefinition) -> list[Node]:
        names = {node.name for node in tree.nodes}
        nodes: list[Node] = []
        moved_to: dict[int, int] = {}
        for index, node in enumerate(tree.nodes):
            parent = None if node.parent is None else moved_to[node.parent]
            moved_to[index] = len(nodes)
            node = node.model_copy(update={"parent": parent})
            spot = self._spot(node) if isinstance(node, BehaviorNode) else None
            if isinstance(node, BehaviorNode) and spot is not None:
                nodes += self._two_leaves(node, spot, len(nodes), names)
            else:
                nodes.append(node)
        return nodes

    def _spot(self, leaf: BehaviorNode) -> Place | None:
        """Where the part of a leaf is to be set down on its way; None if it need not or cannot."""
        part = self.scene.objects.get(leaf.object or "")
        place = self.scene.places.get(leaf.place or "")
        if part is None or place is None or leaf.object is None:
            return None
        begin = self._at.get(leaf.object, part.pose)
        self._at[leaf.object] = place.pose
        fetch = [each for each in self.rings if each.has(begin.x, begin.y)]
        put = [each for each in self.rings if each.has(place.pose.x, place.pose.y)]
        if not fetch or not put or any(each in put for each in fetch):
            return None
        length_m, width_m, _ = part.size
        for x, y in self._between(begin, place.pose):
            spot = Footprint(x, y, place.pose.yaw, length_m, width_m)
            reached = any(each.has(x, y, _FROM_RIM_M) for each in fetch)
            reached = reached and any(each.has(x, y, _FROM_RIM_M) for each in put)
            if reached and self._is_free(spot):
                return Place(pose=Pose(x=x, y=y, yaw=place.pose.yaw))
        return None

    def _between(self, begin: Pose, end: Pose) -> Iterator[tuple[float, float]]:
        """Spots over the table, those first that make the way no longer."""
        table = self.scene.table
        half = np.array(table.size) / 2 - _FROM_RIM_M - _FREE_AROUND_M / 2
        axes = [
            np.arange(middle - room, middle + room + 1e-9, _STEP_M)
            for middle, room in zip(table.center, half, strict=True)
            if room > 0.0
        ]
        if len(axes) < 2:
            return
        x, y = (each.ravel() for each in np.meshgrid(*axes))
        way_m = np.hypot(x - begin.x, y - begin.y) + np.hypot(x - end.x, y - end.y)
        for index in np.argsort(way_m, kind="stable").tolist():
            yield round(float(x[index]), 4), round(float(y[index]), 4)

    def _is_free(self, spot: Footprint) -> bool:
        wide = Footprint(
            spot.x, spot.y, spot.yaw, spot.length + _FREE_AROUND_M, spot.width + _FREE_AROUND_M
        )
        return not any(wide.overlaps(each) for each in self._taken())

    def _taken(self) -> Iterator[Footprint]:
        scene = self.scene
        largest_m = max((max(each.size[:2]) for each in scene.objects.values()), default=0.0)
        for part in scene.objects.values():
            yield Footprint(part.pose.x, part.pose.y, part.pose.yaw, *part.size[:2])
        for name, place in (*scene.places.items(), *self.spots.items()):
            known = scene.objects.get(name)
            size = (largest_m, largest_m) if known is None else known.size[:2]
            yield Footprint(place.pose.x, place.pose.y, place.pose.yaw, *size)

    def _two_leaves(
        self, leaf: BehaviorNode, spot: Place, index: int, names: set[str]
    ) -> list[Node]:
        """A THEN in a leaf's place: to the spot, then on from there."""
        between = _new_name(f"{leaf.object}_transfer", {*self.scene.places, *self.spots})
        self.spots[between] = spot
        first = _new_name(f"{leaf.name}_to_transfer", names)
        second = _new_name(f"{leaf.name}_from_transfer", names)
        to_spot = {**leaf.parameters, "place": between}
        to_spot.pop("needs_help", None)
        return [
            GoalNode(kind="then", parent=leaf.parent, name=leaf.name),
            leaf.model_copy(update={"parent": index, "name": first, "parameters": to_spot}),
            leaf.model_copy(update={"parent": index, "name": second}),
        ]


def _new_name(wanted: str, taken: set[str]) -> str:
    """`wanted`, with a number where that is taken; it is taken from now on."""
    name, number = wanted[:_LONGEST_NAME], 1
    while name in taken:
        number += 1
        name = f"{wanted[: _LONGEST_NAME - 6]}_{number}"
    taken.add(name)
    return name
