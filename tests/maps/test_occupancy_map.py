"""Nav2's map files, and the lines in them."""

from math import cos, pi, sin
from pathlib import Path

import cv2
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from synthetic.occupancy_picture import write_occupancy

from mend.errors import WrongInputError
from mend.localization.distance_field import distance_field
from mend.maps.occupancy.lines import lines_of
from mend.maps.occupancy.nav2_file import MapFileError, read_occupancy_grid
from mend.maps.reading import read_map
from mend.maps.vector_map import VectorMap
from mend.maps.vector_map_file import read_vector_map

FLOOR = Path(__file__).parents[2] / "examples/localization/floor.vectormap.txt"
ROOM = VectorMap.of([[0, 0, 6, 0], [6, 0, 6, 4], [6, 4, 0, 4], [0, 4, 0, 0], [2, 0, 3, 2]])


def _along(vector_map: VectorMap) -> np.ndarray:
    share = np.linspace(0.0, 1.0, 50)[:, None, None]
    ends = vector_map.segments.reshape(1, -1, 2, 2)
    return (ends[:, :, 0] * (1 - share) + ends[:, :, 1] * share).reshape(-1, 2)


def _off_m(one: VectorMap, other: VectorMap) -> np.ndarray:
    return distance_field(other, 0.02, 1.0).at(_along(one))


def _write(folder: Path, picture: np.ndarray, **changed: object) -> Path:
    cv2.imwrite(str(folder / "map.png"), picture)
    fields = {"image": "map.png", "resolution": 0.5, "origin": [1.0, 2.0, 0.0]} | changed
    path = folder / "map.yaml"
    path.write_text("".join(f"{name}: {value}\n" for name, value in fields.items()))
    return path


@pytest.mark.parametrize("noise_m", [0.0, 0.015])
@pytest.mark.parametrize("vector_map", [ROOM, read_vector_map(FLOOR)], ids=["room", "floor"])
def test_walls_are_found_where_they_are(
    tmp_path: Path, vector_map: VectorMap, noise_m: float
) -> None:
    lines = read_map(write_occupancy(vector_map, tmp_path, noise_m=noise_m)).lines
    assert np.median(_off_m(vector_map, lines)) < 0.03
    assert np.percentile(_off_m(vector_map, lines), 98) < 0.08
    assert np.percentile(_off_m(lines, vector_map), 98) < 0.08
    assert lines.lengths.sum() == pytest.approx(vector_map.lengths.sum(), rel=0.1)


