"""How well a localizer did on a log: errors, lost events, and interventions by a stated rule."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import radians

import numpy as np
from numpy.typing import NDArray

from mend.localization.localizer import Estimate, Localizer
from mend.localization.logs.log import RecordedDrive
from mend.localization.pose import Poses, wrap

Matrix = NDArray[np.float64]

LOST_M = 1.0
LOST_RAD = radians(30.0)
"""Farther off than either, a robot counts as lost."""
INTERVENE_AFTER_M = 1.0
"""Somebody puts a robot right that has been lost for this much of its way."""


@dataclass(frozen=True, slots=True, eq=False)
class Trace:
    """What a localizer said at each step, and where the robot was (NaN where unknown)."""

    poses: Poses
    references: Poses
    lost: Matrix
    said_lost: NDArray[np.bool_]
    durations_s: Matrix
    interventions: tuple[int, ...]
    """The steps after which the localizer was put right."""

    @property
    def errors_m(self) -> Matrix:
        off = self.poses[:, :2] - self.references[:, :2]
        errors: Matrix = np.hypot(off[:, 0], off[:, 1])
        return errors

    @property
    def errors_rad(self) -> Matrix:
        return np.abs(wrap(self.poses[:, 2] - self.references[:, 2]))

    @property
    def off(self) -> NDArray[np.bool_]:
        """At which steps the robot was lost, whatever it said."""
        with np.errstate(invalid="ignore"):
            off: NDArray[np.bool_] = (self.errors_m > LOST_M) | (self.errors_rad > LOST_RAD)
        return off

    @property
    def along_m(self) -> Matrix:
        """How far the robot had driven at each step."""
        known = self.references if np.isfinite(self.references).all() else self.poses
        steps = np.hypot(*np.diff(known[:, :2], axis=0).T)
        return np.concatenate((np.zeros(min(1, len(known))), np.cumsum(steps)))


@dataclass(frozen=True, slots=True)
class Summary:
    """The figures of one drive; errors are None where the log has no reference."""

    scans: int
    path_m: float
    median_error_m: float | None
    p95_error_m: float | None
    max_error_m: float | None
    median_error_deg: float | None
    lost_events: int | None
    first_lost_m: float | None
    ms_per_update_p50: float
    ms_per_update_p95: float


def follow(
    localizer: Localizer,
    log: RecordedDrive,
    *,
    intervene: bool = False,
    on_estimate: Callable[[int, Estimate], None] | None = None,
) -> Trace:
    """Run a log through a localizer that stands at its start already.

    With `intervene`, a localizer that has been more than `LOST_M` or `LOST_RAD` off for
    `INTERVENE_AFTER_M` of the way is reset to the reference, and the step is noted.
    """
    references = log.references
    driven = _driven(references)
    count = len(log)
    poses = np.empty((count, 3))
    lost, durations = np.empty(count), np.empty(count)
    said = np.zeros(count, dtype=bool)
    interventions: list[int] = []
    lost_since: float | None = None
    for index, step in enumerate(log.steps):
        estimate = localizer.update(step.odometry, step.scan)
        poses[index] = estimate.pose
        lost[index], said[index] = estimate.lost, estimate.is_lost
        durations[index] = estimate.duration_s
        if on_estimate is not None:
            on_estimate(index, estimate)
        if not intervene or not is_off(estimate.pose, references[index]):
            lost_since = None
        elif lost_since is None:
            lost_since = driven[index]
        elif driven[index] - lost_since >= INTERVENE_AFTER_M:
            localizer.reset(references[index])
            interventions.append(index)
            lost_since = None
    return Trace(poses, references, lost, said, durations, tuple(interventions))


def is_off(pose: Poses, reference: Poses) -> bool:
    """Whether a pose is more than `LOST_M` or `LOST_RAD` from the reference; NaN never is."""
    away = np.hypot(pose[0] - reference[0], pose[1] - reference[1])
    return bool(away > LOST_M or abs(wrap(pose[2] - reference[2])) > LOST_RAD)


def summarize(trace: Trace, log: RecordedDrive) -> Summary:
    """The figures of a drive."""
    known = np.isfinite(trace.references).all(axis=1)
    median_ms, p95_ms = 1e3 * np.percentile(trace.durations_s, (50, 95)) if len(log) else (0.0, 0.0)
    measured = bool(known.any())
    errors = trace.errors_m[known]
    starts = list(_starts(trace.off))
    return Summary(
        scans=len(log),
        path_m=log.path_m(),
        median_error_m=float(np.median(errors)) if measured else None,
        p95_error_m=float(np.percentile(errors, 95)) if measured else None,
        max_error_m=float(errors.max()) if measured else None,
        median_error_deg=(
            float(np.degrees(np.median(trace.errors_rad[known]))) if measured else None
        ),
        lost_events=len(starts) if measured else None,
        first_lost_m=float(trace.along_m[starts[0]]) if starts else None,
        ms_per_update_p50=float(median_ms),
        ms_per_update_p95=float(p95_ms),
    )


def _starts(flags: NDArray[np.bool_]) -> Iterator[int]:
    before = False
    for index, flag in enumerate(flags):
        if flag and not before:
            yield index
        before = bool(flag)


def _driven(references: Poses) -> Matrix:
    steps = np.hypot(*np.diff(references[:, :2], axis=0).T)
    return np.concatenate((np.zeros(min(1, len(references))), np.cumsum(np.nan_to_num(steps))))
