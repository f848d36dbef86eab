"""What the colours in a region say of one part among all that the robot knows."""

import numpy as np
import pytest

from robots.grip.view import composition
from robots.vision.color_model import ColorModel, Sample

DARK, BRIGHT = (13.0, 18.0, 33.0), (80.0, 140.0, 240.0)
"""BGR of one hue; the first is hardly bright enough to have one."""

GREEN = (80.0, 240.0, 80.0)


def sample(bgr: tuple[float, float, float]) -> Sample:
    return Sample(np.full((40, 40, 3), bgr, np.uint8), np.full((40, 40), 1, np.uint8))


def picture(bgr: tuple[float, float, float]) -> np.ndarray:
    noise = np.random.default_rng(4).normal(0.0, 3.0, (40, 40, 3))
    return np.clip(bgr + noise, 0, 255).astype(np.uint8)


@pytest.mark.parametrize(("own", "other"), [(DARK, BRIGHT), (DARK[::-1], BRIGHT[::-1])])
def test_a_part_that_hardly_has_a_hue_is_not_taken_for_one_that_has(
    own: tuple[float, float, float], other: tuple[float, float, float]
) -> None:
    model = ColorModel.train(
        {"own": [sample(own)], "other": [sample(other)], "green": [sample(GREEN)]}
    )
    assert not model.has_hue("own")
    region = np.full((40, 40), 1, np.uint8)
    assert composition(region, model.segment(picture(own)), model, "own") is None
    swapped = composition(region, model.segment(picture(GREEN)), model, "own")
    assert swapped is not None
    assert swapped.other > 0.5
    assert swapped.most_other == "green"
