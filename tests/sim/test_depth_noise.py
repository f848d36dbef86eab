"""Depth noise is as strong as published, the same for a seed, and leaves out what it must."""

import numpy as np
import pytest

from mend.sim.depth_noise import EXPOSURES, DepthNoise, PinholeOptics, exposures_from

OPTICS = PinholeOptics(460.0, (159.5, 119.5))
GREY = np.full((240, 320, 3), 128, np.uint8)


def flat(distance_m: float) -> np.ndarray:
    return np.full((240, 320), distance_m, np.float32)


def measure(depth, bgr=GREY, scale=1.0, seed=1, exposures=1):
    noise = DepthNoise(scale, np.random.default_rng(seed), exposures)
    return noise.measure(depth, bgr, OPTICS)


@pytest.mark.parametrize("distance_m", [0.6, 1.0, 1.5, 3.0])
def test_one_exposure_is_as_noisy_as_published(distance_m: float) -> None:
    middle = measure(flat(distance_m))[90:150, 130:190]
    expected_m = 0.0012 + 0.0019 * (distance_m - 0.4) ** 2
    assert np.isfinite(middle).all()
    assert middle.std() == pytest.approx(expected_m, rel=0.1)
    assert middle.mean() == pytest.approx(distance_m, abs=0.1 * expected_m)


def test_more_exposures_are_quieter() -> None:
    one, eight = (measure(flat(1.0), exposures=count) for count in (1, 8))
    assert np.nanstd(eight) == pytest.approx(np.nanstd(one) / np.sqrt(8), rel=0.1)


def test_a_scale_of_none_changes_nothing() -> None:
    depth = flat(1.0)
    assert measure(depth, scale=0.0) is depth


def test_the_same_seed_gives_the_same_depth() -> None:
    assert np.array_equal(measure(flat(1.0), seed=3), measure(flat(1.0), seed=3), equal_nan=True)
    assert not np.array_equal(
        measure(flat(1.0), seed=3), measure(flat(1.0), seed=4), equal_nan=True
    )


def test_depth_is_missing_at_edges_on_dark_things_and_far_away() -> None:
    depth, bgr = flat(1.0), GREY.copy()
    depth[:, 160:] = 1.2
    bgr[:40, :40] = 4
    depth[200:, :40] = 6.0
    measured = measure(depth, bgr, exposures=8)
    missing = np.isnan(measured)
    assert missing[:40, :40].all()
    assert missing[202:, :38].all()
    assert 0.3 < missing[60:180, 159:161].mean() < 0.7
    assert not missing[60:180, 60:150].any()


def test_fused_edges_show_one_surface_or_the_other() -> None:
    depth = flat(1.0)
    depth[:, 160:] = 1.2
    measured = measure(depth, exposures=8)[:, 155:165]
    measured = measured[np.isfinite(measured)]
    between = (measured > 1.02) & (measured < 1.18)
    assert between.mean() < 0.02


def test_what_is_seen_at_a_grazing_angle_has_no_depth() -> None:
    columns = np.arange(320, dtype=np.float32)
    # A wall that runs away along the view: its inverse depth is linear in the picture.
    depth = np.tile(1.0 / (0.3 + 0.0002 * columns), (240, 1)).astype(np.float32)
    steep = np.tile(1.0 / (0.5 + 0.01 * columns), (240, 1)).astype(np.float32)
    assert np.isfinite(measure(depth)[:, 5:-5]).mean() > 0.99
    assert np.isnan(measure(steep)[:, 2:8]).mean() > 0.9


def test_a_picture_that_comes_again_is_as_noisy_as_one_that_is_new() -> None:
    depth, bgr = flat(1.0), GREY.copy()
    depth[:, 160:] = 1.2
    bgr[:40, :40] = 14
    again, anew = (DepthNoise(1.0, np.random.default_rng(5)) for _ in range(2))
    first = again.measure(depth, bgr, OPTICS)
    assert np.array_equal(first, anew.measure(depth, bgr, OPTICS), equal_nan=True)
    second = again.measure(depth, bgr, OPTICS)
    assert np.array_equal(second, anew.measure(depth.copy(), bgr.copy(), OPTICS), equal_nan=True)
    assert not np.array_equal(first, second, equal_nan=True)


def test_what_is_farther_away_is_measured_as_surely_by_more_exposures() -> None:
    exposures = [exposures_from(distance_m) for distance_m in (0.8, 1.5, 2.5)]
    assert exposures == sorted(set(exposures))
    assert exposures[0] == EXPOSURES
    noise = [measure(flat(m), exposures=n) for m, n in zip((1.5, 2.5), exposures[1:], strict=True)]
    near, far = (each[90:150, 130:190].std() for each in noise)
    assert far == pytest.approx(near, rel=0.1)
