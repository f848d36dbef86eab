"""Figures of a drive: errors, lost events, interventions."""

import numpy as np
import pytest

from mend.localization.evaluation import follow, summarize
from mend.localization.localizer import Estimate, Timed
from mend.localization.logs.log import Log, LogStep
from mend.localization.points import scan_points
from mend.localization.pose import Poses, compose
from mend.localization.scan import Scan

SCAN = Scan(np.ones(5), 0.0, 0.1, 8.0)


class Biased:
    """Goes by odometry, and adds an error of its own at given updates."""

    def __init__(self, errors: dict[int, tuple[float, float, float]]) -> None:
        self._errors = errors
        self._pose = np.zeros(3)
        self._updates = 0

    def reset(self, pose: Poses, covariance: np.ndarray | None = None) -> None:  # noqa: ARG002
        self._pose = np.asarray(pose)

    def update(self, odometry: Poses, scan: Scan) -> Estimate:
        self._pose = compose(self._pose, odometry)
        self._pose = self._pose + np.array(self._errors.get(self._updates, (0.0, 0.0, 0.0)))
        self._updates += 1
        points = scan_points(scan)
        classes = np.ones(len(points), dtype=np.int8)
        return Estimate(self._pose, np.eye(3) * 0.01, points, classes, 0.0, False)


def _log(count: int = 41, known: bool = True) -> Log:
    """Straight ahead, 10 cm at a time."""
    steps = [
        LogStep(
            np.array([0.1 if number else 0.0, 0.0, 0.0]),
            SCAN,
            np.array([0.1 * number, 0.0, 0.0]) if known else None,
        )
        for number in range(count)
    ]
    return Log("straight", tuple(steps))


def test_errors_are_against_the_reference() -> None:
    log = _log()
    summary = summarize(follow(Biased({0: (0.03, 0.04, 0.0)}), log), log)
    assert summary.scans == 41
    assert summary.path_m == pytest.approx(4.0)
    assert summary.median_error_m == pytest.approx(0.05)
    assert summary.max_error_m == pytest.approx(0.05)
    assert (summary.lost_events, summary.first_lost_m) == (0, None)


@pytest.mark.parametrize("error", [(1.2, 0.0, 0.0), (0.0, 0.0, 0.6)])
def test_each_time_it_goes_astray_is_one_lost_event(error: tuple[float, float, float]) -> None:
    log = _log()
    back = (-error[0], -error[1], -error[2])
    astray = Biased({10: error, 12: back, 20: error, 21: back})
    summary = summarize(follow(astray, log), log)
    assert summary.lost_events == 2
    assert summary.first_lost_m == pytest.approx(1.0)


def test_somebody_intervenes_after_a_metre_astray() -> None:
    log = _log()
    trace = follow(Biased({10: (2.0, 0.0, 0.0)}), log, intervene=True)
    assert trace.interventions == (20,)
    assert trace.errors_m[21:] == pytest.approx(0.0)


def test_who_finds_back_needs_nobody() -> None:
    back_in_time = Biased({10: (2.0, 0.0, 0.0), 18: (-2.0, 0.0, 0.0)})
    assert follow(back_in_time, _log(), intervene=True).interventions == ()


def test_without_references_nothing_is_claimed() -> None:
    log = _log(known=False)
    summary = summarize(follow(Biased({5: (9.0, 0.0, 0.0)}), log, intervene=True), log)
    assert summary.path_m == pytest.approx(4.0)
    assert summary.median_error_m is None
    assert summary.lost_events is None


def test_the_duration_is_of_the_clock_that_is_passed_in() -> None:
    ticks = iter([1.0, 1.25, 2.0, 2.5])
    timed = Timed(Biased({}), lambda: next(ticks))
    assert timed.update(np.zeros(3), SCAN).duration_s == 0.25
    assert timed.update(np.zeros(3), SCAN).duration_s == 0.5
