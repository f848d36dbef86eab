"""Logs made worse on purpose keep what they do not lose."""

import numpy as np
import pytest
from harder_logs import Harder

from mend.localization.logs.log import Log, LogStep
from mend.localization.pose import compose
from mend.localization.scan import Scan

BEAMS = 9


def log(count: int) -> Log:
    """A drive along a curve, with a scan and the truth at every step."""
    motion = np.array([0.5, 0.0, 0.2])
    pose = np.zeros(3)
    steps = []
    for number in range(count):
        told = motion if number else np.zeros(3)
        pose = compose(pose, told)
        scan = Scan(1.0 + np.arange(BEAMS), -1.0, 0.25, 30.0, float(number))
        steps.append(LogStep(told, scan, pose))
    return Log("curve", tuple(steps))


def test_as_it_is_a_log_stays_the_same() -> None:
    made = Harder().made_of(log(4))
    for step, as_it_was in zip(made.steps, log(4).steps, strict=True):
        np.testing.assert_allclose(step.odometry, as_it_was.odometry, atol=1e-12)
        np.testing.assert_array_equal(step.scan.ranges, as_it_was.scan.ranges)


def test_the_motion_to_scans_left_out_is_kept() -> None:
    made = Harder(every=3).made_of(log(10))
    assert len(made) == 4
    at = made.steps[0].reference
    assert at is not None
    for step in made.steps[1:]:
        at = compose(at, step.odometry)
        np.testing.assert_allclose(at, step.reference, atol=1e-9)


def test_the_beams_that_are_left_point_where_they_did() -> None:
    (scan,) = (step.scan for step in Harder(beams_every=2).made_of(log(1)).steps)
    whole = log(1).steps[0].scan
    np.testing.assert_array_equal(scan.ranges, whole.ranges[::2])
    np.testing.assert_allclose(scan.angles, whole.angles[::2])


def test_wheels_of_the_wrong_size_tell_more_of_every_motion() -> None:
    made = Harder(odometry=1.2).made_of(log(3))
    for step, as_it_was in zip(made.steps, log(3).steps, strict=True):
        np.testing.assert_allclose(step.odometry, 1.2 * as_it_was.odometry)


@pytest.mark.parametrize("wrong", [{"every": 0}, {"beams_every": 0}, {"odometry": 0.0}])
def test_what_makes_no_sense_is_refused(wrong: dict[str, float]) -> None:
    with pytest.raises(ValueError, match="counted from 1"):
        Harder(**wrong)  # type: ignore[arg-type]
