"""Wean Hall logs: `L` lines (pose, laser pose, 180 ranges, time) and `O` lines, in centimetres."""

from math import radians
from pathlib import Path

import numpy as np

from mend.errors import WrongInputError
from mend.localization.logs.log import Log, LogStep
from mend.localization.logs.no_return import no_return_range
from mend.localization.logs.text_lines import numbered_lines
from mend.localization.pose import Poses, relative
from mend.localization.scan import Scan

_BEAMS = 180
_FIELDS = 3 + 3 + _BEAMS + 1
_CM = np.array([0.01, 0.01, 1.0])


def read_wean(path: Path) -> Log:
    """The log of a file: raw odometry, no reference. Raises `WrongInputError`, or `OSError`."""
    sweeps: list[tuple[Poses, Poses, np.ndarray, float]] = []
    skipped = 0
    for _, line in numbered_lines(path):
        fields = line.split()
        if not fields or fields[0] != "L":
            continue
        try:
            values = np.array(fields[1:], dtype=np.float64)
        except ValueError:
            skipped += 1
            continue
        if len(values) != _FIELDS or not np.isfinite(values).all():
            skipped += 1
            continue
        robot, laser = values[:3] * _CM, values[3:6] * _CM
        sweeps.append((robot, laser, values[6:-1] * 0.01, float(values[-1])))
    if not sweeps:
        raise WrongInputError(f"{path}: there is no scan (a line L with {_FIELDS} numbers) in it")
    no_return = no_return_range([each[2].tolist() for each in sweeps])
    steps: list[LogStep] = []
    before, time_s = sweeps[0][0], -np.inf
    for robot, laser, ranges, written_s in sweeps:
        time_s = max(time_s, written_s)
        mount = relative(robot, laser)
        scan = Scan(ranges, radians(-90.0), radians(1.0), no_return, time_s, mount)
        steps.append(LogStep(relative(before, robot), scan))
        before = robot
    return Log(path.name.split(".")[0], tuple(steps), skipped)
