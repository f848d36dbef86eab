"""Speed: the ray cast against the plain way, updates with 271 beams, memory of a long run.

python benchmarks/localization_speed.py [--maps FOLDER] [--map GHC4] [--updates 600]
    [--explained 0.45] [--quick] [--hours 8]

With --hours, EnML drives to and fro over the made-up floor for so long (a scan every 2 s of the
floor's time), and its resident memory is told every hour.
"""

# ruff: noqa: T201
import argparse
import os
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import psutil
from numpy.typing import NDArray
from synthetic.settings import SceneSettings
from synthetic.world import Scene, scene

from mend.localization.evaluation import follow
from mend.localization.localizer import Estimate, Timed
from mend.localization.logs.log import LogStep
from mend.localization.methods import METHODS, warm_up
from mend.localization.pose import relative
from mend.maps.ray_cast import cast
from mend.maps.segment_grid import cast_rays, segment_grid
from mend.maps.vector_map import VectorMap
from mend.maps.vector_map_file import read_vector_map

DATA = Path(os.environ.get("BENCH_DATA", Path(__file__).parents[2] / "shared/data"))
Matrix = NDArray[np.float64]
RAYS = 1000
RANGE_M = 30.0
STEP_M = 0.1
SCAN_EVERY_S = 2.0
LONG_RUN_EVERY = 4
"""A scan each 0.4 m: a slow robot."""


def plain_cast(segments: Matrix, x: float, y: float, angles: Matrix) -> Matrix:
    """Every ray on every segment, vectorised: the ranges."""
    directions = np.column_stack((np.cos(angles), np.sin(angles)))
    starts, edges = segments[:, :2] - (x, y), segments[:, 2:] - segments[:, :2]
    with np.errstate(all="ignore"):
        across = directions[:, :1] * edges[:, 1] - directions[:, 1:] * edges[:, 0]
        ranges = (starts[:, 0] * edges[:, 1] - starts[:, 1] * edges[:, 0]) / across
        shares = (starts[:, 0] * directions[:, 1:] - starts[:, 1] * directions[:, :1]) / across
    hit = (ranges > 0.0) & (shares >= 0.0) & (shares <= 1.0)
    nearest: Matrix = np.where(hit, ranges, RANGE_M).min(axis=1)
    return np.minimum(nearest, RANGE_M)


def median_ms(work: Callable[[], object], times: int) -> float:
    """Processor time of one call, after one that does not count."""
    work()
    taken = []
    for _ in range(times):
        began = time.process_time()
        work()
        taken.append(time.process_time() - began)
    return 1e3 * float(np.median(taken))


def to_and_fro(made_up: Scene, every: int, count: int) -> Iterator[LogStep]:
    """A drive back and forth over every so-manieth place of another, with what was seen there."""
    steps, truth = made_up.log.steps[::every], made_up.truth[::every]
    there_and_back = [*range(len(steps)), *range(len(steps) - 2, 0, -1)]
    before = truth[0]
    for number in range(count):
        at = there_and_back[number % len(there_and_back)]
        scan = replace(steps[at].scan, time_s=SCAN_EVERY_S * number)
        yield LogStep(relative(before, truth[at]), scan, truth[at])
        before = truth[at]


def long_run(vector_map: VectorMap, made_up: Scene, hours: int) -> None:
    """Resident memory of EnML over so many hours."""
    localizer = METHODS["enml"](vector_map, 1)
    localizer.reset(made_up.truth[0])
    process = psutil.Process()
    hourly = round(3600 / SCAN_EVERY_S)
    resident, errors = [], []
    for number, step in enumerate(to_and_fro(made_up, LONG_RUN_EVERY, hours * hourly)):
        estimate = localizer.update(step.odometry, step.scan)
        assert step.reference is not None
        errors.append(np.hypot(*(estimate.pose - step.reference)[:2]))
        if number % hourly == hourly - 1:
            resident.append(process.memory_info().rss / 2**20)
    told = ", ".join(f"{each:.1f}" for each in resident)
    print(
        f"enml  {hours} h, {len(errors)} updates, median error {np.median(errors):.3f} m, largest "
        f"{max(errors):.2f} m; resident after each hour: {told} MB"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--maps", type=Path, default=DATA / "localization/maps")
    parser.add_argument("--map", default="GHC4")
    parser.add_argument("--updates", type=int, default=600)
    parser.add_argument("--explained", type=float, default=0.45)
    parser.add_argument("--quick", action="store_true", help="100 updates")
    parser.add_argument("--hours", type=int, default=0, help="a long run of so many hours too")
    given = parser.parse_args()
    updates = 100 if given.quick else given.updates
    vector_map = read_vector_map(given.maps / f"{given.map}.vectormap.txt")
    segments = vector_map.segments
    settings = SceneSettings(
        length_m=updates * STEP_M, step_m=STEP_M, explained=given.explained, people=1.0
    )
    made_up = scene(vector_map, settings, 1)
    x, y = made_up.truth[0, :2]
    angles = np.linspace(-np.pi, np.pi, RAYS, endpoint=False)
    expected = plain_cast(segments, x, y, angles)
    plain = median_ms(lambda: plain_cast(segments, x, y, angles), 5)
    grid, sensor = segment_grid(segments), np.array([x, y, 0.0])
    ranges, seen_at = np.empty(RAYS), np.empty(RAYS, dtype=np.int64)

    def over_grid() -> Matrix:
        cast_rays(grid, sensor, angles, RANGE_M, ranges, seen_at)
        return ranges

    def swept() -> Matrix:
        return cast(segments, x, y, angles, RANGE_M)[0]

    print(f"{RAYS} rays on {len(segments)} segments: each on each (numpy) {plain:.1f} ms")
    for name, rays in (("sweep", swept), ("over a grid", over_grid)):
        off_m = np.abs(rays() - expected).max()
        fast = median_ms(rays, 100)
        print(f"  {name}: {fast:.3f} ms, {plain / fast:.0f} x; largest difference {off_m:.1e} m")
    process = psutil.Process()
    for method, make in METHODS.items():
        warm_up(method)
        localizer = Timed(make(vector_map, 1), time.process_time)
        localizer.reset(made_up.truth[0])
        resident: list[int] = []

        def take(_: int, __: Estimate, seen: list[int] = resident) -> None:
            seen.append(process.memory_info().rss)

        trace = follow(localizer, made_up.log, on_estimate=take)
        p50, p95 = 1e3 * np.percentile(trace.durations_s, (50, 95))
        grown = (resident[-1] - resident[len(resident) // 2]) / 2**20
        print(
            f"{method:5s} {len(made_up.log)} updates of 271 beams, {made_up.explained:.0%} "
            f"explained: median {p50:.1f} ms, p95 {p95:.1f} ms of processor time; memory "
            f"{grown:+.1f} MB over the second half"
        )
    if given.hours:
        long_run(vector_map, made_up, given.hours)


if __name__ == "__main__":
    main()
