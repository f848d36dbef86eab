"""The last look: which finished leaf's object is not at its place when the task is done."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from robots.link.messages import Sighting
from server.journal.events import MissingPart
from server.runtime.at_place import is_at_place
from server.runtime.run_state import RunState
from tasks.scene import Place, Scene, SceneObject

TOLERANCE_M = 0.05


def missing_parts(state: RunState, seen: Mapping[str, Sighting]) -> list[MissingPart]:
    """The objects of finished leaves that are seen elsewhere, or unseen with nothing above them.

    A part that another finished part rests above (a leg under a table top) may be out of sight:
    only a sighting somewhere else counts against it. But what is above it and not where it belongs
    (a top that hangs down) is no reason to believe in what it hides.
    """
    tree = state.tree
    done = [each for leaf in tree.leaves if tree.done(leaf) and (each := _finished(state, leaf))]
    missing: set[int] = set()
    for each in sorted(done, key=lambda each: -each.bottom_m):
        covers = [other for other in done if other.leaf not in missing]
        hidden = any(other.covers(each) for other in covers)
        if not _at_its_place(seen.get(each.name), each.place, state.scene, hidden):
            missing.add(each.leaf)
    return [
        MissingPart(
            node=tree.path_of(each.leaf),
            name=tree.name_of(each.leaf),
            object=each.name,
            place=each.place_name,
        )
        for each in done
        if each.leaf in missing
    ]


@dataclass(frozen=True, slots=True)
class _Finished:
    """What a finished leaf put where."""

    leaf: int
    name: str
    place_name: str
    part: SceneObject
    place: Place

    @property
    def bottom_m(self) -> float:
        """How high its place is (0: the table)."""
        return self.place.pose.z or 0.0

    def covers(self, other: "_Finished") -> bool:
        """Whether it rests so near above another part that it may hide it."""
        if self.bottom_m <= other.bottom_m:
            return False
        reach_m = (max(self.part.size[:2]) + max(other.part.size[:2])) / 2
        mine, its = self.place.pose, other.place.pose
        return math.hypot(mine.x - its.x, mine.y - its.y) < reach_m


def _finished(state: RunState, leaf: int) -> _Finished | None:
    definition, scene = state.tree.leaf_definition(leaf), state.scene
    if definition.object is None or definition.place is None:
        return None
    part, place = scene.objects.get(definition.object), scene.places.get(definition.place)
    if part is None or place is None:
        return None
    return _Finished(leaf, definition.object, definition.place, part, place)


def _at_its_place(sighting: Sighting | None, place: Place, scene: Scene, hidden: bool) -> bool:
    if sighting is None:
        return hidden
    if not hidden:
        return is_at_place(sighting, place, scene, TOLERANCE_M)
    # Of a part that is half covered only a piece is seen, whose centre is off.
    distance_m = math.hypot(sighting.x - place.pose.x, sighting.y - place.pose.y)
    return distance_m <= 4 * TOLERANCE_M
