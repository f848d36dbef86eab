"""Logs written as CSV, for reading them again."""

import csv
from pathlib import Path

import numpy as np

from mend.localization.logs.log import Log
from mend.localization.pose import compose

_ODOMETRY = ("odom_x", "odom_y", "odom_theta")
_REFERENCE = ("ref_x", "ref_y", "ref_theta")
_LASER = ("angle_min", "angle_increment", "max_range")
_SENSOR = ("sensor_x", "sensor_y", "sensor_theta")


def write_csv(log: Log, path: Path) -> None:
    """Write a log as CSV; metres with millimetres, radians with tenths of milliradians."""
    scan = log.steps[0].scan
    with_reference = all(each.reference is not None for each in log.steps)
    laser = (scan.angle_min, scan.angle_increment, scan.max_range)
    names = ["time_s", *_ODOMETRY, *(_REFERENCE if with_reference else ())]
    names += [f"r{beam}" for beam in range(len(scan.ranges))]
    with path.open("w", encoding="utf-8", newline="") as file:
        for name, value in zip(_LASER, laser, strict=True):
            file.write(f"# {name}={value:.9g}\n")
        if scan.sensor_offset.any():
            for name, value in zip(_SENSOR, scan.sensor_offset, strict=True):
                file.write(f"# {name}={value:.9g}\n")
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(names)
        odometry = np.zeros(3)
        for step in log.steps:
            odometry = compose(odometry, step.odometry)
            poses = [odometry] if step.reference is None else [odometry, step.reference]
            rows.writerow(
                [
                    f"{step.scan.time_s:.3f}",
                    *(f"{value:.4f}" for pose in poses for value in pose),
                    *(f"{value:.3f}" if np.isfinite(value) else "" for value in step.scan.ranges),
                ]
            )
