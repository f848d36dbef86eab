"""A recorded moment as Foxglove's transforms, joints and boxes."""

import math
from collections.abc import Iterable, Iterator, Sequence

from mend.server.export.foxglove import (
    Color,
    CubePrimitive,
    FrameTransform,
    FrameTransforms,
    JointState,
    JointStates,
    Pose,
    Quaternion,
    SceneEntity,
    SceneEntityDeletion,
    SceneUpdate,
    Time,
    Vector3,
)
from mend.server.poses.frame import DecodedFrame, PoseOfFrame
from mend.server.poses.layout import Layout, ObjectLayout, Triple

SCENE = "scene"
"""The frame in which all stands."""

_DIGITS = 6
"""Poses are recorded with single precision: a micrometre is all that there is to tell."""

Placed = tuple[str, str, PoseOfFrame]
"""A parent frame, a child frame, and where that is in it."""

_UNTURNED = Quaternion(x=0.0, y=0.0, z=0.0, w=1.0)


def base_of(robot: str) -> str:
    """The name of a robot's base frame."""
    return f"{robot}/base"


def frame_of(thing: str) -> str:
    """The name of an object's frame: its own, unless that is the name of where all stands."""
    return thing if thing != SCENE else f"{SCENE}/{SCENE}"


def transforms_of(layout: Layout, frame: DecodedFrame, time: Time) -> FrameTransforms:
    """Where the bases, the tools and the objects are."""
    base = base_of(layout.robot)
    placed = list(_bases(layout, frame))
    placed.append((base, f"{layout.robot}/tool", frame.tool))
    placed += [
        (base, frame_of(each.name), shown.pose)
        for each, shown in zip(layout.objects, frame.objects, strict=True)
    ]
    placed += _arms(layout, frame)
    return FrameTransforms(transforms=[_transform(*each, time) for each in _rooted(placed)])


def _rooted(placed: Iterable[Placed]) -> Iterator[Placed]:
    """Those whose place in the scene is known: what hangs at a robot that is nowhere is nowhere."""
    known = {SCENE}
    for parent, child, pose in placed:
        if parent in known:
            known.add(child)
            yield parent, child, pose


def _arms(layout: Layout, frame: DecodedFrame) -> Iterator[Placed]:
    for arm in frame.arms:
        robot = layout.arms[arm.number].robot
        if robot not in layout.robots:
            yield base_of(layout.robot), base_of(robot), arm.base
        yield base_of(robot), f"{robot}/tool", arm.tool


def _bases(layout: Layout, frame: DecodedFrame) -> Iterator[Placed]:
    if layout.robot not in layout.robots:
        yield SCENE, base_of(layout.robot), frame.base
    for robot, shown in zip(layout.robots, frame.robots, strict=True):
        if math.isfinite(shown.age_s):
            yield SCENE, base_of(robot), shown.pose


def joints_of(names: Sequence[str], positions: Sequence[float], time: Time) -> JointStates:
    """The joints of a robot, rad."""
    named = zip(names, positions, strict=True)
    joints = [JointState(name=name, position=round(each, _DIGITS)) for name, each in named]
    return JointStates(timestamp=time, joints=joints)


class ShownBoxes:
    """The table and the objects as boxes; told anew only when another set of them can be seen."""

    def __init__(self, layout: Layout) -> None:
        self._layout = layout
        self._seen: frozenset[str] | None = None

    def update(self, frame: DecodedFrame, time: Time) -> SceneUpdate | None:
        """What has come and gone since the last moment; None where nothing has."""
        shown = zip(self._layout.objects, frame.objects, strict=True)
        seen = frozenset(each.name for each, at in shown if not (at.gone or at.hidden))
        before, self._seen = self._seen, seen
        if before == seen:
            return None
        entities = [
            _box(each, time)
            for each in self._layout.objects
            if each.name in seen - (before or frozenset())
        ]
        if before is None:
            entities.append(_table(self._layout, time))
        gone = [
            SceneEntityDeletion(timestamp=time, id=name)
            for name in sorted((before or frozenset()) - seen)
        ]
        return SceneUpdate(deletions=gone, entities=entities)


def _box(shown: ObjectLayout, time: Time) -> SceneEntity:
    cubes = [_cube(shown.size_m, 0.0, shown.color)]
    if shown.knob_m is not None:
        cubes.append(_cube(shown.knob_m, shown.size_m[2], shown.color))
    frame = frame_of(shown.name)
    return SceneEntity(timestamp=time, frame_id=frame, id=shown.name, cubes=cubes)


def _table(layout: Layout, time: Time) -> SceneEntity:
    table = layout.table
    x, y = table.center
    size = (*table.size_m, table.height_m)
    cube = _cube(size, 0.0, (0.6, 0.6, 0.6), (x, y))
    # A part may be called a table, but for the stroke.
    base = base_of(layout.robot)
    return SceneEntity(timestamp=time, frame_id=base, id=f"{layout.robot}/table", cubes=[cube])


def _cube(
    size_m: Triple, bottom_m: float, color: Triple, at: Sequence[float] = (0.0, 0.0)
) -> CubePrimitive:
    middle = Vector3(x=at[0], y=at[1], z=bottom_m + size_m[2] / 2)
    return CubePrimitive(
        pose=Pose(position=middle, orientation=_UNTURNED),
        size=Vector3(x=size_m[0], y=size_m[1], z=size_m[2]),
        color=Color(r=color[0], g=color[1], b=color[2]),
    )


def _transform(parent: str, child: str, pose: PoseOfFrame, time: Time) -> FrameTransform:
    x, y, z, qx, qy, qz, qw = (round(each, _DIGITS) for each in pose)
    return FrameTransform(
        timestamp=time,
        parent_frame_id=parent,
        child_frame_id=child,
        translation=Vector3(x=x, y=y, z=z),
        rotation=Quaternion(x=qx, y=qy, z=qz, w=qw),
    )
