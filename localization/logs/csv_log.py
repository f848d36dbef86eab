"""Logs as CSV: one scan per row, odometry as a pose that drifts, a reference where there is one.

The first lines say how the laser sits, each as `# name=value`: `angle_min` and
`angle_increment` (radians), `max_range` (metres), and if it is not in the robot's middle
`sensor_x`, `sensor_y`, `sensor_theta`. Then a row of names: `time_s, odom_x, odom_y, odom_theta`,
if known `ref_x, ref_y, ref_theta`, and one column per beam. Empty and `inf` mean that nothing came
back.
"""

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from mend.errors import WrongInputError
from mend.localization.logs.log import Log, LogStep
from mend.localization.logs.text_lines import numbered_lines
from mend.localization.pose import Poses, relative
from mend.localization.scan import InvalidScanError, Scan

_ODOMETRY = ("odom_x", "odom_y", "odom_theta")
_REFERENCE = ("ref_x", "ref_y", "ref_theta")
_LASER = ("angle_min", "angle_increment", "max_range")
_SENSOR = ("sensor_x", "sensor_y", "sensor_theta")
_MAX_TOLD = 10


@dataclass(slots=True)
class _CsvContent:
    laser: dict[str, float] = field(default_factory=dict)
    names: list[str] | None = None
    rows: list[tuple[int, list[str]]] = field(default_factory=list)
    mistakes: list[str] = field(default_factory=list)


def read_csv(path: Path) -> Log:
    """The log of a file, `.gz` or not. Raises `WrongInputError` with line numbers, or `OSError`."""
    content = _CsvContent()
    for number, line in numbered_lines(path):
        _take(number, line.lstrip("\ufeff"), content, path)
    names = content.names
    missing = [name for name in _LASER if name not in content.laser]
    missing += [name for name in ("time_s", *_ODOMETRY) if names is None or name not in names]
    if missing or names is None:
        raise WrongInputError(
            "\n".join([*content.mistakes, f"{path}: {', '.join(missing)} missing"])
        )
    steps = _steps(content, names, path)
    if content.mistakes:
        raise WrongInputError("\n".join(content.mistakes[:_MAX_TOLD]))
    if not steps:
        raise WrongInputError(f"{path}: there is no scan in it")
    return Log(path.name.split(".")[0], tuple(steps))


def _take(number: int, line: str, content: _CsvContent, path: Path) -> None:
    if not line:
        return
    if line.startswith("#"):
        name, found, value = line[1:].partition("=")
        if found and name.strip() in (*_LASER, *_SENSOR):
            try:
                content.laser[name.strip()] = float(value)
            except ValueError:
                content.mistakes.append(f"{path}:{number}: '{value.strip()}' is not a number")
        return
    fields = [each.strip() for each in next(csv.reader([line]))]
    if content.names is None:
        content.names = fields
    else:
        content.rows.append((number, fields))


def _steps(content: _CsvContent, names: list[str], path: Path) -> list[LogStep]:
    known = {"time_s", *_ODOMETRY, *_REFERENCE}
    beams = [(place, name) for place, name in enumerate(names) if name not in known]
    with_reference = all(name in names for name in _REFERENCE)
    offset = np.array([content.laser.get(name, 0.0) for name in _SENSOR])
    angle_min, angle_increment, max_range = (content.laser[name] for name in _LASER)
    steps: list[LogStep] = []
    before: Poses | None = None
    for number, fields in content.rows:
        try:
            if len(fields) != len(names):
                raise ValueError(f"expected {len(names)} columns, found {len(fields)}")
            row = dict(zip(names, fields, strict=True))
            odometry = _pose(row, _ODOMETRY)
            ranges = np.array([_number(name, fields[at] or "inf") for at, name in beams])
            time_s = _number("time_s", row["time_s"])
            scan = Scan(ranges, angle_min, angle_increment, max_range, time_s, offset)
            reference = _pose(row, _REFERENCE) if with_reference else None
        except (ValueError, InvalidScanError) as error:
            content.mistakes.append(f"{path}:{number}: {error}")
            continue
        motion = np.zeros(3) if before is None else relative(before, odometry)
        steps.append(LogStep(motion, scan, reference))
        before = odometry
    return steps


def _pose(row: Mapping[str, str], names: Sequence[str]) -> Poses:
    pose = np.array([_number(name, row[name]) for name in names])
    if not np.isfinite(pose).all():
        raise ValueError(f"{', '.join(names)} have to be finite")
    return pose


def _number(column: str, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise ValueError(f"{column} has to be a number, which '{text[:40]}' is not") from None
