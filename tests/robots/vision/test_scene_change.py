"""A change is what noise and light do not explain."""

from dataclasses import replace

import cv2
import numpy as np
import pytest

from mend.robots.body import CameraImage
from mend.robots.vision.scene_change import has_patch, shows_change, still_measures

NOISE = 3.0
DEPTH_NOISE_M = 0.002


def picture(seed: int, gain: float = 1.0, box: tuple[int, int] | None = (60, 40)) -> CameraImage:
    """A table with a box of 10 x 10 pixels, 30 mm high."""
    rng = np.random.default_rng(seed)
    bgr = np.full((120, 160, 3), 150.0)
    depth = np.full((120, 160), 1.0)
    if box is not None:
        u, v = box
        bgr[v : v + 10, u : u + 10] = (40.0, 60.0, 200.0)
        depth[v : v + 10, u : u + 10] = 0.97
    bgr = np.clip(bgr * gain + rng.normal(0.0, NOISE, bgr.shape), 0.0, 255.0)
    depth += rng.normal(0.0, DEPTH_NOISE_M, depth.shape)
    depth[rng.random(depth.shape) < 0.02] = np.nan
    return CameraImage(
        bgr.astype(np.uint8), depth.astype(np.float32), np.eye(4), 200.0, (80.0, 60.0), float(seed)
    )


@pytest.mark.parametrize("seed", range(1, 11))
def test_noise_and_exposure_are_no_change(seed: int) -> None:
    assert not shows_change(picture(0), picture(seed, gain=1.0 + 0.04 * (seed % 3 - 1)))


@pytest.mark.parametrize("box", [(75, 40), (62, 43), None])
def test_what_moved_or_went_is_a_change(box: tuple[int, int] | None) -> None:
    assert shows_change(picture(0), picture(1, box=box))


@pytest.mark.parametrize("corner", [(0, 0), (150, 0), (0, 110), (150, 110)])
def test_what_is_gone_at_the_pictures_rim_is_a_change(corner: tuple[int, int]) -> None:
    stood = [picture(seed, box=corner) for seed in (0, 1)]
    assert not shows_change(*stood)
    assert shows_change(stood[0], picture(2, box=None))


def test_what_has_the_tables_colour_is_seen_by_its_depth() -> None:
    grey = [replace(each, bgr=np.full_like(each.bgr, 150)) for each in (picture(0), picture(1))]
    gone = replace(picture(2, box=None), bgr=grey[0].bgr)
    assert not shows_change(*grey)
    assert shows_change(grey[0], gone)


def test_another_place_of_the_camera_is_a_change() -> None:
    moved = np.eye(4)
    moved[0, 3] = 0.01
    assert shows_change(picture(0), replace(picture(0), pose=moved))


def test_the_same_picture_is_no_change() -> None:
    assert not shows_change(picture(0), replace(picture(0), time=9.0))


def test_what_is_measured_no_more_is_not_seen_any_more() -> None:
    before, now = picture(0), picture(1)
    mask = np.zeros((120, 160), np.uint8)
    mask[40:50, 60:70] = 255
    assert still_measures(before, now, mask)
    assert now.depth_m is not None
    for missing in (np.nan, 0.0):
        depth_m = now.depth_m.copy()
        depth_m[40:50, 60:68] = missing
        lost = replace(now, depth_m=depth_m)
        assert not still_measures(before, lost, mask)
        assert not shows_change(before, lost)


@pytest.mark.parametrize("pixels", [6, 9, 15])
def test_as_many_pixels_are_a_change_only_where_they_are_connected(pixels: int) -> None:
    """Wherever they are, at the rim too, and however they lie."""
    rng = np.random.default_rng(pixels)
    told = []
    for _ in range(200):
        changed = (rng.random((24, 32)) < rng.uniform(0.02, 0.3)).astype(np.uint8)
        _, _, stats, _ = cv2.connectedComponentsWithStats(changed)
        largest = int(stats[1:, cv2.CC_STAT_AREA].max(initial=0))
        assert has_patch(changed, pixels) == (largest >= pixels)
        told.append(largest >= pixels)
    assert any(told)
    assert not all(told)
