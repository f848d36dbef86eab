"""Every method on every real log that is here.

A log NAME-corrected.log.gz belongs to the map NAME.vectormap.txt; logs whose maps are missing are
left out with a notice. `--drop` deletes a random share of each map's segments first; `--every`,
`--beams-every` and `--odometry` make a log worse, see `harder_logs.py`. The Wean Hall
runs have no reference and no map: a map is built from run 2, and on it the others are followed,
from no idea where they are: what is told is how far they drove until the method no longer said that
it was lost, and how much of what it saw since the map explained.

MRPT's `pf-localization` runs beside them where it is installed, without its idea of being lost.

    python benchmarks/localization_logs.py [--data FOLDER] [--log NAME ...] [--method enml ...]
        [--drop 0.33] [--every 2] [--beams-every 2] [--odometry 1.2] [--scans N] [--seed 1]
        [--quick]
"""

# ruff: noqa: T201
import argparse
import os
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from harder_logs import Harder
from peers import mrpt

from mend.localization.evaluation import LOST_M, Trace, follow, summarize
from mend.localization.localizer import Estimate, PointClass, Timed
from mend.localization.logs.log import Log
from mend.localization.logs.reading import read_log
from mend.localization.mapping import map_of
from mend.localization.methods import METHODS, warm_up
from mend.localization.scan_matching import matched_poses
from mend.maps.vector_map import VectorMap
from mend.maps.vector_map_file import read_vector_map

DATA = Path(os.environ.get("BENCH_DATA", Path(__file__).parents[2] / "shared/data"))
PEER = "mrpt"
QUICK_SCANS = 150
HEADINGS = (
    f"{'log':20s} {'method':6s} {'scans':>6s} {'path':>7s} {'median':>8s} {'p95':>7s} {'max':>7s} "
    f"{'heading':>8s} {'lost':>5s} {'first at':>8s} {'said':>7s} {'silent':>7s} "
    f"{'p50':>8s} {'p95':>8s} {'max':>8s}"
)


def line(name: str, method: str, trace: Trace, log: Log) -> str:
    """One row of the table: `said` that it was lost, off by more than a metre but `silent`."""
    summary = summarize(trace, log)
    along_m = np.diff(trace.along_m, prepend=0.0)
    said_m = along_m[trace.said_lost].sum()
    silent_m = along_m[(trace.errors_m > LOST_M) & ~trace.said_lost].sum()
    longest_ms = 1e3 * trace.durations_s.max(initial=0.0)

    def number(value: float | None, form: str) -> str:
        return "-" if value is None else form.format(value)

    return (
        f"{name:20s} {method:6s} {summary.scans:6d} {summary.path_m:5.0f} m "
        f"{number(summary.median_error_m, '{:6.3f} m')} {number(summary.p95_error_m, '{:5.2f} m')} "
        f"{number(summary.max_error_m, '{:5.2f} m')} "
        f"{number(summary.median_error_deg, '{:4.2f} deg')} "
        f"{summary.lost_events if summary.lost_events is not None else '-':>5} "
        f"{number(summary.first_lost_m, '{:6.1f} m'):>8s} "
        f"{said_m:5.0f} m {silent_m:5.0f} m "
        f"{summary.ms_per_update_p50:5.1f} ms {summary.ms_per_update_p95:5.1f} ms "
        f"{longest_ms:5.0f} ms"
    )


def localized(method: str, vector_map: VectorMap, log: Log, seed: int) -> Trace:
    """One method on one log, in processor time."""
    localizer = Timed(METHODS[method](vector_map, seed), time.process_time)
    assert log.start is not None
    localizer.reset(log.start)
    return follow(localizer, log)


def peer_line(name: str, vector_map: VectorMap, log: Log) -> str:
    """MRPT's row, in the wall time that it tells, or why there is none."""
    try:
        return line(name, PEER, mrpt.mrpt_trace(vector_map, log), log)
    except mrpt.MrptError as error:
        return f"{name:20s} {PEER:6s} {error}"


def wean(folder: Path, methods: list[str], scans: int | None, seed: int) -> None:
    """The Wean Hall runs on a map built from run 2."""
    source = read_log(folder / "robotdata2.log")
    vector_map = map_of(source, matched_poses(source))
    print(f"\nWean Hall: {len(vector_map)} segments built from run 2")
    for path in sorted(folder.glob("robotdata*.log")):
        log = read_log(path)
        log = replace(log, steps=log.steps[:scans])
        for method in methods:
            localizer = METHODS[method](vector_map, seed)
            localizer.reset(np.zeros(3))
            explained: list[float] = []

            def take(_: int, estimate: Estimate, shares: list[float] = explained) -> None:
                shares.append(float(np.mean(estimate.classes == PointClass.LTF)))

            trace = follow(localizer, log, on_estimate=take)
            said = np.flatnonzero(trace.said_lost)
            found = int(said[-1]) + 1 if len(said) else 0
            if found >= len(log):
                print(f"{path.stem:20s} {method:6s} still says that it is lost")
                continue
            print(
                f"{path.stem:20s} {method:6s} {len(log):6d} {log.path_m():5.0f} m  sure from "
                f"{trace.along_m[found]:.1f} m on; since then the map explains "
                f"{np.median(explained[found:]):.0%} (median) of what it sees",
                flush=True,
            )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--data", type=Path, default=DATA / "localization")
    parser.add_argument("--log", action="append", help="only this one; may be repeated")
    parser.add_argument("--method", action="append", choices=[*METHODS, PEER])
    parser.add_argument("--drop", type=float, default=0.0)
    parser.add_argument("--every", type=int, default=1, help="only every so-manieth scan")
    parser.add_argument("--beams-every", type=int, default=1, help="only every so-manieth beam")
    parser.add_argument("--odometry", type=float, default=1.0, help="told so many times the motion")
    parser.add_argument("--scans", type=int, help="only the first so many of each log")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--quick", action="store_true", help=f"{QUICK_SCANS} scans of each log")
    given = parser.parse_args()
    scans = QUICK_SCANS if given.quick else given.scans
    harder = Harder(given.every, given.beams_every, given.odometry)
    wanted = given.method or [*METHODS, PEER]
    methods = [each for each in wanted if each != PEER]
    with_peer = PEER in wanted and mrpt.installed()
    if PEER in wanted and not with_peer:
        print(mrpt.MISSING)
    for method in methods:
        warm_up(method)
    print(HEADINGS)
    for path in sorted((given.data / "logs").glob("*.log.gz")):
        name = path.name.removesuffix(".log.gz").removesuffix("-corrected")
        if given.log and name not in given.log:
            continue
        map_path = given.data / "log_maps" / f"{name}.vectormap.txt"
        if not map_path.exists():
            print(f"{name:20s} there is no {map_path.name}")
            continue
        log = read_log(path)
        log = harder.made_of(replace(log, steps=log.steps[:scans]))
        vector_map = thinned(read_vector_map(map_path), given.drop, given.seed)
        for method in methods:
            trace = localized(method, vector_map, log, given.seed)
            print(line(name, method, trace, log), flush=True)
        if with_peer:
            print(peer_line(name, vector_map, log), flush=True)
    if (given.data / "wean").is_dir() and not given.log:
        wean(given.data / "wean", methods, scans, given.seed)


def thinned(vector_map: VectorMap, share: float, seed: int) -> VectorMap:
    """The map without a random share of its segments."""
    left = np.random.default_rng(seed).random(len(vector_map)) >= share
    return vector_map.with_segments(vector_map.segments[left])


if __name__ == "__main__":
    main()
