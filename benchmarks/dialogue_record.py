"""A run as it really was: its events, and the state of the simulated world beside each."""

import math
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from untruths import Rest, equals_of, kinds_of, leaves_of

from mend.dialogue.spoken import spoken
from mend.robots.body import Matrix4
from mend.robots.vision.line_of_sight import sight_of
from mend.robots.vision.seen_box import SeenBox
from mend.server.journal import events as ev
from mend.sim.base_frame import base_in_scene
from mend.tasks.frames import Frame, frames_of
from mend.tasks.part_boxes import height_of
from mend.tasks.scene import Scene

NEAR_M = 0.06
"""Room that the fingers need: a part this near to another, or to its place, may be in the way."""

_ARM_PASSES_M = 0.3
"""So far behind the fingers a forearm may still touch something."""

SAME_SPOT_M = 0.02
"""What is this near to a pose of the scene is there."""

WHOLE_SHARE = 0.9
"""A part of which the head camera sees more than this share is not hidden."""

LEANS_RAD = 0.05
"""What leans less stands."""

GIVEN = frozenset({"place", "put_back", "hand_over", "move", "release", "uncover"})
"""Deeds that may be help."""


@dataclass(frozen=True, slots=True)
class Moment:
    """The world at one event; a part is None in `resting` while somebody has taken it away.

    `dark`: somebody has covered the head camera.
    """

    resting: Mapping[str, Rest | None]
    held: frozenset[str]
    blocked: bool
    dark: bool = False


