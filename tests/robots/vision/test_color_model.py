"""Colour models: every colour finds its object, in noise and other light, and files are checked."""

import colorsys

import numpy as np
import pytest
from drawn_scene import PARTS, DrawnScene, Resting
from scripted_body import trained_model

from robots.vision.blob import find_blob
from robots.vision.color_model import ColorModel, ColorModelError, ColorSettings, Sample


def patch(bgr: tuple[float, float, float], size: int = 40) -> np.ndarray:
    return np.full((size, size, 3), bgr, np.uint8)


def sample(bgr: tuple[float, float, float]) -> Sample:
    return Sample(patch(bgr), np.full((40, 40), 1, np.uint8))


def many_colors(count: int) -> dict[str, tuple[float, float, float]]:
    return {
        f"o{i}": tuple(
            255 * c for c in reversed(colorsys.hsv_to_rgb((i % 16) / 16, 1 - 0.2 * (i // 16), 0.9))
        )
        for i in range(count)
    }


@pytest.mark.parametrize("light", [0.6, 1.0, 1.2])
@pytest.mark.parametrize("noise", [0.0, 6.0])
def test_every_part_is_found_among_all_others(light: float, noise: float) -> None:
    model = trained_model()
    spots = ((0.45, -0.5), (0.45, -0.3), (0.6, -0.42), (0.6, 0.1), (0.68, -0.2))
    parts = {name: Resting(*spot) for name, spot in zip(PARTS, spots, strict=True)}
    image = DrawnScene(dict(parts), noise=noise, light=light).picture()
    segmentation = model.segment(image.bgr)
    for name, where in parts.items():
        alone = DrawnScene({name: where}).picture()
        empty = DrawnScene().picture()
        truth = (alone.bgr != empty.bgr).any(axis=2)
        blob = find_blob(segmentation.mask(name))
        assert blob is not None
        found = blob.mask > 0
        assert (found & truth).sum() / (found | truth).sum() > 0.8


def test_table_and_grey_things_belong_to_no_object() -> None:
    scene = DrawnScene(grey_boxes=[((0.5, -0.2, 0.7), (0.2, 0.2, 0.2))], noise=4.0)
    labels = trained_model().segment(scene.picture().bgr).of_any()
    assert np.count_nonzero(labels) < 0.002 * labels.size


def test_sixty_four_colors_are_told_apart() -> None:
    colors = many_colors(64)
    model = ColorModel.train({name: [sample(bgr)] for name, bgr in colors.items()})
    for name, bgr in colors.items():
        own = np.count_nonzero(model.segment(patch(bgr)).mask(name))
        assert own > 0.9 * 40 * 40, name


def test_red_is_found_on_both_ends_of_the_hue_circle() -> None:
    model = ColorModel.train({"red": [sample((20, 0, 230))]})
    other_end = model.segment(patch((0, 8, 230))).mask("red")
    assert np.count_nonzero(other_end) == other_end.size


def test_a_saved_model_sees_the_same(tmp_path) -> None:
    settings = ColorSettings(hue_bins=45, saturation_bins=16, min_value=20)
    colors = {"a": (20, 200, 30), "b": (220, 30, 40)}
    model = ColorModel.train({name: [sample(bgr)] for name, bgr in colors.items()}, settings)
    path = tmp_path / "colors.npz"
    model.save(path)
    loaded = ColorModel.load(path)
    assert loaded.names == ("a", "b")
    assert loaded.settings.hue_bins == 45
    assert loaded.settings.min_value == 20
    bgr = DrawnScene({"green_leg": Resting(0.5, 0.0), "blue_leg": Resting(0.6, -0.2)}).picture().bgr
    for name in colors:
        assert np.array_equal(model.segment(bgr).mask(name), loaded.segment(bgr).mask(name))


def test_an_object_it_was_not_trained_for_is_named() -> None:
    model = ColorModel.train({"a": [sample((20, 200, 30))]})
    with pytest.raises(ColorModelError, match="does not know 'b'; it knows a"):
        model.segment(patch((0, 0, 0))).mask("b")


def test_a_grey_object_cannot_be_learned() -> None:
    with pytest.raises(ColorModelError, match="no pixel of 'grey' is coloured enough"):
        ColorModel.train({"grey": [sample((120, 120, 120))]})


def test_a_mask_of_another_size_is_refused() -> None:
    with pytest.raises(ColorModelError, match="a mask of 'a'"):
        ColorModel.train({"a": [Sample(patch((0, 200, 0)), np.ones((3, 3), np.uint8))]})


@pytest.mark.parametrize("content", [b"", b"no archive", b"PK\x03\x04broken"])
def test_what_is_no_model_is_refused_in_one_sentence(tmp_path, content: bytes) -> None:
    path = tmp_path / "colors.npz"
    path.write_bytes(content)
    with pytest.raises(ColorModelError, match="is not a colour model"):
        ColorModel.load(path)


def test_a_missing_file_and_another_version_are_told(tmp_path) -> None:
    path = tmp_path / "colors.npz"
    with pytest.raises(ColorModelError, match="there is no colour model at"):
        ColorModel.load(path)
    np.savez(path, version=np.array(99))
    with pytest.raises(ColorModelError, match="of version 99; this reads 1"):
        ColorModel.load(path)
    np.savez(path, names=np.array(["a"]))
    with pytest.raises(ColorModelError, match="is not a colour model"):
        ColorModel.load(path)
