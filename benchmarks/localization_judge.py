"""`--judge` beside MCL, which is made to lose itself on purpose on real logs.

On each log MCL runs four times. `misplaced`: halfway it is told that the robot stands elsewhere,
as by a person's wrong click. `blinded`: for a while it gets no scans and goes by odometry with a
heading 20 % wrong. `slipped`: its wheels report 2.5 m that were not driven. `carried`: the robot is
carried on, 25 m of the log being cut out. And `left alone`: nothing is done to it.

MCL is lost, by the logs' reference poses, from where it is more than 1 m or 30 degrees off until it
is within half of both. A verdict's onset counts as right within 2 m of such a stretch's, and a
verdict as false if MCL was not lost anywhere in it. Losses over in less than 5 m may be missed.
Of drawn numbers (`--seed`) depends where MCL is led astray.

    python benchmarks/localization_judge.py [--data FOLDER] [--log NAME ...] [--way misplaced ...]
        [--method enml] [--scans N] [--seed 1] [--quick]
"""

# ruff: noqa: T201
import argparse
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
from localization_logs import DATA, QUICK_SCANS

from mend.localization.evaluation import LOST_M, LOST_RAD
from mend.localization.judging.drive import judge_drive
from mend.localization.judging.verdict import Judgement, Standing
from mend.localization.localizer import Localizer
from mend.localization.logs.log import Log
from mend.localization.logs.reading import read_log
from mend.localization.methods import METHODS, warm_up
from mend.localization.pose import Poses, compose, wrap_angle
from mend.maps.vector_map import VectorMap
from mend.maps.vector_map_file import read_vector_map

LOGS = ("aces", "edmonton", "fhw", "intel", "csail")
ONSET_M = 2.0
MAY_BE_MISSED_M = 5.0
CUT_M = 25.0
BLIND_M = 30.0


@dataclass(frozen=True, slots=True)
class Loss:
    """A stretch on which MCL was lost by the references, in metres by odometry."""

    since_m: float
    until_m: float


def left_alone(log: Log, mcl: Localizer, _: np.random.Generator) -> tuple[Log, Poses]:
    return log, np.array([mcl.update(each.odometry, each.scan).pose for each in log.steps])


def misplaced(log: Log, mcl: Localizer, generator: np.random.Generator) -> tuple[Log, Poses]:
    at = somewhere_in(log, generator)
    aside = np.array([*generator.uniform(2.0, 6.0, 2), generator.uniform(-1.0, 1.0)])
    poses = []
    for number, step in enumerate(log.steps):
        poses.append(mcl.update(step.odometry, step.scan).pose)
        if number == at:
            mcl.reset(compose(poses[-1], aside))
    return log, np.array(poses)


def blinded(log: Log, mcl: Localizer, generator: np.random.Generator) -> tuple[Log, Poses]:
    at = somewhere_in(log, generator)
    driven = along(log)
    poses = []
    for number, step in enumerate(log.steps):
        blind = number > at and driven[number] - driven[at] < BLIND_M
        motion, scan = step.odometry, step.scan
        if blind:
            motion = motion * np.array([1.0, 1.0, 1.2]) + np.array([0.0, 0.0, 0.03 * motion[0]])
            scan = replace(scan, ranges=np.full(len(scan.ranges), np.inf))
        poses.append(mcl.update(motion, scan).pose)
    return log, np.array(poses)


def slipped(log: Log, mcl: Localizer, generator: np.random.Generator) -> tuple[Log, Poses]:
    at = somewhere_in(log, generator)
    poses = []
    for number, step in enumerate(log.steps):
        motion = step.odometry + np.array([2.5 if number == at else 0.0, 0.0, 0.0])
        poses.append(mcl.update(motion, step.scan).pose)
    return log, np.array(poses)


def carried(log: Log, mcl: Localizer, generator: np.random.Generator) -> tuple[Log, Poses]:
    at = somewhere_in(log, generator)
    driven = along(log)
    after = int(np.searchsorted(driven, driven[at] + CUT_M))
    # The first scan after the cut comes with no motion: nobody's wheels turned.
    put_down = replace(log.steps[after], odometry=np.zeros(3))
    cut = replace(log, steps=(*log.steps[: at + 1], put_down, *log.steps[after + 1 :]))
    return left_alone(cut, mcl, generator)


Way = Callable[[Log, Localizer, np.random.Generator], tuple[Log, Poses]]
WAYS: dict[str, Way] = {
    each.__name__: each for each in (left_alone, misplaced, blinded, slipped, carried)
}


def somewhere_in(log: Log, generator: np.random.Generator) -> int:
    """A step in the middle third of the way."""
    driven = along(log)
    return int(np.searchsorted(driven, generator.uniform(0.33, 0.66) * driven[-1]))


def along(log: Log) -> np.ndarray:
    """Metres by odometry at each step."""
    motions = np.array([each.odometry for each in log.steps])
    return np.cumsum(np.hypot(motions[:, 0], motions[:, 1]))


