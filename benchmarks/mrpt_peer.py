"""MRPT's particle filter as a peer: a log and a map go to its programs, its poses come back.

Its settings for noise and sensor are near those of its demo. They were not tuned.
"""

import re
import resource
import shutil
import subprocess
import tempfile
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from maps.vector_map import VectorMap
from robots.localization.evaluation import Trace
from robots.localization.logs.log import Log
from robots.localization.pose import compose

PROGRAMS = ("carmen2rawlog", "image2gridmap", "pf-localization")
MISSING = "MRPT is not installed (apt-get install mrpt-apps mrpt-common), so it is left out."
PARTICLES = 2000
CELL_M = 0.05
MARGIN_M = 2.0
TIMEOUT_S = 3600
POSE = re.compile(
    r"PDF estimation: \(\s*([-\d.e+]+)\s*,\s*([-\d.e+]+)\s*,\s*([-\d.e+]+)\s*(?:deg|º)?\s*\)"
)


def installed() -> bool:
    """Whether all of its programs are here."""
    return all(shutil.which(each) for each in PROGRAMS)


def mrpt_poses(vector_map: VectorMap, log: Log) -> NDArray[np.float64]:
    """Its pose after each scan. Raises `RuntimeError` where it fails or says nothing."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        _write_carmen(log, folder / "drive.log")
        _write_grid(vector_map, folder)
        _run(folder, "carmen2rawlog", "-i", "drive.log", "-o", "drive.rawlog", "-w", "-q")
        assert log.start is not None
        (folder / "drive.ini").write_text(_settings(log.start))
        said = _run(folder, "pf-localization", "drive.ini")
    found = [[float(each) for each in match] for match in POSE.findall(said)]
    if not found:
        raise RuntimeError("pf-localization printed no estimate")
    poses = np.array(found)
    poses[:, 2] = np.radians(poses[:, 2])
    # One estimate per scan; what comes before the first motion may be missing.
    missing = max(len(log) - len(poses), 0)
    return np.vstack((np.tile(log.start, (missing, 1)), poses))[-len(log) :]


def mrpt_trace(vector_map: VectorMap, log: Log) -> Trace:
    """Its drive, each update at the mean of its processor time. Raises `RuntimeError`."""
    began_s = _children_s()
    poses = mrpt_poses(vector_map, log)
    durations = np.full(len(log), (_children_s() - began_s) / len(log))
    nothing = np.zeros(len(log))
    return Trace(poses, log.references, nothing, nothing.astype(bool), durations, ())


def _children_s() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _run(folder: Path, *command: str) -> str:
    done = subprocess.run(
        command, cwd=folder, capture_output=True, text=True, timeout=TIMEOUT_S, check=False
    )
    said = done.stdout + done.stderr
    if done.returncode:
        raise RuntimeError(f"{command[0]} ended with {done.returncode}: {said[-200:].strip()}")
    return said


def _write_carmen(log: Log, path: Path) -> None:
    """Scans with odometry alone: MRPT must not see the references."""
    odometry = np.zeros(3)
    with path.open("w") as file:
        for step in log.steps:
            odometry = compose(odometry, step.odometry)
            ranges = np.where(np.isfinite(step.scan.ranges), step.scan.ranges, 81.9)
            pose = " ".join(f"{value:.6f}" for value in odometry)
            scan = " ".join(f"{value:.2f}" for value in ranges)
            time_s = f"{step.scan.time_s:.6f}"
            # Its motions come from ODOM lines alone.
            file.write(f"ODOM {pose} 0 0 0 {time_s} mend {time_s}\n")
            file.write(f"FLASER {len(ranges)} {scan} {pose} {pose} {time_s} mend {time_s}\n")


def _write_grid(vector_map: VectorMap, folder: Path) -> None:
    x_min, y_min, x_max, y_max = vector_map.bounds
    # The origin has to lie inside the picture: a negative one would shift the map silently.
    corner = np.minimum([x_min, y_min], 0.0) - MARGIN_M
    far = np.maximum([x_max, y_max], 0.0) + MARGIN_M
    width, height = np.ceil((far - corner) / CELL_M).astype(int)
    picture = np.full((height, width), 255, dtype=np.uint8)
    ends = np.round((vector_map.segments.reshape(-1, 2) - corner) / CELL_M).astype(np.int32)
    cv2.polylines(picture, list(ends.reshape(-1, 2, 2)), False, 0, 1)
    cv2.imwrite(str(folder / "map.png"), picture[::-1])
    x, y = -corner / CELL_M
    _run(
        folder,
        *("image2gridmap", "-w", "-i", "map.png", "-o", "map.gridmap.gz"),
        *("-r", str(CELL_M), "--px", f"{x:.0f}", "--py", f"{y:.0f}"),
    )


def _settings(start: NDArray[np.float64]) -> str:
    x, y, theta = start
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
init_PDF_min_yaw_deg={np.degrees(theta) - 4.0:.4f}
init_PDF_max_yaw_deg={np.degrees(theta) + 4.0:.4f}
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
