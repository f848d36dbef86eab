"""MRPT's particle filter: a log and a map go to its programs, its poses come back.

It is not tuned to the logs, and how noisy it takes odometry to be is set by its converter alone.
"""

import re
import shutil
import subprocess
import tempfile
from collections.abc import Callable
from math import degrees, pi
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from mend.localization.evaluation import Trace
from mend.localization.logs.log import Log
from mend.localization.pose import compose
from mend.maps.vector_map import VectorMap

PROGRAMS = ("carmen2rawlog", "image2gridmap", "pf-localization")
MISSING = "MRPT is left out: it is not installed (apt-get install mrpt-apps mrpt-common)"

PARTICLES = 2000
CELL_M = 0.05
MARGIN_M = 2.0
NOTHING_M = 81.9
"""What a range that did not come back is written as: the format's customary largest."""
TIMEOUT_S = 3600

_POSE = re.compile(r"PDF estimation: \(([-\d.e+]+),([-\d.e+]+),([-\d.e+]+)deg\)")
_TOOK = re.compile(r"Done in ([\d.]+)(s|ms|us)")
_UNIT_S = {"s": 1.0, "ms": 1e-3, "us": 1e-6}

Matrix = NDArray[np.float64]
Run = Callable[..., str]


class MrptError(Exception):
    """MRPT cannot follow this log, or said nothing about it."""


def installed() -> bool:
    """Whether all of its programs are here."""
    return all(shutil.which(each) for each in PROGRAMS)


def mrpt_trace(vector_map: VectorMap, log: Log, run: Run | None = None) -> Trace:
    """Its pose after each scan, from the log's start. Raises `MrptError`.

    `run` calls a program in a folder and returns what it printed.
    """
    if log.start is None or abs(_field_of_view(log) - pi) > 0.05:
        raise MrptError(f"{log.name}: MRPT is given half circles from a known start alone")
    call = run or _run
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        _write_carmen(log, folder / "drive.log")
        origin = _write_picture(vector_map, folder / "map.png")
        call(folder, "carmen2rawlog", "-i", "drive.log", "-o", "drive.rawlog", "-w", "-q")
        call(folder, "image2gridmap", "-w", "-i", "map.png", "-o", "map.gridmap.gz",
             "-r", str(CELL_M), "--px", str(origin[0]), "--py", str(origin[1]))  # fmt: skip
        (folder / "drive.ini").write_text(_settings(log.start))
        said = call(folder, "pf-localization", "drive.ini")
    return _trace(said, log)


def _trace(said: str, log: Log) -> Trace:
    poses = np.array([[float(each) for each in found] for found in _POSE.findall(said)])
    durations_s = np.array([float(number) * _UNIT_S[unit] for number, unit in _TOOK.findall(said)])
    if len(poses) != len(log) or len(durations_s) != len(log):
        raise MrptError(f"{log.name}: MRPT told {len(poses)} poses of {len(log)}: {said[-300:]}")
    poses[:, 2] = np.radians(poses[:, 2])
    silent = np.zeros(len(log))
    return Trace(poses, log.references, silent, silent.astype(bool), durations_s, ())


def _field_of_view(log: Log) -> float:
    scan = log.steps[0].scan
    return scan.angle_increment * (len(scan.ranges) - len(scan.ranges) % 2)


def _run(folder: Path, *command: str) -> str:
    done = subprocess.run(
        command, cwd=folder, capture_output=True, text=True, timeout=TIMEOUT_S, check=False
    )
    said = done.stdout + done.stderr
    if done.returncode:
        raise MrptError(f"{command[0]} ended with {done.returncode}: {said[-300:].strip()}")
    return said


