"""Where another localizer was lost is said, and nothing else."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mend.errors import WrongInputError
from mend.localization.beam_model import BeamModel
from mend.localization.judging.contest import MOST_PER_SCAN, Contest, Hypothesis
from mend.localization.judging.drive import judge_drive
from mend.localization.judging.verdict import Judgement, Standing
from mend.localization.localizer import Estimate
from mend.localization.logs.log import Log, LogStep
from mend.localization.points import scan_points
from mend.localization.pose import Poses, compose, relative
from mend.localization.scan import Scan
from mend.maps.ray_cast import cast
from mend.maps.vector_map import VectorMap

HALL = VectorMap.of(
    [[0, 0, 30, 0], [30, 0, 30, 8], [30, 8, 0, 8], [0, 8, 0, 0]]
    + [[x, 0, x, 1.0 + 0.3 * number] for number, x in enumerate((3.0, 7.5, 10.0, 16.0, 21.0))]
    + [[x, 8, x + 0.7, 6.5 - 0.2 * number] for number, x in enumerate((5.0, 9.0, 13.5, 19.0, 26.0))]
)
CORRIDOR = VectorMap.of([[-100, -1, 100, -1], [-100, 1, 100, 1]])
BEAMS = np.linspace(-2.3, 2.3, 120)
STEP_M = 0.25


def _scan(vector_map: VectorMap, pose: Poses, number: int) -> Scan:
    ranges, _ = cast(vector_map.segments, pose[0], pose[1], BEAMS + pose[2], 12.0)
    return Scan(ranges, BEAMS[0], BEAMS[1] - BEAMS[0], 12.0, float(number))


def _way(count: int = 90) -> Poses:
    """Straight on, and a little left and right."""
    number = np.arange(count)
    return np.column_stack(
        (2.0 + STEP_M * number, 4.0 + 0.3 * np.sin(number / 8.0), 0.1 * np.cos(number / 8.0))
    )


def _drive(way: Poses, vector_map: VectorMap = HALL, carried_at: int | None = None) -> Log:
    """A drive along poses; where it is carried its wheels do not turn."""
    steps = []
    for number, pose in enumerate(way):
        motion = relative(way[max(number - 1, 0)], pose)
        if number == carried_at:
            motion = np.zeros(3)
        steps.append(LogStep(motion, _scan(vector_map, pose, number)))
    return Log("hall", tuple(steps))


@dataclass(slots=True)
class Odometer:
    """A localizer that goes by its odometry, which here is exact, and may be told what to say."""

    says: Callable[[int, Poses], tuple[Poses, bool]] = lambda _, pose: (pose, False)
    pose: Poses = field(default_factory=lambda: np.zeros(3))
    number: int = 0

    def reset(self, pose: Poses, covariance: np.ndarray | None = None) -> None:
        del covariance
        self.pose = np.asarray(pose)

    def update(self, odometry: Poses, scan: Scan) -> Estimate:
        self.pose, in_doubt = self.says(self.number, compose(self.pose, odometry))
        self.number += 1
        points = scan_points(scan)
        return Estimate(self.pose, np.eye(3), points, np.zeros(len(points), np.int8), 0.0, in_doubt)


def _aside(way: Poses, first: int, last: int, off: tuple[float, float, float]) -> Poses:
    theirs = way.copy()
    theirs[first:last] = compose(way[first:last], np.array(off))
    return theirs


def _judged(theirs: Poses, way: Poses, start: Poses | None = None) -> Judgement:
    return judge_drive(_drive(way), theirs, HALL, Odometer, start)


def test_of_a_track_that_is_right_nothing_is_said() -> None:
    way = _way()
    judgement = _judged(way + np.array([0.1, -0.1, 0.05]), way, way[0])
    assert judgement.stretches == ()
    assert set(judgement.standings) == {Standing.HOLDS}


@pytest.mark.parametrize("off", [(1.5, 0.0, 0.0), (0.0, -1.4, 0.0), (0.0, 0.0, 0.8)])
def test_a_lost_track_is_said_with_where_it_began_and_ended(off: tuple[float, ...]) -> None:
    way = _way()
    judgement = _judged(_aside(way, 30, 60, off), way)  # type: ignore[arg-type]
    (stretch,) = judgement.stretches
    assert stretch.standing is Standing.LOST
    assert stretch.since.step == 30
    assert stretch.since.along_m == pytest.approx(30 * STEP_M, rel=0.05)
    assert stretch.said.step < 45
    assert stretch.until is not None
    assert stretch.until.step == 60
    assert stretch.ours_matched > 0.9 > stretch.theirs_matched
    assert judgement.metres_of(Standing.LOST) == pytest.approx(30 * STEP_M, rel=0.05)
    assert judgement.counts(Standing.OPEN) == 0


def test_it_may_be_lost_to_the_end_and_more_than_once() -> None:
    way = _way()
    theirs = _aside(way, 20, 40, (2.0, 1.0, 0.0))
    theirs[70:] = compose(way[70:], np.array([0.0, 2.0, 0.3]))
    first, second = _judged(theirs, way).lost
    assert (first.since.step, second.since.step) == (20, 70)
    assert second.until is None


def test_when_ours_is_the_wrong_one_it_is_put_right_and_nothing_is_said() -> None:
    way = _way()
    judgement = _judged(way, way, compose(way[0], np.array([2.5, 1.0, 0.4])))
    assert judgement.stretches == ()
    assert len(judgement.ours_corrected) == 1
    assert judgement.ours[-1] == pytest.approx(way[-1])


def test_when_neither_track_fits_that_is_said() -> None:
    way = _way()
    theirs = _aside(way, 0, 90, (6.0, -2.0, 2.0))
    judgement = _judged(theirs, way, compose(way[0], np.array([4.0, 2.0, -1.5])))
    assert judgement.lost == ()
    assert {each.standing for each in judgement.stretches} == {Standing.NEITHER}


def test_our_doubt_alone_says_nothing() -> None:
    way = _way()
    judgement = judge_drive(_drive(way), way, HALL, lambda: Odometer(lambda _, pose: (pose, True)))
    assert judgement.stretches == ()


def test_while_ours_is_in_doubt_the_other_is_not_called_lost() -> None:
    way = _way()
    theirs = _aside(way, 30, 90, (1.6, 0.0, 0.0))
    judgement = judge_drive(
        _drive(way), theirs, HALL, lambda: Odometer(lambda _, pose: (pose, True))
    )
    assert judgement.lost == ()


def test_less_than_lost_is_not_lost_however_long_ours_was_in_doubt() -> None:
    way = _way()
    theirs = compose(way, np.array([0.8, 0.0, 0.0]))
    judgement = judge_drive(
        _drive(way), theirs, HALL, lambda: Odometer(lambda at, pose: (pose, at < 40)), way[0]
    )
    assert judgement.lost == ()


def test_where_the_scans_cannot_tell_it_stays_open() -> None:
    way = np.column_stack((STEP_M * np.arange(60), np.zeros(60), np.zeros(60)))
    theirs = _aside(way, 20, 60, (3.0, 0.0, 0.0))
    judgement = judge_drive(_drive(way, CORRIDOR), theirs, CORRIDOR, Odometer)
    assert judgement.stretches == ()
    assert judgement.metres_of(Standing.OPEN) == pytest.approx(39 * STEP_M, abs=0.6)


def test_a_track_that_did_not_notice_that_the_robot_was_carried_is_lost_since_then() -> None:
    """Ours is in doubt for a while, finds the right place, and the way there is looked back on."""
    before, after = _way(40), _way(90)[60:]
    way = np.concatenate((before, after + np.array([2.0, -1.0, 0.6])))
    drive = _drive(way, carried_at=40)
    theirs = way.copy()
    for number in range(40, len(way)):
        theirs[number] = compose(theirs[number - 1], drive.steps[number].odometry)

    def says(number: int, pose: Poses) -> tuple[Poses, bool]:
        return (way[number], False) if number == 52 else (pose, 42 < number < 52)

    made = iter([Odometer(says)])
    judgement = judge_drive(drive, theirs, HALL, lambda: next(made, Odometer()))
    (stretch,) = judgement.lost
    assert abs(stretch.since.step - 40) <= 2
    assert stretch.said.step >= 52
    assert judgement.metres_of(Standing.NEITHER) == 0.0


def test_before_the_other_has_told_a_pose_nothing_is_judged() -> None:
    way = _way()
    theirs = _aside(way, 50, 90, (1.5, 0.0, 0.0))
    theirs[:20] = np.nan
    judgement = _judged(theirs, way)
    assert judgement.first_step == 20
    assert len(judgement.standings) == 70
    assert judgement.lost[0].since.step == 50


def test_a_localizer_that_tells_nothing_cannot_be_judged() -> None:
    with pytest.raises(WrongInputError, match="tells no pose"):
        _judged(np.full((90, 3), np.nan), _way())


def test_a_robot_that_stands_says_nothing_new() -> None:
    way = np.repeat(_way(40)[30:31], 200, axis=0)
    theirs = _aside(way, 1, 200, (1.5, 0.0, 0.0))
    assert _judged(theirs, way).lost == ()


def test_the_right_pose_is_the_likeliest() -> None:
    model = BeamModel(HALL)
    pose = _way()[40]
    beams = model.beams_of(_scan(HALL, pose, 0))
    right = model.log_likelihood(pose, beams)
    asides = [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 0.5)]
    assert all(right > model.log_likelihood(compose(pose, np.array(off)), beams) for off in asides)
    assert model.matched_share(pose, beams) == 1.0


@given(st.lists(st.tuples(*[st.floats(-1e4, 0.0)] * 3), max_size=30))
def test_no_single_scan_decides_and_nothing_is_ruled_out_for_good(
    scans: list[tuple[float, float, float]],
) -> None:
    contest = Contest()
    for scan in scans:
        before = contest.winner()
        contest.weigh(np.array(scan))
        assert contest.weights.max() == 0.0
        after = contest.winner()
        assert before is None or after in (before, None)
    for _ in range(30):
        contest.weigh(np.array([-MOST_PER_SCAN, -MOST_PER_SCAN, 0.0]))
    assert contest.winner() is Hypothesis.NEITHER
