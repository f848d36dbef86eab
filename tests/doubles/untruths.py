"""Untruths: what a run's last event says that its other events, or the world, contradict.

Like `broken_constraints` it knows nothing of the runtime's code: it works from the events alone.
Where things really are it is told by somebody who may know, the judge of a simulated world.
"""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from mend.server.journal import events as ev
from mend.tasks.definition import BehaviorNode, TaskTreeDefinition
from mend.tasks.scene import Place, Scene


@dataclass(frozen=True, slots=True)
class Rest:
    """Where the bottom centre of a part rests (base frame, metres), and how far it leans."""

    x: float
    y: float
    z: float
    lean_rad: float = 0.0


AT_PLACE_M = 0.02
LEVEL_RAD = 0.05
AWAY_M = 0.06
TOO_HIGH_M = 0.04
"""A part within `AT_PLACE_M` of its place that leans less than `LEVEL_RAD` is there. Farther from
it than `AWAY_M` in the plane, or `TOO_HIGH_M` in height, it is not; in between (it lies askew on
something, or hangs down where a leg was taken from under it) both may be said."""


def find_untruths(events: Sequence[ev.Event], resting: Mapping[str, Rest | None]) -> list[str]:
    """One sentence per untrue thing that an ended run says.

    `resting` has where every part really rests at the end, None if it is gone.
    """
    started, end = _start_of(events), events[-1]
    match end:
        case ev.RunFinished():
            return _untrue_missing(started, events, end, resting)
        case ev.RunFailed():
            return _untrue_reason(started, events, end)
        case _:
            return ["the run ended neither finished nor failed"]


def _untrue_missing(
    started: ev.RunStarted,
    events: Sequence[ev.Event],
    end: ev.RunFinished,
    resting: Mapping[str, Rest | None],
) -> list[str]:
    leaves = leaves_of(started)
    scene = Scene.model_validate(started.scene, strict=False)
    told = {each.node for each in end.missing}
    unseen = {each.node for each in end.unseen}
    blocked = _somebody_stands_there(events)
    wrong = []
    started_last = _started_last(events)
    for done in _done_at_the_end(events):
        leaf = leaves[done.node]
        if leaf.object is None or leaf.place is None or done.node not in started_last:
            continue
        rest = _nearest_equal(leaf.object, resting, scene, scene.places[leaf.place])
        aside_m, above_m = _offset(rest, scene, scene.places[leaf.place])
        level = rest is not None and rest.lean_rad <= LEVEL_RAD
        there = level and aside_m <= AT_PLACE_M and above_m <= AT_PLACE_M
        away = aside_m > AWAY_M or above_m > TOO_HIGH_M
        unsure = blocked or _is_under(leaf, [leaves[node] for node in told], scene)
        if there and done.node in told and not unsure:
            wrong.append(f"'{leaf.object}' is told to be missing, but is at its place")
        if away and done.node not in told | unseen:
            wrong.append(f"'{leaf.object}' is not at its place, but is not told to be missing")
        others = [other for name, other in resting.items() if name != leaf.object]
        taken = any(_offset(each, scene, scene.places[leaf.place])[0] <= AWAY_M for each in others)
        # A part put where another one lies is no untruth: nobody looks before the last look.
        left_out = isinstance(done, ev.NodeLeftOut)
        if (
            away
            and not taken
            and not left_out
            and not _disturbed_since(events, done.node, leaf.object)
        ):
            wrong.append(f"'{done.node}' is done, but '{leaf.object}' never was at its place")
    return wrong


def _done_at_the_end(events: Sequence[ev.Event]) -> list[ev.NodeDone | ev.NodeLeftOut]:
    """How each leaf that counts as done at the end came to that."""
    done: dict[str, ev.NodeDone | ev.NodeLeftOut] = {}
    for event in events:
        match event:
            case ev.NodeDone() | ev.NodeLeftOut():
                done[event.node] = event
            case ev.NodeUndone():
                del done[event.node]
    return list(done.values())


def _started_last(events: Sequence[ev.Event]) -> set[str]:
    """Of the leaves that handle one object in turn, those that were started last."""
    leaves = leaves_of(_start_of(events))
    started = [each.node for each in events if isinstance(each, ev.NodeStarted)]
    return set({leaves[node].object or node: node for node in started}.values())


def _start_of(events: Sequence[ev.Event]) -> ev.RunStarted:
    started = events[0]
    assert isinstance(started, ev.RunStarted), "a run begins with run_started"
    return started


def equals_of(name: str, scene: Scene) -> set[str]:
    """The objects that nobody can tell from one, itself among them: any of them will do."""
    own = scene.objects[name]
    return {
        other
        for other, each in scene.objects.items()
        if (each.size, each.knob, each.color) == (own.size, own.knob, own.color)
    }


def _nearest_equal(
    name: str, resting: Mapping[str, Rest | None], scene: Scene, place: Place
) -> Rest | None:
    """Of an object and its equals, the one nearest to a place."""
    rests = (resting.get(each) for each in equals_of(name, scene))
    return min(rests, key=lambda each: math.hypot(*_offset(each, scene, place)))


