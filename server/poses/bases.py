"""Where the robots of a run are that drive, in the scene's frame."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from mend.robots.link.messages import IDENTITY, PoseValues
from mend.tasks.frames import Frame


@dataclass(frozen=True, slots=True)
class SeenBase:
    """A robot's base frame in the scene's, and how old that is.

    `age_s`: of the run's clock; inf of a robot that has not shown where it is. `covariance`: of
    its place along the axes of its map, xx, xy, yy (m2); None where it does not tell.
    """

    pose: PoseValues
    age_s: float
    covariance: Sequence[float] | None = None


NEVER_SEEN = SeenBase(IDENTITY, math.inf)


class Bases:
    """The newest base of each robot; `frames` are those in which robots tell theirs."""

    def __init__(self, frames: Mapping[str, Frame]) -> None:
        self._frames = frames
        self._seen: dict[str, tuple[float, PoseValues]] = {}

    def take(self, robot: str, time_s: float, base: PoseValues) -> None:
        """What a robot of the run has told; `time_s` is of the run's clock."""
        self._seen[robot] = time_s, in_scene(self._frames[robot], base)

    def of(self, robot: str) -> PoseValues | None:
        """The newest one of a robot."""
        return self._seen[robot][1] if robot in self._seen else None

    def at(self, time_s: float, robots: Sequence[str]) -> list[SeenBase]:
        """Those of some robots, as they are known at a time."""
        seen = [self._seen.get(each) for each in robots]
        return [
            NEVER_SEEN if each is None else SeenBase(each[1], max(0.0, time_s - each[0]))
            for each in seen
        ]


def in_scene(frame: Frame, pose: PoseValues) -> PoseValues:
    """A pose of a robot's frame in the scene's; heights are the same in both."""
    sine, cosine = math.sin(frame.yaw / 2), math.cos(frame.yaw / 2)
    return joined((*frame.to_scene(0.0, 0.0), 0.0, 0.0, 0.0, sine, cosine), pose)


def joined(frame: PoseValues, pose: PoseValues) -> PoseValues:
    """A pose that is given in a frame, in that in which the frame is given."""
    x, y, z = _turned(frame[3:], pose[:3])
    return (frame[0] + x, frame[1] + y, frame[2] + z, *_product(frame[3:], pose[3:]))


def seen_from(frame: PoseValues, pose: PoseValues) -> PoseValues:
    """A pose in a frame, where both are given in the same one."""
    back = (-frame[3], -frame[4], -frame[5], frame[6])
    away = (pose[0] - frame[0], pose[1] - frame[1], pose[2] - frame[2])
    return (*_turned(back, away), *_product(back, pose[3:]))


_Vector = tuple[float, float, float]
_Quaternion = tuple[float, float, float, float]


def _turned(by: _Quaternion, vector: _Vector) -> _Vector:
    back = (-by[0], -by[1], -by[2], by[3])
    x, y, z, _ = _product(_product(by, (*vector, 0.0)), back)
    return x, y, z


def _product(a: _Quaternion, b: _Quaternion) -> _Quaternion:
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )
