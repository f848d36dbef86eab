"""A picture tells of the table, or it is said why it does not."""

from dataclasses import replace

import numpy as np
import pytest
from drawn_scene import DrawnScene, Resting

from mend.robots.body import CameraImage
from mend.robots.vision.blindness import why_blind, why_frozen, why_outdated
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


def test_a_picture_of_what_has_changed_since_tells_nothing_however_fresh_it_claims_to_be() -> None:
    before = FULL.picture(time=10.0)
    again = replace(before, time=20.0)
    assert why_frozen(again, None) is None
    assert why_frozen(again, before) is not None
    assert why_frozen(replace(FULL, light=0.9).picture(), before) is None
