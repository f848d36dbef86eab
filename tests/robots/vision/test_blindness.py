"""A picture tells of the table, or it is said why it does not."""

from dataclasses import replace

import numpy as np
import pytest
from broken_camera import with_noise, without_color
from drawn_scene import DrawnScene, Resting
from hypothesis import given, settings
from hypothesis import strategies as st
from sampled import sample

from mend.robots.body import CameraImage
from mend.robots.vision.blindness import (
    depth_noise_m,
    why_blind,
    why_colorless,
    why_outdated,
    why_rough,
)
from mend.tasks.scene import Table

TABLE = Table()
FULL = DrawnScene({"green_leg": Resting(0.55, -0.2), "purple_top": Resting(0.66, 0.1)}, noise=3.0)


def without_depth(image: CameraImage, share: float, missing: float) -> CameraImage:
    """The picture's upper `share` has no depth, which its driver says with `missing`."""
    assert image.depth_m is not None
    depth_m = image.depth_m.copy()
    depth_m[: round(share * len(depth_m))] = missing
    return replace(image, depth_m=depth_m)


def test_a_table_in_any_light_is_seen() -> None:
    for light in (0.3, 1.0, 1.15):
        assert why_blind(replace(FULL, light=light).picture(), TABLE) is None


def replace_bgr(level: float, noise: float = 4.0) -> CameraImage:
    image = FULL.picture()
    grey = np.random.default_rng(1).normal(level, noise, image.bgr.shape)
    return replace(image, bgr=np.clip(grey, 0, 255).astype(np.uint8))


def test_a_black_and_a_white_picture_show_nothing() -> None:
    assert why_blind(replace_bgr(0.0), TABLE) == "the picture of my head camera is black"
    assert why_blind(replace_bgr(255.0), TABLE) == "the picture of my head camera is white"


@pytest.mark.parametrize("missing", [np.nan, 0.0, np.inf])
def test_without_depth_nothing_is_seen_however_a_driver_says_it(missing: float) -> None:
    blind = without_depth(FULL.picture(), 1.0, missing)
    assert why_blind(blind, TABLE) == "my head camera measures no depth"
    assert why_blind(without_depth(FULL.picture(), 0.1, missing), TABLE) is None
    mostly = why_blind(without_depth(FULL.picture(), 0.75, missing), TABLE)
    assert mostly is not None
    assert mostly.startswith("my head camera sees no more than ")


def test_a_sheet_before_the_camera_hides_the_table_and_the_own_arm_does_not() -> None:
    image = FULL.picture()
    assert image.depth_m is not None
    sheet = replace(image, depth_m=np.full_like(image.depth_m, 0.3))
    assert why_blind(sheet, TABLE) == "my head camera sees no more than 0 % of the table"
    assert why_blind(sheet, TABLE, lambda points: np.ones(len(points), np.bool_)) is None


def test_a_picture_of_long_ago_tells_nothing_of_now() -> None:
    image = FULL.picture(time=10.0)
    assert why_outdated(image, 10.4) is None
    assert why_outdated(image, 22.0) == "the newest picture of my head camera is 12 s old"


@given(seed=st.integers(0, 2**32 - 1), noise_m=st.floats(1e-4, 0.3))
@settings(max_examples=sample(10, 30), deadline=None)
def test_the_noise_of_depth_is_measured_whatever_stands_there(seed: int, noise_m: float) -> None:
    noisy = with_noise(FULL.picture(), noise_m, np.random.default_rng(seed))
    clear = depth_noise_m(FULL.picture(), TABLE)
    # Of heights, which lie aslant to the depth that is noisy.
    assert 0.4 * noise_m - clear < depth_noise_m(noisy, TABLE) < 1.05 * noise_m + clear


def test_a_part_that_is_lower_than_the_noise_can_tell_is_blamed_on_the_camera() -> None:
    noisy = with_noise(FULL.picture(), 0.03, np.random.default_rng(1))
    why = why_rough(noisy, TABLE, 0.030)
    assert why is not None
    assert why.startswith("the depth that my head camera measures is off by ")
    assert why.endswith("too much to tell a part of 30 mm from the table")
    assert why_rough(FULL.picture(), TABLE, 0.008) is None
    assert why_rough(without_depth(FULL.picture(), 1.0, np.nan), TABLE, 0.008) is None


@pytest.mark.parametrize("noise", [0.0, 4.0, 30.0])
@pytest.mark.parametrize("light", [0.3, 1.0])
def test_a_picture_without_any_colour_is_told_from_a_coloured_one(
    noise: float, light: float
) -> None:
    picture = replace(FULL, noise=0.0, light=light).picture()
    assert why_colorless(noisy_colors(picture, noise), TABLE, grey=0) is None
    grey = noisy_colors(without_color(picture), noise)
    assert why_colorless(grey, TABLE, grey=0) == "the picture of my head camera has no colour"


def test_where_no_more_than_grey_parts_stand_a_grey_picture_is_as_it_should_be() -> None:
    assert why_colorless(without_color(DrawnScene().picture()), TABLE, grey=0) is None
    two = without_color(FULL.picture())
    assert why_colorless(two, TABLE, grey=len(FULL.parts) + 1) is None


def noisy_colors(image: CameraImage, noise: float) -> CameraImage:
    off = np.random.default_rng(2).normal(0.0, noise, image.bgr.shape) if noise else 0.0
    return replace(image, bgr=np.clip(np.rint(image.bgr + off), 0, 255).astype(np.uint8))
