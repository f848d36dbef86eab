"""Training pictures from a folder: what `mend train-colors` learns a colour model from."""

from pathlib import Path

import cv2
import numpy as np

from mend.errors import WrongInputError
from mend.robots.vision.color_model import Sample

MASK_SUFFIX = ".mask.png"


def load_samples(folder: Path) -> dict[str, list[Sample]]:
    """Read `folder/<object>/<picture>.png`, the object being where the mask is not black.

    The mask is the picture's own alpha channel or `<picture>.mask.png` beside it. Raises
    `WrongInputError` naming the file that is wrong or missing.
    """
    if not folder.is_dir():
        raise WrongInputError(f"there is no folder '{folder}' with training pictures")
    samples = {
        each.name: [_load_sample(path) for path in _pictures(each)]
        for each in sorted(folder.iterdir())
        if each.is_dir()
    }
    if not samples:
        raise WrongInputError(f"'{folder}' has no folder per object with pictures of it")
    for name, found in samples.items():
        if not found:
            raise WrongInputError(f"'{folder / name}' has no .png picture of '{name}'")
    return samples


def _pictures(folder: Path) -> list[Path]:
    return [path for path in sorted(folder.glob("*.png")) if not path.name.endswith(MASK_SUFFIX)]


def _load_sample(path: Path) -> Sample:
    picture = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
    if picture is None or picture.dtype != np.uint8 or picture.ndim != 3:
        raise WrongInputError(f"'{path}' is not a colour picture with 8 bits per channel")
    if picture.shape[2] == 4:
        bgra = np.asarray(picture, np.uint8)
        return Sample(np.ascontiguousarray(bgra[:, :, :3]), bgra[:, :, 3].copy())
    mask_path = path.with_name(path.stem + MASK_SUFFIX)
    mask = cv2.imread(str(mask_path), cv2.IMREAD_GRAYSCALE)
    if mask is None:
        raise WrongInputError(f"'{path}' has no alpha channel and no mask '{mask_path.name}'")
    return Sample(np.asarray(picture, np.uint8), np.asarray(mask, np.uint8))
