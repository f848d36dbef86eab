"""A base's pose by its laser: carried on by its wheels, doubted where it jumps, told by people."""

from collections.abc import Sequence

import numpy as np
import pytest

from mend.localization.localizer import Estimate
from mend.localization.points import scan_points
from mend.localization.pose import Poses, compose
from mend.localization.scan import Scan
from mend.robots.base.body import RangeScan
from mend.robots.base.localized_pose import LocalizedPose
from mend.robots.link.messages import MOST_GUESSES

ANGLES = np.linspace(-np.pi, np.pi, 91)
START = np.array([5.0, 2.0, 0.5])


class ScriptedLocalizer:
    """Believes its wheels, and what the test sets: `lost`, `jump`, `places`."""

    def __init__(self) -> None:
        self.at: Poses = np.zeros(3)
        self.lost = False
        self.jump: Poses = np.zeros(3)
        self.places: list[Poses] = []
        self.updates = self.searches = 0

    def reset(self, pose: Poses, covariance: Poses | None = None) -> None:
        self.at, self.lost = np.array(pose), covariance is not None

    def update(self, odometry: Poses, scan: Scan) -> Estimate:
        self.updates += 1
        self.at = compose(self.at, odometry) + self.jump
        self.jump = np.zeros(3)
        points = scan_points(scan)
        classes = np.zeros(len(points), np.int8)
        return Estimate(self.at, np.eye(3), points, classes, float(self.lost), self.lost)

    def search_next(self) -> None:
        self.searches += 1

    def open_places(self) -> Sequence[Poses]:
        return self.places

    def get_lost(self) -> None:
        self.lost = True

    def take(self, place: Poses) -> None:
        self.at, self.lost = place, False


class Driven:
    """A localized pose with wheels and a clock."""

    def __init__(self) -> None:
        self.localizer = ScriptedLocalizer()
        self.wheels = np.zeros(3)
        self.time_s = 0.0
        self.pose = LocalizedPose(self.localizer, name_of, START, self.wheels)

    def drive(self, ahead_m: float, steps: int = 1) -> None:
        for _ in range(steps):
            self.wheels = compose(self.wheels, np.array([ahead_m, 0.0, 0.0]))
            self.scan()

    def scan(self) -> None:
        self.time_s += 0.1
        self.pose.note(self.wheels, RangeScan(np.full(91, 2.0), ANGLES, self.time_s))


def name_of(x: float, _y: float) -> str | None:
    return None if x < 0.0 else f"at {int(x)}"


def test_between_scans_it_is_where_its_wheels_have_led_it() -> None:
    driven = Driven()
    driven.drive(0.05)
    updates = driven.localizer.updates
    driven.drive(0.05)
    assert driven.localizer.updates == updates
    assert np.allclose(driven.pose.pose(driven.wheels), compose(START, np.array([0.1, 0, 0])))


def test_after_some_way_a_scan_is_taken() -> None:
    driven = Driven()
    driven.drive(0.05)
    updates = driven.localizer.updates
    driven.drive(0.11, steps=10)
    assert driven.localizer.updates == updates + 3
    assert np.allclose(driven.pose.pose(driven.wheels), compose(START, np.array([1.15, 0, 0])))


def test_who_is_lost_says_how_long_and_searches() -> None:
    driven = Driven()
    driven.drive(0.05)
    assert (driven.pose.is_lost, driven.pose.lost_s) == (False, 0.0)
    driven.localizer.lost = True
    driven.drive(0.5)
    assert driven.pose.is_lost
    for _ in range(10):
        driven.scan()
    assert driven.pose.lost_s == pytest.approx(1.0)
    assert driven.localizer.searches == 1


def test_guesses_are_few_each_once_and_only_of_who_is_lost() -> None:
    driven = Driven()
    driven.drive(0.05)
    driven.localizer.places = [np.array([x, 0.0, 0.0]) for x in (7.1, 7.8, -1.0, 3.0, 9.0, 4.0)]
    assert driven.pose.guesses() == []
    driven.localizer.lost = True
    driven.drive(0.5)
    assert driven.pose.guesses() == ["at 7", "at 3", "at 9"]
    assert len(driven.pose.guesses()) == MOST_GUESSES


