"""Vector maps as files: one `x0,y0,x1,y1` per line, or JSON with `p0` and `p1`."""

import json
from pathlib import Path

import numpy as np
from pydantic import BaseModel, ConfigDict, FiniteFloat, TypeAdapter, ValidationError

from mend.errors import WrongInputError
from mend.maps.vector_map import VectorMap

_MAX_TOLD = 10
MAX_BYTES = 64 * 1024 * 1024
"""Larger files are not vector maps of a building's floor."""


class _End(BaseModel):
    model_config = ConfigDict(extra="ignore")
    x: FiniteFloat
    y: FiniteFloat


class _Segment(BaseModel):
    model_config = ConfigDict(extra="ignore")
    p0: _End
    p1: _End


_SEGMENTS = TypeAdapter(list[_Segment])


def read_vector_map(path: Path) -> VectorMap:
    """The vector map of a `.txt` or `.json` file. Raises `WrongInputError`, or `OSError`."""
    if path.stat().st_size > MAX_BYTES:
        raise WrongInputError(f"{path}: too large for a vector map ({MAX_BYTES >> 20} MB at most)")
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise WrongInputError(f"{path}: not a text file, so not a vector map") from error
    name = path.name.split(".")[0]
    if path.suffix == ".json" or text.lstrip().startswith("["):
        return VectorMap(_json_segments(text, path), name)
    return VectorMap(_text_segments(text, path), name)


def write_vector_map(vector_map: VectorMap, path: Path) -> None:
    """Write as `.json` where the path ends so, else as text, with tenths of millimetres."""
    rows = vector_map.segments.round(4) + 0.0  # no -0.0
    if path.suffix == ".json":
        ends = [
            {"p0": {"x": row[0], "y": row[1]}, "p1": {"x": row[2], "y": row[3]}}
            for row in rows.tolist()
        ]
        text = "[\n" + ",\n".join(json.dumps(each) for each in ends) + "\n]\n"
    else:
        text = "".join(",".join(f"{value:.4f}" for value in row) + "\n" for row in rows)
    path.write_text(text, encoding="utf-8")


def _text_segments(text: str, path: Path) -> np.ndarray:
    rows: list[list[float]] = []
    mistakes: list[str] = []
    for number, line in enumerate(text.splitlines(), start=1):
        stripped = line.split("#")[0].strip()
        if not stripped:
            continue
        fields = stripped.replace(",", " ").split()
        try:
            row = [float(field) for field in fields]
        except ValueError:
            row = []
        if len(row) != 4 or not np.isfinite(row).all():
            mistakes.append(
                f"{path}:{number}: expected 4 finite numbers x0,y0,x1,y1, found '{stripped[:60]}'"
            )
        rows.append(row)
    _tell(mistakes, path)
    return np.array(rows, dtype=np.float64).reshape(-1, 4)


def _json_segments(text: str, path: Path) -> np.ndarray:
    try:
        read = _SEGMENTS.validate_python(json.loads(text))
    except json.JSONDecodeError as error:
        raise WrongInputError(f"{path}:{error.lineno}: not JSON: {error.msg}") from error
    except RecursionError as error:
        raise WrongInputError(f"{path}: nested too deeply for a vector map") from error
    except ValidationError as error:
        _tell([_describe(dict(each), path) for each in error.errors()], path)
        raise
    except ValueError as error:
        # A number with more digits than Python reads.
        raise WrongInputError(f"{path}: a number in it is too long") from error
    rows = [[each.p0.x, each.p0.y, each.p1.x, each.p1.y] for each in read]
    return np.array(rows, dtype=np.float64).reshape(-1, 4)


def _describe(mistake: dict[str, object], path: Path) -> str:
    where = mistake["loc"]
    assert isinstance(where, tuple)
    if not where:
        return f"{path}: a vector map is a list of segments with p0 and p1"
    field = ".".join(str(each) for each in where[1:])
    return f"{path}: segment {int(where[0]) + 1}: {field or 'the segment'}: {mistake['msg']}"


def _tell(mistakes: list[str], path: Path) -> None:
    if mistakes:
        told = mistakes[:_MAX_TOLD]
        if len(mistakes) > _MAX_TOLD:
            told.append(f"{path}: and {len(mistakes) - _MAX_TOLD} more mistakes")
        raise WrongInputError("\n".join(told))