def _offset(rest: Rest | None, scene: Scene, place: Place) -> tuple[float, float]:
    """How far a part is from its place: in the plane, and in height."""
    if rest is None:
        return math.inf, math.inf
    height_m = scene.table.height if place.pose.z is None else place.pose.z
    in_plane_m = math.hypot(rest.x - place.pose.x, rest.y - place.pose.y)
    return in_plane_m, abs(rest.z - height_m)


def _somebody_stands_there(events: Sequence[ev.Event]) -> bool:
    """Whether somebody still stands in the way at the end: what they hide cannot be found."""
    acts = [
        each.act
        for each in events
        if isinstance(each, ev.InterventionDone) and each.ok and each.act in ("block", "release")
    ]
    return acts[-1:] == ["block"]


def _is_under(leaf: BehaviorNode, missing: Sequence[BehaviorNode], scene: Scene) -> bool:
    """Whether a part may be hidden by one that is told to be missing from a place above it."""
    if leaf.object is None or leaf.place is None:
        return False
    part, pose = scene.objects[leaf.object], scene.places[leaf.place].pose
    for other in missing:
        if other.object is None or other.place is None:
            continue
        above, at = scene.objects[other.object], scene.places[other.place].pose
        reach_m = (max(part.size[:2]) + max(above.size[:2])) / 2
        near = math.hypot(at.x - pose.x, at.y - pose.y) < reach_m
        if near and (at.z or 0.0) > (pose.z or 0.0):
            return True
    return False


def _disturbed_since(events: Sequence[ev.Event], node: str, handled: str) -> bool:
    """Whether a person may have touched a part since its leaf was last started.

    Who clears the way puts aside whatever lies in it.
    """
    begun = max(
        index
        for index, each in enumerate(events)
        if isinstance(each, ev.NodeStarted) and each.node == node
    )
    return any(
        isinstance(each, ev.InterventionDone)
        and each.ok
        and (each.object == handled or each.act == "release")
        for each in events[begun:]
    )


def _untrue_reason(
    started: ev.RunStarted, events: Sequence[ev.Event], end: ev.RunFailed
) -> list[str]:
    if end.node is None:
        lost = any(isinstance(each, ev.RobotLost) for each in events)
        return [] if lost else [f"it failed because {end.reason}, but no robot was lost"]
    if end.node not in leaves_of(started):
        return [f"it failed because of '{end.node}', which is no leaf"]
    wrong = []
    most = int(started.options.get("max_attempts", 3))
    failed = sum(
        isinstance(each, ev.NodeReset) and each.node == end.node and each.failed_attempt
        for each in events
    )
    said = "it failed once" if most == 1 else f"it failed {most} times"
    given_up = said in end.reason and failed >= most
    if not given_up and not _was_gone(events, end):
        wrong.append(f"it says '{end.reason}', but {failed} attempts at '{end.node}' failed")
    if way_out := _way_out(started, events, end.node):
        wrong.append(f"it failed because of '{end.node}', but could have abandoned '{way_out}'")
    return wrong


def _was_gone(events: Sequence[ev.Event], end: ev.RunFailed) -> bool:
    """Whether it says that a leaf's result was gone so often, and that is so."""
    said = re.search(r"it was gone again after it had been done (\d+) times", end.reason)
    gone = sum(
        isinstance(each, ev.NodeUndone)
        and each.node == end.node
        and each.because_of is None
        and not each.unseen
        for each in events
    )
    return said is not None and gone == int(said[1])


def _way_out(started: ev.RunStarted, events: Sequence[ev.Event], node: str) -> str | None:
    """An alternative above (or at) a leaf that could still have been given up."""
    definition = TaskTreeDefinition.model_validate(started.tree)
    paths = paths_of(definition)
    kinds = {path: each.kind for path, each in zip(paths, definition.nodes, strict=True)}
    done = [each.node for each in _done_at_the_end(events)]
    abandoned = {each.node for each in events if isinstance(each, ev.NodeAbandoned)}
    child = node
    while child != "/":
        parent = _parent(child)
        touched = any(each == child or each.startswith(child + "/") for each in done)
        others = [
            each
            for each in paths
            if each not in ("/", child) and _parent(each) == parent and each not in abandoned
        ]
        if kinds[parent] == "or" and not touched and others:
            return child
        child = parent
    return None


def leaves_of(started: ev.RunStarted) -> dict[str, BehaviorNode]:
    """Every leaf by its path."""
    definition = TaskTreeDefinition.model_validate(started.tree)
    pairs = zip(paths_of(definition), definition.nodes, strict=True)
    return {path: each for path, each in pairs if isinstance(each, BehaviorNode)}


def kinds_of(started: ev.RunStarted) -> dict[str, str]:
    """Every node's kind by its path, as `broken_constraints` wants them."""
    definition = TaskTreeDefinition.model_validate(started.tree)
    pairs = zip(paths_of(definition), definition.nodes, strict=True)
    return {path: str(each.kind) for path, each in pairs}


def paths_of(definition: TaskTreeDefinition) -> list[str]:
    """The path of every node, in the definition's order."""
    paths: list[str] = []
    children = [0] * len(definition.nodes)
    for node in definition.nodes:
        if node.parent is None:
            paths.append("/")
            continue
        paths.append(f"{paths[node.parent].rstrip('/')}/{children[node.parent]}")
        children[node.parent] += 1
    return paths


def _parent(path: str) -> str:
    return path.rsplit("/", 1)[0] or "/"