def _write_carmen(log: Log, path: Path) -> None:
    """Scans with odometry alone: the references are not for MRPT."""
    odometry = np.zeros(3)
    with path.open("w") as file:
        for step in log.steps:
            odometry = compose(odometry, step.odometry)
            ranges = np.where(np.isfinite(step.scan.ranges), step.scan.ranges, NOTHING_M)
            pose = " ".join(f"{value:.6f}" for value in odometry)
            scan = " ".join(f"{value:.2f}" for value in ranges)
            time_s = f"{step.scan.time_s:.6f}"
            # MRPT takes motions from ODOM lines alone.
            file.write(f"ODOM {pose} 0 0 0 {time_s} mend {time_s}\n")
            file.write(f"FLASER {len(ranges)} {scan} {pose} {pose} {time_s} mend {time_s}\n")


def _write_picture(vector_map: VectorMap, path: Path) -> tuple[int, int]:
    """Draw the map; returns the pixel (from the left, from below) of its origin."""
    x_min, y_min, x_max, y_max = vector_map.bounds
    # An origin outside the picture would shift the map without a word.
    corner = np.minimum([x_min, y_min], 0.0) - MARGIN_M
    far = np.maximum([x_max, y_max], 0.0) + MARGIN_M
    width, height = np.ceil((far - corner) / CELL_M).astype(int)
    picture = np.full((height, width), 255, dtype=np.uint8)
    ends = np.round((vector_map.segments.reshape(-1, 2) - corner) / CELL_M).astype(np.int32)
    cv2.polylines(picture, list(ends.reshape(-1, 2, 2)), False, 0, 1)
    cv2.imwrite(str(path), picture[::-1])
    return round(-corner[0] / CELL_M), round(-corner[1] / CELL_M)


def _settings(start: Matrix) -> str:
    """A fixed number of particles around the start, and MRPT's likelihood field."""
    x, y, heading = start[0], start[1], degrees(start[2])
    return f"""
[KLD_options]
KLD_binSize_PHI_deg=10
KLD_binSize_XY=0.10
KLD_delta=0.01
KLD_epsilon=0.01
KLD_maxSampleSize={PARTICLES}
KLD_minSampleSize={PARTICLES}
KLD_minSamplesPerBin=0

[PF_options]
resamplingMethod=3
BETA=0.50
sampleSize=1
PF_algorithm=0
adaptiveSampleSize=0

[DummyOdometryParams]
minStdXY=0.02
minStdPHI=0.5

[LocalizationExperiment]
rawlog_file=drive.rawlog
map_file=map.gridmap.gz
rawlog_offset=0
logOutput_dir=out
particles_count={PARTICLES}
experimentRepetitions=1
init_PDF_mode=1
init_PDF_min_x={x - 0.2:.4f}
init_PDF_max_x={x + 0.2:.4f}
init_PDF_min_y={y - 0.2:.4f}
init_PDF_max_y={y + 0.2:.4f}
init_PDF_min_yaw_deg={heading - 4.0:.4f}
init_PDF_max_yaw_deg={heading + 4.0:.4f}
SHOW_PROGRESS_3D_REAL_TIME=false
3DSceneFrequency=1000000
SAVE_STATS_ONLY=false

[MetricMap]
occupancyGrid_count=1
gasGrid_count=0
landmarksMap_count=0
pointsMap_count=0
beaconMap_count=0
likelihoodMapSelection=-1
enableInsertion_pointsMap=1
enableInsertion_gasGridMaps=1
enableInsertion_landmarksMap=1
enableInsertion_beaconMap=1

[MetricMap_occupancyGrid_00_likelihoodOpts]
likelihoodMethod=4
LF_decimation=5
LF_stdHit=0.10
LF_maxCorrsDistance=0.30
LF_zHit=0.80
LF_zRandom=0.20
LF_maxRange=80
LF_alternateAverageMethod=0
MI_exponent=10
MI_skip_rays=10
MI_ratio_max_distance=2

[MetricMap_occupancyGrid_00_insertOpts]
mapAltitude=0
useMapAltitude=0
maxDistanceInsertion=15
maxOccupancyUpdateCertainty=0.55
considerInvalidRangesAsFreeSpace=1
minLaserScanNoiseStd=0.001
"""