def test_a_place_that_it_is_told_is_taken_where_it_is_open() -> None:
    driven = Driven()
    driven.localizer.lost = True
    driven.drive(0.05)
    driven.localizer.places = [np.array([7.1, 1.0, 0.0]), np.array([3.0, 1.0, 0.2])]
    assert driven.pose.believe("at 3")
    assert not driven.pose.is_lost
    assert np.allclose(driven.pose.pose(driven.wheels), [3.0, 1.0, 0.2])


def test_where_it_has_followed_itself_is_asked_about_first() -> None:
    driven = Driven()
    driven.localizer.lost = True
    driven.drive(0.05)
    driven.localizer.places = [np.array([9.0, 2.0, 0.5]), START + np.array([0.1, -0.1, 0.1])]
    assert driven.pose.guesses() == ["at 5", "at 9"]


def test_of_two_poses_in_a_room_it_takes_the_one_that_it_has_followed() -> None:
    driven = Driven()
    driven.localizer.lost = True
    driven.drive(0.05)
    turned = START + np.array([0.1, 0.1, np.pi])
    driven.localizer.places = [turned, START + np.array([0.05, 0.0, 0.0])]
    assert driven.pose.believe("at 5")
    assert np.allclose(driven.pose.pose(driven.wheels), START + np.array([0.05, 0.0, 0.0]))


def test_a_place_that_what_it_sees_speaks_against_is_not_taken() -> None:
    driven = Driven()
    driven.localizer.lost = True
    driven.drive(0.05)
    driven.localizer.places = [np.array([7.1, 1.0, 0.0])]
    assert not driven.pose.believe("at 3")
    assert driven.pose.is_lost


def test_who_knows_where_it_is_does_not_believe_what_is_not_so() -> None:
    driven = Driven()
    driven.drive(0.05)
    assert driven.pose.believe("at 5")
    assert not driven.pose.believe("at 3")
    assert np.allclose(driven.pose.pose(driven.wheels)[:2], START[:2], atol=0.1)


def test_a_jump_is_a_doubt_and_the_wheels_are_believed_meanwhile() -> None:
    driven = Driven()
    driven.drive(0.05)
    driven.localizer.jump = np.array([4.0, 0.0, 0.0])
    driven.drive(0.5)
    assert driven.pose.is_lost
    assert np.allclose(driven.pose.pose(driven.wheels), compose(START, np.array([0.55, 0, 0])))


def test_a_small_correction_is_none() -> None:
    driven = Driven()
    driven.drive(0.05)
    driven.localizer.jump = np.array([0.2, 0.0, 0.0])
    driven.drive(0.5)
    assert not driven.pose.is_lost


def test_on_another_map_it_is_where_it_is_told() -> None:
    driven, other = Driven(), ScriptedLocalizer()
    driven.drive(0.5)
    driven.pose.change_map(other, name_of, np.array([1.0, 1.0, 0.0]), driven.wheels)
    driven.drive(0.25)
    assert np.allclose(driven.pose.pose(driven.wheels), [1.25, 1.0, 0.0])
    assert np.allclose(other.at, [1.25, 1.0, 0.0])


def test_a_scan_without_returns_is_taken_as_well() -> None:
    driven = Driven()
    driven.drive(0.05)
    blind = RangeScan(np.full(91, np.inf), ANGLES, 1.0)
    driven.pose.note(compose(driven.wheels, np.array([0.5, 0, 0])), blind)
    assert not driven.pose.is_lost


def test_it_says_how_sure_it_is_once_it_has_looked_and_while_it_is_not_lost() -> None:
    driven = Driven()
    assert driven.pose.covariance() is None
    driven.drive(0.05)
    driven.drive(0.5)
    assert driven.pose.covariance() == [1.0, 0.0, 1.0]
    driven.localizer.lost = True
    driven.drive(0.5)
    assert driven.pose.covariance() is None
