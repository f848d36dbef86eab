"""What became of parts that were placed: whose object is not at its place when the task is done."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from robots.link.messages import Sighting
from server.journal.events import MissingPart
from server.runtime.at_place import is_at_place
from server.runtime.run_state import RunState
from tasks.scene import Place, Scene, SceneObject

TOLERANCE_M = 0.05


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


class PlacedParts:
    """What the looks of a run have told of the objects of finished leaves.

    Not durable: after a restart only what can be seen still counts.
    """

    def __init__(self) -> None:
        self._seen: set[int] = set()
        """Leaves whose object was seen at its place since they were done."""
        self._missed: set[int] = set()
        """Leaves whose object was not, though nothing could have hidden it."""

    def note(self, state: RunState, seen: Mapping[str, Sighting]) -> None:
        """Take note of what a look saw while the robot was out of its own sight."""
        done = _all_finished(state)
        leaves = {each.leaf for each in done}
        self._seen &= leaves
        self._missed &= leaves
        for each, hidden in _with_hidden(done, seen, state.scene):
            if _at_its_place(seen.get(each.name), each.place, state.scene, hidden=False):
                self._seen.add(each.leaf)
            elif not hidden:
                self._missed.add(each.leaf)

    def missing(self, state: RunState, seen: Mapping[str, Sighting]) -> list[MissingPart]:
        """The objects of finished leaves that are seen elsewhere, or unseen where they should be.

        A part that another finished part rests above (a leg under a table top) may be out of sight:
        only a sighting somewhere else counts against it, or that it was missed before it was
        covered. But what is above it and not where it belongs (a top that hangs down) is no reason
        to believe in what it hides.
        """
        tree, done = state.tree, _all_finished(state)
        gone = {
            each.leaf
            for each, hidden in _with_hidden(done, seen, state.scene)
            if not _at_its_place(seen.get(each.name), each.place, state.scene, hidden)
            or (each.name not in seen and each.leaf in self._missed - self._seen)
        }
        return [
            MissingPart(
                node=tree.path_of(each.leaf),
                name=tree.name_of(each.leaf),
                object=each.name,
                place=each.place_name,
            )
            for each in done
            if each.leaf in gone
        ]


def _with_hidden(
    done: Sequence[_Finished], seen: Mapping[str, Sighting], scene: Scene
) -> Iterator[tuple[_Finished, bool]]:
    """Each finished leaf, highest place first, and whether what is at a place above may hide it."""
    fallen: set[int] = set()
    for each in sorted(done, key=lambda each: -each.bottom_m):
        hidden = any(other.covers(each) for other in done if other.leaf not in fallen)
        if not _at_its_place(seen.get(each.name), each.place, scene, hidden):
            fallen.add(each.leaf)
        yield each, hidden


def left_out_parts(state: RunState) -> list[MissingPart]:
    """The parts that a helper had left out."""
    tree = state.tree
    return [
        MissingPart(
            node=tree.path_of(leaf),
            name=tree.name_of(leaf),
            object=tree.leaf_definition(leaf).object or tree.name_of(leaf),
            place=tree.leaf_definition(leaf).place or "",
            left_out_by=helper,
        )
        for leaf, helper in sorted(state.left_out.items())
    ]


def _all_finished(state: RunState) -> list[_Finished]:
    tree = state.tree
    leaves = (leaf for leaf in tree.leaves if tree.done(leaf) and leaf not in state.left_out)
    found = (_finished(state, leaf) for leaf in leaves)
    return [each for each in found if each is not None]


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
