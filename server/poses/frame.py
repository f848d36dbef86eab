"""The binary frames in which poses go to those who watch; docs/console_api.md has the format."""

import struct
from collections.abc import Iterable, Iterator, Sequence

from mend.robots.link.messages import Poses
from mend.server.poses.bases import SeenBase

_HEAD = struct.Struct("<dIHH")
_LENGTH = struct.Struct("<I")

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
