"""CARMEN logs: FLASER, ODOM and ROBOTLASER1 lines, raw or with corrected poses.

Corrected logs have a trap: after each scan their ODOM lines start anew from the corrected pose. So
a motion leads from the pose of one scan to the last ODOM line before the next scan, and never
from one ODOM line to another across a scan.
"""

from dataclasses import dataclass, field
from math import isfinite, pi
from pathlib import Path

import numpy as np

from mend.errors import WrongInputError
from mend.localization.logs.log import Log, LogStep, with_equal_beams
from mend.localization.logs.no_return import no_return_range
from mend.localization.logs.text_lines import numbered_lines
from mend.localization.pose import Poses, relative
from mend.localization.scan import InvalidScanError, Scan

_MAX_BEAMS = 100_000
_SAME = 1e-6
"""Metres and radians below which two written poses are one."""
_FLASER_TAIL = 7
"""What follows the ranges of a FLASER line at least: two poses and a time."""
_ROBOTLASER_HEAD = 8


@dataclass(frozen=True, slots=True, eq=False)
class _Sweep:
    ranges: list[float]
    angle_min: float
    angle_increment: float
    laser: Poses
    robot: Poses
    time_s: float
    odometry_before: Poses | None
    """Where the last ODOM line since the previous scan says that the robot was."""


@dataclass(slots=True)
class _CarmenContent:
    sweeps: list[_Sweep] = field(default_factory=list)
    odometry: Poses | None = None
    corrected: bool = False
    skipped: int = 0


def read_carmen(path: Path, *, corrected: bool | None = None) -> Log:
    """The log of a file, `.gz` or not. Raises `WrongInputError`, or `OSError`.

    `corrected` says whether the poses of the scans are references rather than odometry; None
    decides it by what mapping programs leave behind (NEFF lines, or a laser pose that wanders
    against the robot's odometry). Lines that are cut off or hold no numbers are skipped.
    """
    content = _CarmenContent()
    for _, line in numbered_lines(path):
        fields = line.split()
        if not fields:
            continue
        try:
            _take(fields, content)
        except (ValueError, IndexError):
            content.skipped += 1
    if not content.sweeps:
        raise WrongInputError(f"{path}: there is no scan (FLASER or ROBOTLASER1) in it")
    if corrected is None:
        corrected = content.corrected or _wanders(content.sweeps)
    return _log(path, content, corrected)


def _take(fields: list[str], content: _CarmenContent) -> None:
    match fields[0]:
        case "ODOM":
            content.odometry = _pose(fields[1:4])
        case "FLASER":
            count = _count(fields[1])
            ranges, tail = fields[2 : 2 + count], fields[2 + count :]
            if len(tail) < _FLASER_TAIL:
                raise ValueError("cut off")
            # 180 and 181 beams (or 360 and 361) are what the same half circle was sold as.
            increment = pi / (count - count % 2)
            _add(content, ranges, -pi / 2, increment, tail)
        case "ROBOTLASER1":
            count = _count(fields[_ROBOTLASER_HEAD])
            ranges = fields[_ROBOTLASER_HEAD + 1 : _ROBOTLASER_HEAD + 1 + count]
            rest = fields[_ROBOTLASER_HEAD + 1 + count :]
            rest = rest[1 + int(rest[0]) :]
            if len(rest) < 12:
                raise ValueError("cut off")
            start, increment = float(fields[2]), float(fields[4])
            _add(content, ranges, start, increment, [*rest[:6], rest[11]])
        case "NEFF":
            content.corrected = True
        case _:
            pass


def _add(
    content: _CarmenContent, ranges: list[str], angle_min: float, increment: float, tail: list[str]
) -> None:
    time_s = float(tail[6])
    if not isfinite(time_s):
        raise ValueError("no time")
    sweep = _Sweep(
        [float(each) for each in ranges],
        angle_min,
        increment,
        _pose(tail[:3]),
        _pose(tail[3:6]),
        time_s,
        content.odometry,
    )
    content.sweeps.append(sweep)
    content.odometry = None


def _count(field_text: str) -> int:
    count = int(field_text)
    if not 2 <= count <= _MAX_BEAMS:
        raise ValueError("no count of beams")
    return count


def _pose(fields: list[str]) -> Poses:
    pose = np.array([float(each) for each in fields])
    if pose.shape != (3,) or not np.isfinite(pose).all():
        raise ValueError("no pose")
    return pose


def _wanders(sweeps: list[_Sweep]) -> bool:
    """Whether the laser moves against the robot: one of the two poses was corrected."""
    mounts = np.array([relative(each.robot, each.laser) for each in sweeps])
    return bool((np.abs(mounts - mounts[0])[:, :2] > 0.01).any())


def _log(path: Path, content: _CarmenContent, corrected: bool) -> Log:
    sweeps = content.sweeps
    no_return = no_return_range(each.ranges for each in sweeps)
    steps: list[LogStep] = []
    skipped = content.skipped
    previous: _Sweep | None = None
    time_s = -np.inf
    for sweep in sweeps:
        # Clocks of some robots were set while they drove; the order of the lines is what counts.
        time_s = max(time_s, sweep.time_s)
        mount = np.zeros(3) if corrected else relative(sweep.robot, sweep.laser)
        try:
            scan = Scan(
                np.array(sweep.ranges),
                sweep.angle_min,
                sweep.angle_increment,
                no_return,
                time_s,
                mount,
            )
        except InvalidScanError:
            skipped += 1
            continue
        motion = np.zeros(3) if previous is None else _motion(previous, sweep, corrected)
        steps.append(LogStep(motion, scan, sweep.laser if corrected else None))
        previous = sweep
    if not steps:
        raise WrongInputError(f"{path}: none of its {len(sweeps)} scans can be used")
    kept = with_equal_beams(steps)
    return Log(path.name.split(".")[0], kept, skipped + len(steps) - len(kept))


def _motion(previous: _Sweep, sweep: _Sweep, corrected: bool) -> Poses:
    if not corrected or np.abs(sweep.robot - sweep.laser).max() > _SAME:
        return relative(previous.robot, sweep.robot)
    if sweep.odometry_before is None:
        return relative(previous.laser, sweep.laser)
    return relative(previous.laser, sweep.odometry_before)
