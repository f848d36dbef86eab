"""The last look: which finished leaf's object is not at its place when the task is done."""

import math
from collections.abc import Mapping

from robots.link.messages import Sighting
from server.journal.events import MissingPart
from server.runtime.at_place import is_at_place
from server.runtime.run_state import RunState
from tasks.scene import Place, Scene, SceneObject

TOLERANCE_M = 0.05


def missing_parts(state: RunState, seen: Mapping[str, Sighting]) -> list[MissingPart]:
    """The objects of finished leaves that are seen elsewhere, or unseen with nothing above them.

    A part that another finished part rests above (a leg under a table top) may be out of sight:
    only a sighting somewhere else counts against it.
    """
    tree, scene = state.tree, state.scene
    done = [
        (leaf, name, place_name, scene.objects.get(name), scene.places.get(place_name))
        for leaf in tree.leaves
        if tree.done(leaf)
        and (name := tree.leaf_definition(leaf).object) is not None
        and (place_name := tree.leaf_definition(leaf).place) is not None
    ]
    missing = []
    for leaf, name, place_name, part, place in done:
        if part is None or place is None:
            continue
        covers = [(p, q) for _, other, _, p, q in done if other != name]
        if not _at_its_place(seen.get(name), place, scene, _hidden(part, place, covers)):
            missing.append(
                MissingPart(
                    node=tree.path_of(leaf),
                    name=tree.name_of(leaf),
                    object=name,
                    place=place_name,
                )
            )
    return missing


def _at_its_place(sighting: Sighting | None, place: Place, scene: Scene, hidden: bool) -> bool:
    if sighting is None:
        return hidden
    if not hidden:
        return is_at_place(sighting, place, scene, TOLERANCE_M)
    # Of a part that is half covered only a piece is seen, whose centre is off.
    distance_m = math.hypot(sighting.x - place.pose.x, sighting.y - place.pose.y)
    return distance_m <= 4 * TOLERANCE_M


def _hidden(
    part: SceneObject, place: Place, others: list[tuple[SceneObject | None, Place | None]]
) -> bool:
    bottom = place.pose.z or 0.0
    for other, at in others:
        if other is None or at is None or (at.pose.z or 0.0) <= bottom:
            continue
        reach_m = (max(other.size[:2]) + max(part.size[:2])) / 2
        if math.hypot(at.pose.x - place.pose.x, at.pose.y - place.pose.y) < reach_m:
            return True
    return False