@settings(max_examples=15, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(yaw=st.floats(-pi, pi), resolution_m=st.floats(0.02, 0.1))
def test_the_picture_may_be_turned_and_of_any_resolution(
    tmp_path: Path, yaw: float, resolution_m: float
) -> None:
    path = write_occupancy(ROOM, tmp_path, yaw=yaw, resolution_m=resolution_m)
    lines = read_map(path).lines
    assert np.percentile(_off_m(ROOM, lines), 95) < 1.5 * resolution_m
    assert np.percentile(_off_m(lines, ROOM), 95) < 1.5 * resolution_m


def test_the_two_sides_of_a_thick_wall_are_two_walls(tmp_path: Path) -> None:
    picture = np.full((40, 60), 254, dtype=np.uint8)
    picture[10:14, 5:55] = 0
    lines = read_map(_write(tmp_path, picture, resolution=0.05, origin=[0, 0, 0])).lines
    long = lines.segments[lines.lengths > 1.0]
    assert sorted(round(float(y), 3) for y in long[:, 1]) == [1.325, 1.475]


def test_specks_are_no_walls(tmp_path: Path) -> None:
    picture = np.full((20, 20), 254, dtype=np.uint8)
    picture[4, 4] = picture[9:11, 9:11] = picture[15, 3:5] = 0
    assert len(read_map(_write(tmp_path, picture)).lines) == 0


def test_a_picture_without_walls_is_an_empty_map(tmp_path: Path) -> None:
    assert len(read_map(_write(tmp_path, np.full((5, 5), 205, dtype=np.uint8))).lines) == 0


def test_cells_are_placed_from_the_lower_left_corner(tmp_path: Path) -> None:
    picture = np.full((4, 6), 254, dtype=np.uint8)
    grid = read_occupancy_grid(_write(tmp_path, picture, origin=[1.0, 2.0, 0.3]))
    lower_left = grid.places(np.array([[0.0, 3.0]]))[0]
    expected = (1.0 + 0.25 * cos(0.3) - 0.25 * sin(0.3), 2.0 + 0.25 * sin(0.3) + 0.25 * cos(0.3))
    assert lower_left == pytest.approx(expected)


@pytest.mark.parametrize(
    ("mode", "negate", "occupied", "free"),
    [
        ("trinary", 0, [True, False, False], [False, False, True]),
        ("trinary", 1, [False, False, True], [True, False, False]),
        ("scale", 0, [True, False, False], [False, False, True]),
    ],
)
def test_dark_is_occupied_unless_negated(
    tmp_path: Path, mode: str, negate: int, occupied: list[bool], free: list[bool]
) -> None:
    picture = np.array([[0, 150, 254]], dtype=np.uint8)
    grid = read_occupancy_grid(_write(tmp_path, picture, mode=mode, negate=negate))
    assert grid.occupied.tolist() == [occupied]
    assert grid.free.tolist() == [free]


def test_a_raw_picture_holds_occupancies(tmp_path: Path) -> None:
    picture = np.array([[0, 50, 100, 255]], dtype=np.uint8)
    grid = read_occupancy_grid(_write(tmp_path, picture, mode="raw"))
    assert grid.occupied.tolist() == [[False, False, True, False]]
    assert grid.free.tolist() == [[True, False, False, False]]


def test_what_is_transparent_is_unknown_and_colours_are_averaged(tmp_path: Path) -> None:
    picture = np.array([[[0, 0, 0, 0], [0, 0, 0, 255], [255, 255, 250, 255]]], dtype=np.uint8)
    grid = read_occupancy_grid(_write(tmp_path, picture))
    assert grid.occupied.tolist() == [[False, True, False]]
    assert grid.free.tolist() == [[False, False, True]]


def test_sixteen_bits_count_as_eight(tmp_path: Path) -> None:
    picture = np.array([[0, 65535]], dtype=np.uint16)
    assert read_occupancy_grid(_write(tmp_path, picture)).occupied.tolist() == [[True, False]]


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"resolution": 0}, r"map\.yaml:2: 'resolution' must be"),
        ({"origin": [1, 2]}, r"map\.yaml:3: 'origin"),
        ({"mode": "grey"}, "'mode' must be"),
        ({"occupied_thresh": 0.1}, "'free_thresh' has to be below 'occupied_thresh'"),
        ({"occupied_thresh": 65}, "'occupied_thresh' must be"),
        ({"image": "other.png"}, "other.png"),
        ({"image": "map.yaml"}, "not a picture that can be read"),
    ],
)
def test_what_is_wrong_with_a_map_file_is_said(
    tmp_path: Path, changed: dict[str, object], said: str
) -> None:
    path = _write(tmp_path, np.zeros((2, 2), dtype=np.uint8), **changed)
    with pytest.raises((MapFileError, WrongInputError, FileNotFoundError), match=said):
        read_occupancy_grid(path)


def test_a_list_is_no_map_file(tmp_path: Path) -> None:
    path = tmp_path / "map.yaml"
    path.write_text("- 1\n")
    with pytest.raises(MapFileError, match="a map file is a mapping, but this is"):
        read_occupancy_grid(path)


def test_lines_keep_the_map_s_name(tmp_path: Path) -> None:
    grid = read_occupancy_grid(write_occupancy(ROOM, tmp_path))
    assert lines_of(grid).name == "map"