class RunRecord:
    """What was so when, for a judge; `moments[i]` is the world at `events[i]`."""

    def __init__(self, events: Sequence[ev.Event], moments: Sequence[Moment]) -> None:
        started = events[0]
        assert isinstance(started, ev.RunStarted), "a run begins with run_started"
        self.events = events
        self._moments = moments
        self._scene = Scene.model_validate(started.scene, strict=False)
        self._leaves = leaves_of(started)
        self._kinds = kinds_of(started)
        self._eyes = _eyes_of(started, self._scene)
        self._raised: dict[str, ev.IssueRaised] = {}
        self._opened: dict[Any, int] = {}

    def note(self, index: int) -> None:
        """Take note of the event that comes next."""
        match self.events[index]:
            case ev.IssueRaised() as raised:
                self._raised[raised.node] = raised
            case ev.DialogueOpened() as opened:
                self._opened[opened.dialogue] = index

    def are_alternatives_above(self, node: str, other: str) -> bool:
        """Whether an OR is above both nodes."""
        return any(
            kind == "or" and all(each.startswith(path.rstrip("/") + "/") for each in (node, other))
            for path, kind in self._kinds.items()
        )

    def object_of(self, node: str) -> str | None:
        """What a leaf puts at its place; None without one."""
        leaf = self._leaves.get(node)
        return None if leaf is None or leaf.place is None else leaf.object

    def spoken_names(self, node: str) -> set[str]:
        """What a robot may call what a leaf does, where its object or its place tells it apart."""
        leaf = self._leaves.get(node)
        if leaf is None or leaf.object is None:
            return set()
        return {spoken(leaf.object), spoken(f"{leaf.object} for the {leaf.place}")}

    def since_opened(self, index: int, event: ev.DialogueEvent) -> Sequence[ev.Event]:
        """The events of a dialogue, and all beside them, so far."""
        return self.events[self._opened[event.dialogue] : index]

    def offset(self, index: int, node: str, name: str | None) -> tuple[float, float]:
        """How far a part is from its place (in the plane, in height), infinite if it is gone."""
        place = self._place(node)
        return (math.inf, math.inf) if place is None else self._offset_from(index, place, name)

    def offset_of_alternative(self, index: int, name: str, place: str) -> float:
        """How far a part is from a place, both as robots say them; infinite if no leaf has both."""
        offsets = [
            max(self._offset_from(index, each.place, each.object))
            for each in self._leaves.values()
            if each.place is not None
            and each.object is not None
            and (spoken(each.object), spoken(each.place)) == (name, place)
        ]
        return min(offsets, default=math.inf)

    def _offset_from(self, index: int, place: str, name: str | None) -> tuple[float, float]:
        pose = self._scene.places[place].pose
        height_m = self._scene.table.height if pose.z is None else pose.z
        offsets = [
            (math.hypot(rest.x - pose.x, rest.y - pose.y), abs(rest.z - height_m))
            for rest in self._lying(index, name)
        ]
        return min(offsets, key=max, default=(math.inf, math.inf))

    def rests(self, index: int, name: str | None) -> bool:
        """Whether a part lies anywhere."""
        return bool(self._lying(index, name))

    def equals(self, name: str | None) -> set[str]:
        """The parts that nobody can tell from one, itself among them."""
        return equals_of(name, self._scene) if name in self._scene.objects else set()

    def holds(self, moment: Moment, name: str | None) -> bool:
        """Whether the fingers hold a part."""
        return not moment.held.isdisjoint(self.equals(name))

    def _lying(self, index: int, name: str | None) -> list[Rest]:
        """Where a part, and each that is just like it, lies."""
        moment = self._moments[index]
        lying = (moment.resting.get(each) for each in self.equals(name) if each not in moment.held)
        return [each for each in lying if each is not None]

    def moment(self, index: int) -> Moment:
        return self._moments[index]

    def raised_at(self, node: str) -> int:
        """The event with which the issue of a leaf was raised last."""
        return self.events.index(self._raised[node])

    def at_issue(self, node: str) -> Moment:
        """The world when the issue of a leaf was raised last."""
        return self._moments[self.raised_at(node)]

    def may_be_hidden(self, index: int, name: str | None, robot: str) -> bool:
        """Whether a robot's camera does not show where a part is, or another part may hide it."""
        resting = self._moments[index].resting
        rest = resting.get(name or "")
        if rest is None or name is None:
            return False
        eye = self._eyes[robot]
        if not eye.shows(rest):
            return True
        others = [
            self._box(other, each, math.hypot)
            for other, each in resting.items()
            if other != name and each is not None
        ]
        seen = sight_of(eye.at, self._box(name, rest, min), others).share
        return seen < WHOLE_SHARE or self.buried(index, name)

    def buried(self, index: int, name: str | None) -> bool:
        """Whether another part lies over one."""
        resting = self._moments[index].resting
        rest = resting.get(name or "")
        if rest is None or name is None:
            return False
        return any(
            each is not None
            and other != name
            and each.z > rest.z
            and math.hypot(each.x - rest.x, each.y - rest.y) < self._together_m(name, other)
            for other, each in resting.items()
        )

    def _box(self, name: str, rest: Rest, across: Callable[[float, float], float]) -> SeenBox:
        """A part as a square box: nothing tells how it is turned."""
        part = self._scene.objects[name]
        side_m = across(*part.size[:2])
        return SeenBox(
            rest.x,
            rest.y,
            0.0,
            (side_m, side_m, height_of(part.size, part.knob)),
            rest.z,
            name,
            complete=True,
        )

    def lay_for_s(self, index: int, name: str | None) -> float:
        """For how long a part has lain where it lies, upright; 0 if it does not."""
        rest = self._moments[index].resting.get(name or "")
        if rest is None or rest.lean_rad > LEANS_RAD or name in self._moments[index].held:
            return 0.0
        since = index
        while since > 0 and self._moments[since - 1].resting.get(name or "") == rest:
            since -= 1
        return self.events[index].time - self.events[since].time

    def moved_since_first_look_m(self, index: int, event: ev.DialogueEvent) -> float:
        """How far what looks like a dialogue's object is from where that was at its first look.

        Where equal parts lie, that of the nearest; 0 if nothing lay there then.
        """
        firsts = [
            begun
            for begun, each in enumerate(self.events[:index])
            if isinstance(each, ev.FirstLook) and each.dialogue == event.dialogue
        ]
        before = [rest for at in firsts for rest in self._lying(at, event.object)]
        now = self._lying(index, event.object)
        return min((math.hypot(a.x - b.x, a.y - b.y) for a in before for b in now), default=0.0)

    def is_surely_in_reach(self, index: int, name: str | None) -> bool:
        """Whether a part lies where the scene has a start or a place: a robot alone reaches those.

        Of several robots one reaches some, another others.
        """
        if len(self._scene.robots) > 1:
            return False
        rest = self._moments[index].resting.get(name or "")
        spots = [each.pose for each in self._scene.objects.values()]
        spots += [each.pose for each in self._scene.places.values()]
        return rest is not None and any(
            math.hypot(rest.x - each.x, rest.y - each.y) <= SAME_SPOT_M for each in spots
        )

    def arm_holds_in_place(self, index: int, robot: str) -> bool:
        """Whether its arm has stopped in the middle of a step, where it may hide what is below."""
        held = (
            each.at
            for each in self.events[:index]
            if isinstance(each, ev.RobotHolding) and each.robot == robot
        )
        return deque(held, maxlen=1) == deque(["in_place"])

    def answered_last(self, index: int, event: ev.DialogueEvent) -> bool:
        """Whether the last question of a dialogue was answered."""
        for each in reversed(self.since_opened(index, event)):
            if isinstance(each, ev.Answered) and each.dialogue == event.dialogue:
                return True
            if isinstance(each, ev.Prompt) and each.kind == "ask":
                return False
        return False

    def _together_m(self, name: str, other: str) -> float:
        """Parts nearer to each other than this may touch or hide each other."""
        objects = self._scene.objects
        size = objects[name].size if name in objects else (0.1, 0.1, 0.1)
        return (max(size[:2]) + max(objects[other].size[:2])) / 2 + NEAR_M

    def crowded(self, node: str, name: str | None, index: int | None = None) -> bool:
        """Whether another part lies so near the place of a leaf that it may be in the way.

        When its issue was raised, or at an event.
        """
        moment = self.at_issue(node) if index is None else self._moments[index]
        return any(self._crowds(moment, node, each) for each in moment.resting if each != name)

    def _crowds(self, moment: Moment, node: str, other: str | None) -> bool:
        """Whether a part lies near the place of a leaf."""
        place, rest = self._place(node), moment.resting.get(other or "")
        if place is None or rest is None or other is None:
            return False
        pose = self._scene.places[place].pose
        together_m = self._together_m(self._leaves[node].object or "", other)
        return math.hypot(rest.x - pose.x, rest.y - pose.y) < together_m

    def deeds(self, index: int, event: ev.DialogueEvent) -> Iterator[ev.InterventionDone]:
        """What people really did for a dialogue's object, or about the way, since it opened.

        Who takes another part away from its place, as it may be by mistake, helps as well.
        """
        for each in self.since_opened(index, event):
            if not isinstance(each, ev.InterventionDone) or not each.ok or each.act not in GIVEN:
                continue
            about_it = each.object == event.object or each.act in ("release", "uncover")
            if about_it or self._cleared(index, event.node, each.object):
                yield each

    def _cleared(self, index: int, node: str, other: str | None) -> bool:
        """Whether a part lay near the place of a leaf at its issue, and does not by an event."""
        before, now = self.at_issue(node), self._moments[index]
        return self._crowds(before, node, other) and not self._crowds(now, node, other)

    def stands_by(self, node: str, name: str, other: str) -> bool:
        """Whether a part was where the arm passes over on its way to another or to its place."""
        moment, place = self.at_issue(node), self._place(node)
        rest, own = moment.resting.get(other), moment.resting.get(name)
        ends = [] if own is None else [(own.x, own.y)]
        if place is not None:
            ends.append((self._scene.places[place].pose.x, self._scene.places[place].pose.y))
        return rest is not None and any(
            math.hypot(rest.x - x, rest.y - y) <= _ARM_PASSES_M for x, y in ends
        )

    def issues_so_far(self, index: int, event: ev.DialogueEvent) -> int:
        return sum(
            isinstance(each, ev.IssueRaised)
            and (each.node, each.issue) == (event.node, event.issue)
            for each in self.events[:index]
        )

    def following(self, index: int) -> Sequence[ev.Event]:
        return self.events[index + 1 :]

    def failed_before(self, index: int, node: str) -> int:
        return sum(
            isinstance(each, ev.NodeReset) and each.node == node and each.failed_attempt
            for each in self.events[:index]
        )

    def _place(self, node: str) -> str | None:
        leaf = self._leaves.get(node)
        return None if leaf is None else leaf.place


