"""A camera that repeats itself is told from one that rightly gives the same picture again."""

from dataclasses import replace

import numpy as np
import pytest
from broken_camera import with_noise
from drawn_scene import DrawnScene, Resting
from hypothesis import given, settings
from hypothesis import strategies as st
from sampled import sample

from mend.robots.body import CameraImage
from mend.robots.vision.freeze_detection import FreezeDetector

SCENE = DrawnScene({"green_leg": Resting(0.55, -0.2), "purple_top": Resting(0.66, 0.1)})
STILL = SCENE.picture()
OUT_OF_VIEW = np.array([[0.3, -3.0, 1.0], [0.3, -3.1, 1.0]])
OVER_TABLE = np.array([[0.6, 0.0, 0.9], [0.6, 0.05, 0.9]])
RNG = np.random.default_rng(7)


def told(*pictures: CameraImage, fingers: list[np.ndarray] | None = None) -> list[bool]:
    """Whether each of some pictures, taken one after the other, is told to be frozen."""
    detector, found = FreezeDetector(), []
    places = fingers or [OUT_OF_VIEW] * len(pictures)
    for time, (picture, where) in enumerate(zip(pictures, places, strict=True)):
        detector.note(replace(picture, time=float(time)), where)
        found.append(detector.frozen)
    return found


def in_color(noise: float) -> CameraImage:
    off = RNG.normal(0.0, noise, STILL.bgr.shape)
    return replace(STILL, bgr=np.clip(np.rint(STILL.bgr + off), 0, 255).astype(np.uint8))


def in_depth(noise_m: float = 0.0005) -> CameraImage:
    return with_noise(STILL, noise_m, RNG)


@pytest.mark.parametrize("noisy", [in_depth, lambda: in_color(1.0), lambda: in_color(30.0)])
def test_no_noisy_picture_comes_twice(noisy) -> None:
    one, other, third = noisy(), noisy(), noisy()
    assert told(one, other, other, other, third, third) == [False, False, True, True, False, True]


def test_depth_tells_where_the_colour_never_changes_and_the_other_way_round() -> None:
    one, other = in_depth(), in_depth()
    assert told(one, other, other)[-1]
    repainted = replace(other, bgr=in_color(2.0).bgr)
    assert told(one, other, repainted)[-1]


def test_a_camera_without_noise_may_give_the_same_picture_of_the_same() -> None:
    assert told(*[STILL] * 4) == [False] * 4


@given(gains=st.lists(st.floats(0.9, 1.1), min_size=2, max_size=6))
@settings(max_examples=sample(10, 30), deadline=None)
def test_light_that_flickers_and_comes_back_is_no_noise(gains: list[float]) -> None:
    lit = [replace(SCENE, light=gain).picture() for gain in gains]
    assert told(*lit, lit[-1], STILL, STILL) == [False] * (len(lit) + 3)


def test_fingers_that_moved_in_view_must_show() -> None:
    there = [OUT_OF_VIEW, OVER_TABLE, OUT_OF_VIEW, OUT_OF_VIEW]
    assert told(*[STILL] * 4, fingers=there) == [False, True, True, True]
    box = replace(SCENE, grey_boxes=[((0.6, 0.0, 0.85), (0.1, 0.1, 0.1))]).picture()
    assert told(STILL, box, STILL, STILL, fingers=there) == [False] * 4


def test_fingers_that_something_hides_or_that_nobody_measures_need_not_show() -> None:
    hiding = replace(SCENE, grey_boxes=[((0.45, 0.0, 0.7), (0.02, 0.4, 0.5))]).picture()
    assert told(hiding, hiding, fingers=[OUT_OF_VIEW, OVER_TABLE]) == [False, False]
    assert STILL.depth_m is not None
    unmeasured = replace(STILL, depth_m=np.full_like(STILL.depth_m, np.nan))
    assert told(unmeasured, unmeasured, fingers=[OUT_OF_VIEW, OVER_TABLE]) == [False, False]
    assert told(STILL, STILL, fingers=[np.empty((0, 3))] * 2) == [False, False]


def test_the_very_same_moment_is_no_repetition() -> None:
    detector = FreezeDetector()
    one, other = in_depth(), in_depth()
    for picture, time in ((one, 1.0), (other, 2.0), (other, 2.0)):
        detector.note(replace(picture, time=time), OUT_OF_VIEW)
    assert not detector.frozen
