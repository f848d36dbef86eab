"""The binary frames in which poses go to those who watch; docs/console_api.md has the format."""

import struct
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from mend.robots.link.messages import Poses
from mend.server.poses.bases import SeenBase

_HEAD = struct.Struct("<dIHH")
_LENGTH = struct.Struct("<I")
_OBJECT = struct.Struct("<7fI")
_BASE = struct.Struct("<8f")

HELD, GONE, HIDDEN = 1, 2, 4

Frame = bytes
"""One moment of a run, ready to be sent."""


def encode(number: int, time_s: float, poses: Poses, bases: Sequence[SeenBase] = ()) -> Frame:
    """One frame; `time_s` is of the run's clock, `bases` are those of the layout's robots."""
    joints, objects = poses.joints, poses.objects
    values: list[float] = [*joints, *poses.base, *poses.tool, poses.opening_m]
    head = _HEAD.pack(time_s, number & 0xFFFFFFFF, len(joints), len(objects))
    parts = [head, struct.pack(f"<{len(values)}f", *values)]
    for each in objects:
        flags = HELD * each.held | GONE * each.gone | HIDDEN * each.hidden
        parts.append(struct.pack("<7fI", *each.pose, flags))
    parts += [struct.pack("<8f", *each.pose, each.age_s) for each in bases]
    return b"".join(parts)


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
class DecodedFrame:
    """What `encode` was given."""

    time_s: float
    joints: Sequence[float]
    base: PoseOfFrame
    tool: PoseOfFrame
    opening_m: float
    objects: Sequence[DecodedObject]
    robots: Sequence[DecodedBase]


def decode(frame: Frame) -> DecodedFrame:
    """Read a frame. Raises `struct.error` for bytes that are none."""
    time_s, _, joints, objects = _HEAD.unpack_from(frame)
    values = struct.unpack_from(f"<{joints + 15}f", frame, _HEAD.size)
    at = _HEAD.size + 4 * (joints + 15)
    shown = [_OBJECT.unpack_from(frame, at + _OBJECT.size * n) for n in range(objects)]
    bases = _BASE.iter_unpack(frame[at + _OBJECT.size * objects :])
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
    )


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
