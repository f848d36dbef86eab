"""Nav2's (and ROS 1's) map files: a `map.yaml` beside its picture."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import cv2
import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field, FiniteFloat

from mend.documents.document import DocumentError, LinedMapping, read_document, read_text
from mend.documents.problem import InvalidFileError, Problem
from mend.documents.validation import show_kind, validate_part
from mend.errors import WrongInputError
from mend.maps.occupancy.grid import OccupancyGrid

MAX_CELLS = 100_000_000
"""More would be five hundred metres of floor each way, with cells of 5 cm."""
_OPAQUE = 255.0


class MapFileError(InvalidFileError):
    """A map file has mistakes."""


class GridMode(StrEnum):
    """How the picture's darkness becomes occupancy; names as in Nav2."""

    TRINARY = "trinary"
    SCALE = "scale"
    RAW = "raw"


_Share = Annotated[FiniteFloat, Field(ge=0.0, le=1.0)]


class _MapFile(BaseModel):
    """The fields that count, with Nav2's defaults; what else there is, is other programs' own."""

    model_config = ConfigDict(extra="ignore", frozen=True)

    image: str = Field(min_length=1)
    resolution: Annotated[FiniteFloat, Field(gt=0.0)]
    origin: tuple[FiniteFloat, FiniteFloat, FiniteFloat]
    negate: bool = False
    occupied_thresh: _Share = 0.65
    free_thresh: _Share = 0.25
    mode: GridMode = GridMode.TRINARY


def read_occupancy_grid(path: Path) -> OccupancyGrid:
    """The grid of a `map.yaml`. Raises `MapFileError`, `WrongInputError`, or `OSError`."""
    its = _read(path)
    picture = _read_picture(path.parent / its.image)
    occupied, free = _judged(picture, its)
    return OccupancyGrid(occupied, free, its.resolution, its.origin, path.name.split(".")[0])


def _read(path: Path) -> _MapFile:
    try:
        content, problems = read_document(read_text(path))
    except DocumentError as error:
        raise MapFileError(str(path), [error.problem]) from error
    if not isinstance(content, LinedMapping):
        message = f"a map file is a mapping, but this is {show_kind(content)}"
        raise MapFileError(str(path), [*problems, Problem(1, None, message)])
    read, wrong = validate_part(_MapFile, content)
    if read is not None and read.free_thresh >= read.occupied_thresh:
        message = "'free_thresh' has to be below 'occupied_thresh'"
        wrong.append(Problem(content.line_of("free_thresh"), None, message))
    if read is None or wrong or problems:
        raise MapFileError(str(path), [*problems, *wrong])
    return read


def _read_picture(path: Path) -> NDArray[Any]:
    data = np.fromfile(path, dtype=np.uint8)
    try:
        picture = cv2.imdecode(data, cv2.IMREAD_UNCHANGED) if len(data) else None
    except cv2.error:
        # What is damaged, or larger than OpenCV reads.
        picture = None
    if picture is None or picture.dtype not in (np.uint8, np.uint16):
        raise WrongInputError(f"{path}: not a picture that can be read (PGM or PNG)")
    if picture.shape[0] * picture.shape[1] > MAX_CELLS:
        raise WrongInputError(f"{path}: larger than {MAX_CELLS // 10**6} million cells")
    return picture


def _judged(picture: NDArray[Any], its: _MapFile) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Which cells are occupied and which are free."""
    whole = float(np.iinfo(picture.dtype).max)
    values = picture.astype(np.float32) * (_OPAQUE / whole)
    known = np.ones(values.shape[:2], dtype=bool)
    if values.ndim == 3 and values.shape[2] in (2, 4):
        known = values[..., -1] > 0.0
        values = values[..., :-1]
    if values.ndim == 3:
        values = values.mean(axis=2)
    if its.mode is GridMode.RAW:
        # There the picture's value is the occupancy, from 0 to 100; anything else is unknown.
        known &= values <= 100.0
        occupancy = values / 100.0
    else:
        occupancy = (values if its.negate else _OPAQUE - values) / _OPAQUE
    return known & (occupancy > its.occupied_thresh), known & (occupancy < its.free_thresh)
