"""Where the robots of a fleet have been: a frame of poses as one of them moves."""

import math
from collections.abc import Mapping

from mend.robots.link.messages import IDENTITY, Poses, PoseValues
from mend.server.poses.bases import Bases
from mend.server.poses.frame import encode
from mend.server.poses.record import PoseRecord
from mend.tasks.frames import Frame

EVERY_S = 0.5
"""Of the site's clock: frames come no more often."""
STILL_EVERY_S = 5.0
"""So often they come while nobody moves, so that it is known who was there."""
MOVED_M = 0.02
MOVED_RAD = 0.05


class FleetTrack:
    """Adds to the record of one site; its frames have the robots in the order of `frames`."""

    def __init__(self, frames: Mapping[str, Frame], record: PoseRecord, since_s: float) -> None:
        """`since_s`: what was before is recorded already, -inf where nothing is."""
        self._robots = list(frames)
        self._record = record
        self._bases = Bases(frames)
        self._last_s = since_s
        self._kept: dict[str, PoseValues] = {}
        self._number = 0

    def take(self, robot: str, poses: Poses) -> None:
        """A robot says where it is, in its frame and by the site's clock."""
        self._bases.take(robot, poses.time, poses.base)
        here = self._bases.of(robot)
        assert here is not None, "it was just taken"
        since_s = poses.time - self._last_s
        if since_s < EVERY_S or (since_s < STILL_EVERY_S and not self._has_moved(robot, here)):
            return
        self._last_s = poses.time
        self._kept = {each: at for each in self._robots if (at := self._bases.of(each))}
        empty = Poses(time=poses.time, tool=IDENTITY, opening_m=0.0)
        bases = self._bases.at(poses.time, self._robots)
        self._record.add(encode(self._number, poses.time, empty, bases))
        self._number += 1

    def _has_moved(self, robot: str, here: PoseValues) -> bool:
        kept = self._kept.get(robot)
        if kept is None:
            return True
        cosine = abs(sum(a * b for a, b in zip(kept[3:], here[3:], strict=True)))
        turned = 2.0 * math.acos(min(1.0, cosine))
        return math.dist(kept[:3], here[:3]) > MOVED_M or turned > MOVED_RAD
