"""Colour models: every colour finds its object, in noise and other light, and files are checked."""

import colorsys

import numpy as np
import pytest
from drawn_scene import PARTS, DrawnScene, Resting
from scripted_body import trained_model

from mend.errors import WrongInputError
from mend.robots.vision.blob import find_blob
from mend.robots.vision.color_model import ColorModel, ColorSettings, Sample


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
    segmentation = trained_model().segment(scene.picture().bgr)
    for name in PARTS:
        mask = segmentation.mask(name)
        assert np.count_nonzero(mask) < 0.002 * mask.size


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
    colors = {"a": (20, 200, 30), "b": (220, 30, 40), "dark": (6, 14, 26)}
    model = ColorModel.train(
        {name: [sample(bgr)] for name, bgr in colors.items()},
        settings,
        {"a": (0.1, 0.9, 0.2)},
    )
    path = tmp_path / "colors.npz"
    model.save(path)
    loaded = ColorModel.load(path)
    assert loaded.names == ("a", "b", "dark")
    assert loaded.settings.hue_bins == 45
    assert loaded.settings.min_value == 20
    bgr = DrawnScene({"green_leg": Resting(0.5, 0.0), "blue_leg": Resting(0.6, -0.2)}).picture().bgr
    assert loaded.tints == model.tints == {"a": (0.1, 0.9, 0.2)}
    for name in colors:
        assert np.array_equal(model.segment(bgr).mask(name), loaded.segment(bgr).mask(name))
        black = loaded.segment(np.zeros_like(bgr))
        assert black.tells(name).all() == (name != "dark")


def test_an_object_it_was_not_trained_for_is_named() -> None:
    model = ColorModel.train({"a": [sample((20, 200, 30))]})
    with pytest.raises(WrongInputError, match="does not know 'b'; it knows a"):
        model.segment(patch((0, 0, 0))).mask("b")


def test_a_grey_object_has_no_hue_and_a_coloured_one_has() -> None:
    model = ColorModel.train({"grey": [sample((120, 120, 120))], "red": [sample((20, 20, 220))]})
    assert not model.has_hue("grey")
    assert model.has_hue("red")
    assert not model.segment(patch((120, 120, 120))).mask("grey").any()


@pytest.mark.parametrize("bgr", [(152, 145, 152), (70, 62, 66), (40, 30, 36)])
def test_the_noise_of_what_is_almost_grey_is_no_hue(bgr: tuple[float, float, float]) -> None:
    model = ColorModel.train({"greyish": [sample(bgr)], "red": [sample((20, 20, 220))]})
    assert not model.has_hue("greyish")
    assert model.has_hue("red")


def test_objects_of_one_hue_have_each_others_pixels() -> None:
    model = ColorModel.train(
        {
            "one": [sample((30, 30, 200))],
            "same": [sample((28, 31, 196))],
            "b": [sample((200, 9, 9))],
        }
    )
    segmentation = model.segment(patch((30, 30, 200)))
    for name in ("one", "same"):
        assert segmentation.mask(name).all()
    assert not segmentation.mask("b").any()


@pytest.mark.parametrize(
    ("one", "other", "alike"),
    [
        ((0.1, 0.5, 0.9), (0.1, 0.5, 0.9), True),
        ((0.1, 0.5, 0.9), (0.11, 0.51, 0.9), True),
        ((0.1, 0.5, 0.9), (0.1, 0.3, 0.9), False),
        ((0.3, 0.3, 0.3), (0.6, 0.6, 0.6), False),
    ],
)
def test_tints_tell_colors_apart_as_far_as_they_are_measured(one, other, alike: bool) -> None:
    samples = {name: [sample((30, 30, 200))] for name in ("one", "other")}
    model = ColorModel.train(samples, tints={"one": one, "other": other})
    assert model.look_alike("one", "other") is alike


def test_a_mask_of_another_size_is_refused() -> None:
    with pytest.raises(WrongInputError, match="a mask of 'a'"):
        ColorModel.train({"a": [Sample(patch((0, 200, 0)), np.ones((3, 3), np.uint8))]})


@pytest.mark.parametrize("content", [b"", b"no archive", b"PK\x03\x04broken"])
def test_what_is_no_model_is_refused_in_one_sentence(tmp_path, content: bytes) -> None:
    path = tmp_path / "colors.npz"
    path.write_bytes(content)
    with pytest.raises(WrongInputError, match="is not a colour model"):
        ColorModel.load(path)


def test_a_missing_file_and_another_version_are_told(tmp_path) -> None:
    path = tmp_path / "colors.npz"
    with pytest.raises(WrongInputError, match="there is no colour model at"):
        ColorModel.load(path)
    np.savez(path, version=np.array(99))
    with pytest.raises(WrongInputError, match="of version 99; this reads 4"):
        ColorModel.load(path)
    np.savez(path, names=np.array(["a"]))
    with pytest.raises(WrongInputError, match="is not a colour model"):
        ColorModel.load(path)