def losses(log: Log, poses: Poses) -> Iterator[Loss]:
    """Where poses are lost by the log's references."""
    driven = along(log)
    since: float | None = None
    for at_m, pose, reference in zip(driven, poses, log.references, strict=True):
        away = float(np.hypot(*(pose - reference)[:2])) / LOST_M
        turned = abs(wrap_angle(float(pose[2] - reference[2]))) / LOST_RAD
        if since is None and max(away, turned) > 1.0:
            since = float(at_m)
        elif since is not None and max(away, turned) < 0.5:
            yield Loss(since, float(at_m))
            since = None
    if since is not None:
        yield Loss(since, float(driven[-1]))


@dataclass(slots=True)
class Score:
    """What came of all drives."""

    losses: int = 0
    found: int = 0
    missed: int = 0
    false: int = 0
    neither_m: float = 0.0
    onsets_m: list[float] | None = None

    def add(self, log: Log, poses: Poses, judgement: Judgement) -> str:
        """Score one drive, and say what came of it."""
        there = list(losses(log, poses))
        end_m = float(along(log)[-1])
        said = [
            Loss(each.since.along_m, each.until.along_m if each.until else end_m)
            for each in judgement.lost
        ]
        words = []
        self.onsets_m = self.onsets_m or []
        for loss in there:
            near = [each for each in said if overlap(each, loss)]
            length = loss.until_m - loss.since_m
            if near:
                off_m = near[0].since_m - loss.since_m
                self.losses += 1
                self.found += abs(off_m) <= ONSET_M
                self.onsets_m.append(off_m)
                words.append(f"lost {loss.since_m:.1f}-{loss.until_m:.1f} m: onset {off_m:+.2f} m")
            elif length >= MAY_BE_MISSED_M:
                self.losses += 1
                self.missed += 1
                words.append(f"lost {loss.since_m:.1f}-{loss.until_m:.1f} m: MISSED")
            else:
                words.append(f"lost {loss.since_m:.1f}-{loss.until_m:.1f} m: too short to tell")
        for each in said:
            if not any(overlap(each, loss) for loss in there):
                self.false += 1
                words.append(f"FALSE verdict {each.since_m:.1f}-{each.until_m:.1f} m")
        for each in judgement.stretches:
            if each.standing is Standing.NEITHER:
                until = each.until.along_m if each.until else end_m
                self.neither_m += until - each.since.along_m
                words.append(f"neither {each.since.along_m:.1f}-{until:.1f} m")
        if judgement.ours_corrected:
            words.append(f"ours corrected {len(judgement.ours_corrected)} times")
        return "; ".join(words) or "never lost, and nothing said"


def overlap(one: Loss, other: Loss) -> bool:
    return one.since_m <= other.until_m + 0.01 and other.since_m <= one.until_m + 0.01


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--data", type=Path, default=DATA / "localization")
    parser.add_argument("--log", action="append", help="only this one; may be repeated")
    parser.add_argument("--way", action="append", choices=WAYS, help="only this one")
    parser.add_argument("--method", choices=METHODS, default="enml")
    parser.add_argument("--scans", type=int, help="only the first so many of each log")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--quick", action="store_true", help=f"{QUICK_SCANS} scans of each log")
    given = parser.parse_args()
    scans = QUICK_SCANS if given.quick else given.scans
    for method in (given.method, "mcl"):
        warm_up(method)
    score = Score()
    for name in given.log or LOGS:
        log = read_log(given.data / "logs" / f"{name}-corrected.log.gz")
        log = replace(log, steps=log.steps[:scans])
        vector_map = read_vector_map(given.data / "log_maps" / f"{name}.vectormap.txt")
        for way in given.way or WAYS:
            judged, poses = led_astray(log, vector_map, way, given.seed)
            make = partial(METHODS[given.method], vector_map, given.seed)
            judgement = judge_drive(judged, poses, vector_map, make)
            print(f"{name:18s} {way:10s} {score.add(judged, poses, judgement)}", flush=True)
    onsets = np.abs(score.onsets_m or [0.0])
    print(
        f"\n{score.losses} losses: onset within {ONSET_M:g} m in {score.found}, missed "
        f"{score.missed}, onset off by {np.median(onsets):.2f} m in the median and "
        f"{onsets.max():.2f} m at most; {score.false} false verdicts; neither track fitted the "
        f"scans on {score.neither_m:.0f} m"
    )


def led_astray(log: Log, vector_map: VectorMap, way: str, seed: int) -> tuple[Log, Poses]:
    """The log as the judge sees it, and MCL's poses."""
    mcl = METHODS["mcl"](vector_map, seed)
    assert log.start is not None
    mcl.reset(log.start)
    return WAYS[way](log, mcl, np.random.default_rng(seed))


if __name__ == "__main__":
    main()
