"""Blobs: the largest clean patch, or all parts of one that something cuts in two."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from mend.robots.vision.blob import find_blob


def mask_with(*boxes: tuple[int, int, int, int]) -> np.ndarray:
    mask = np.zeros((120, 160), np.uint8)
    for left, top, width, height in boxes:
        mask[top : top + height, left : left + width] = 255
    return mask


def test_an_empty_mask_has_no_blob() -> None:
    assert find_blob(mask_with()) is None


def test_specks_are_no_blob() -> None:
    assert find_blob(mask_with((10, 10, 2, 2), (50, 60, 1, 9))) is None


@settings(deadline=None, max_examples=60)
@given(
    left=st.integers(4, 130),
    top=st.integers(4, 90),
    width=st.integers(6, 20),
    height=st.integers(6, 20),
)
def test_a_box_is_measured_exactly_wherever_it_is(left, top, width, height) -> None:
    blob = find_blob(mask_with((left, top, width, height)))
    assert blob is not None
    assert blob.area_px == width * height
    assert blob.box == (left, top, width, height)
    assert np.allclose(blob.center, (left + (width - 1) / 2, top + (height - 1) / 2))
    assert np.count_nonzero(blob.mask) == blob.area_px


def test_the_largest_of_two_patches_is_taken() -> None:
    blob = find_blob(mask_with((10, 10, 8, 8), (80, 60, 20, 10)))
    assert blob is not None
    assert blob.box == (80, 60, 20, 10)


def test_a_blob_cut_in_two_is_taken_whole() -> None:
    cut = mask_with((40, 40, 10, 10), (60, 40, 10, 10), (130, 100, 2, 2))
    blob = find_blob(cut, whole=True)
    assert blob is not None
    assert blob.area_px == 200
    assert np.allclose(blob.center, (54.5, 44.5))


def test_a_small_gap_is_closed() -> None:
    mask = mask_with((40, 40, 21, 21))
    mask[50, 50] = 0
    blob = find_blob(mask)
    assert blob is not None
    assert blob.area_px == 21 * 21