@dataclass(frozen=True, slots=True)
class _Eye:
    """A head camera: its optical frame in the scene's, and how far it sees to its sides."""

    pose: Matrix4
    slopes: tuple[float, float]

    @property
    def at(self) -> NDArray[np.float64]:
        return np.asarray(self.pose[:3, 3])

    def shows(self, rest: Rest) -> bool:
        """Whether a spot is in its pictures."""
        right, down, ahead = (np.array([rest.x, rest.y, rest.z]) - self.at) @ self.pose[:3, :3]
        return bool(
            abs(right) < self.slopes[0] * ahead and abs(down) < self.slopes[1] * ahead and ahead > 0
        )


def _eyes_of(started: ev.RunStarted, scene: Scene) -> Mapping[str, _Eye]:
    """Each robot's, by its name; robots are listed as they stand in the scene."""
    frames = frames_of(scene).values()
    return {
        robot: _eye_of(started.world, scene, frame)
        for robot, frame in zip(started.robots, frames, strict=True)
    }


def _eye_of(world: str, scene: Scene, frame: Frame) -> _Eye:
    if world == "tabletop":
        from mend.sim.tabletop.scenery import HEAD_FOCAL_PX, HEAD_SIZE, look_at_table

        pose, size, focal_px = (
            look_at_table(frame.table_to_robot(scene.table)),
            HEAD_SIZE,
            HEAD_FOCAL_PX,
        )
    else:
        from mend.sim.workcell.cameras import head_camera_pose, head_optics

        optics = head_optics()
        pose, size, focal_px = head_camera_pose(), optics.size, optics.focal_px
    slopes = size[0] / 2 / focal_px, size[1] / 2 / focal_px
    return _Eye(base_in_scene(frame) @ pose, slopes)
