"""The binary frames in which poses go to those who watch; docs/console_api.md has the format."""

import struct
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from mend.robots.link.messages import Poses
from mend.server.poses.arms import SeenArm
from mend.server.poses.bases import SeenBase

_HEAD = struct.Struct("<dIHH")
_LENGTH = struct.Struct("<I")
_OBJECT = struct.Struct("<7fI")
_BASE = struct.Struct("<8f")
_ARM = struct.Struct("<HH16f")
_ARMS_END = struct.Struct("<I4s")
_ARMS = b"ARMS"
"""Ends a frame that has other arms; as the age of a base it would be some 28,000 years."""

HELD, GONE, HIDDEN = 1, 2, 4

Frame = bytes
"""One moment of a run, ready to be sent."""


def encode(
    number: int,
    time_s: float,
    poses: Poses,
    bases: Sequence[SeenBase] = (),
    arms: Sequence[SeenArm] = (),
) -> Frame:
    """One frame; `time_s` is of the run's clock, `bases` are those of the layout's robots.

    `arms`: those of its arms that have been told of.
    """
    joints, objects = poses.joints, poses.objects
    values: list[float] = [*joints, *poses.base, *poses.tool, poses.opening_m]
    head = _HEAD.pack(time_s, number & 0xFFFFFFFF, len(joints), len(objects))
    parts = [head, struct.pack(f"<{len(values)}f", *values)]
    for each in objects:
        flags = HELD * each.held | GONE * each.gone | HIDDEN * each.hidden
        parts.append(struct.pack("<7fI", *each.pose, flags))
    parts += [_BASE.pack(*each.pose, each.age_s) for each in bases]
    told = b"".join(_encoded(each) for each in arms)
    if told:
        parts += [told, _ARMS_END.pack(len(told), _ARMS)]
    return b"".join(parts)


def _encoded(arm: SeenArm) -> bytes:
    poses = arm.poses
    joints = len(poses.joints)
    values = (*arm.base, *poses.tool, poses.opening_m, arm.age_s)
    return _ARM.pack(arm.number, joints, *values) + struct.pack(f"<{joints}f", *poses.joints)


def time_of(frame: Frame) -> float:
    """The run's clock, as a frame has it."""
    time_s: float = _HEAD.unpack_from(frame)[0]
    return time_s


PoseOfFrame = tuple[float, ...]
"""x, y, z (m), qx, qy, qz, qw, as a frame has them."""


@dataclass(frozen=True, slots=True)
class DecodedObject:
    """An object of a frame, its pose in the robot's base frame."""

    pose: PoseOfFrame
    held: bool
    gone: bool
    hidden: bool


@dataclass(frozen=True, slots=True)
class DecodedBase:
    """A robot's base in the scene's frame; `age_s` is infinite where it is not known."""

    pose: PoseOfFrame
    age_s: float


@dataclass(frozen=True, slots=True)
class DecodedArm:
    """Another robot's arm, by its place among the layout's `arms`.

    Its base is in the base frame of the layout's robot, and its tool in its own.
    """

    number: int
    base: PoseOfFrame
    tool: PoseOfFrame
    opening_m: float
    age_s: float
    joints: Sequence[float]


@dataclass(frozen=True, slots=True)
class DecodedFrame:
    """What `encode` was given."""

    time_s: float
    joints: Sequence[float]
    base: PoseOfFrame
    tool: PoseOfFrame
    opening_m: float
    objects: Sequence[DecodedObject]
    robots: Sequence[DecodedBase]
    arms: Sequence[DecodedArm]


def decode(frame: Frame) -> DecodedFrame:
    """Read a frame. Raises `struct.error` for bytes that are none."""
    time_s, _, joints, objects = _HEAD.unpack_from(frame)
    values = struct.unpack_from(f"<{joints + 15}f", frame, _HEAD.size)
    at = _HEAD.size + 4 * (joints + 15)
    shown = [_OBJECT.unpack_from(frame, at + _OBJECT.size * n) for n in range(objects)]
    end = len(frame) - _arms_bytes(frame)
    bases = _BASE.iter_unpack(frame[at + _OBJECT.size * objects : end])
    return DecodedFrame(
        time_s,
        values[:joints],
        values[joints : joints + 7],
        values[joints + 7 : joints + 14],
        values[joints + 14],
        [
            DecodedObject(pose, bool(flags & HELD), bool(flags & GONE), bool(flags & HIDDEN))
            for *pose_values, flags in shown
            for pose in [tuple(pose_values)]
        ],
        [DecodedBase(tuple(pose_values), age_s) for *pose_values, age_s in bases],
        list(_arms_from(frame, end)),
    )


def _arms_bytes(frame: Frame) -> int:
    """How many of the last bytes tell of other arms."""
    length, mark = _ARMS_END.unpack_from(frame, len(frame) - _ARMS_END.size)
    return length + _ARMS_END.size if mark == _ARMS else 0


def _arms_from(frame: Frame, at: int) -> Iterator[DecodedArm]:
    while at < len(frame) - _ARMS_END.size:
        number, joints, *values = _ARM.unpack_from(frame, at)
        at += _ARM.size
        angles = struct.unpack_from(f"<{joints}f", frame, at)
        at += 4 * joints
        base, tool = tuple(values[:7]), tuple(values[7:14])
        yield DecodedArm(number, base, tool, values[14], values[15], angles)


def framed(frames: Iterable[Frame]) -> bytes:
    """Frames one after the other, each after its length."""
    return b"".join(part for each in frames for part in (_LENGTH.pack(len(each)), each))


def unframed(data: bytes) -> Iterator[Frame]:
    """The frames in what `framed` made; a torn one at the end is left out."""
    at = 0
    while at + _LENGTH.size <= len(data):
        (length,) = _LENGTH.unpack_from(data, at)
        at += _LENGTH.size
        if length < _HEAD.size or at + length > len(data):
            return
        yield data[at : at + length]
        at += length
