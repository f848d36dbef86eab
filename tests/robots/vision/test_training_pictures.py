"""Training pictures from a folder, and one sentence for each thing that is wrong with it."""

import cv2
import numpy as np
import pytest

from mend.errors import WrongInputError
from mend.robots.vision.color_model import ColorModel
from mend.robots.vision.training import load_samples


def write_picture(path, channels: int = 3) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    picture = np.zeros((20, 20, channels), np.uint8)
    picture[:, :, 1] = 200
    if channels == 4:
        picture[5:15, 5:15, 3] = 255
    cv2.imwrite(str(path), picture)


def test_alpha_and_mask_files_both_serve(tmp_path) -> None:
    write_picture(tmp_path / "green" / "one.png", channels=4)
    write_picture(tmp_path / "green" / "two.png")
    mask = np.zeros((20, 20), np.uint8)
    mask[:10] = 255
    cv2.imwrite(str(tmp_path / "green" / "two.mask.png"), mask)
    samples = load_samples(tmp_path)
    assert [np.count_nonzero(each.mask) for each in samples["green"]] == [100, 200]
    model = ColorModel.train(samples)
    assert np.count_nonzero(model.segment(samples["green"][0].bgr).mask("green")) == 400


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("nowhere", "there is no folder"),
        ("empty", "has no folder per object"),
        ("bare", "has no .png picture of 'green'"),
        ("maskless", "has no alpha channel and no mask 'one.mask.png'"),
        ("broken", "is not a colour picture"),
    ],
)
def test_what_is_wrong_is_named(tmp_path, name: str, message: str) -> None:
    (tmp_path / "empty").mkdir()
    (tmp_path / "bare" / "green").mkdir(parents=True)
    write_picture(tmp_path / "maskless" / "green" / "one.png")
    (tmp_path / "broken" / "green").mkdir(parents=True)
    (tmp_path / "broken" / "green" / "one.png").write_bytes(b"no picture")
    with pytest.raises(WrongInputError, match=message):
        load_samples(tmp_path / name)
