"""Vector maps: what they refuse, and their files."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from localization_data import DATA

from mend.errors import WrongInputError
from mend.maps.vector_map import VectorMap
from mend.maps.vector_map_file import read_vector_map, write_vector_map


def test_it_knows_its_bounds_and_lengths() -> None:
    vector_map = VectorMap.of([[0, 0, 3, 4], [-1, 2, -1, 3]])
    assert vector_map.bounds == (-1.0, 0.0, 3.0, 4.0)
    assert vector_map.lengths == pytest.approx([5.0, 1.0])


def test_an_empty_map_has_no_extent() -> None:
    assert VectorMap.of([]).bounds == (0.0, 0.0, 0.0, 0.0)


def test_its_segments_cannot_be_changed() -> None:
    vector_map = VectorMap.of([[0, 0, 1, 1]])
    with pytest.raises(ValueError, match="read-only"):
        vector_map.segments[0, 0] = 5.0


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        (np.zeros((2, 3)), "rows of 4 numbers"),
        (np.array([[0, 0, 1, 1], [0, np.nan, 1, 1]]), "segment 2"),
        (np.array([[0, 0, np.inf, 1]]), "not finite"),
    ],
)
def test_it_refuses_what_is_no_segment(rows: np.ndarray, said: str) -> None:
    with pytest.raises(WrongInputError, match=said):
        VectorMap(rows)


@pytest.mark.parametrize("name", ["map.vectormap.txt", "map.vectormap.json"])
@given(
    rows=st.lists(
        st.tuples(*[st.floats(-1e4, 1e4).map(lambda value: round(value, 4))] * 4), max_size=8
    )
)
@settings(max_examples=15, deadline=None)
def test_what_is_written_is_read_again(
    tmp_path_factory: pytest.TempPathFactory, name: str, rows: list[tuple[float, ...]]
) -> None:
    path = tmp_path_factory.mktemp("maps") / name
    vector_map = VectorMap.of(rows)
    write_vector_map(vector_map, path)
    again = read_vector_map(path)
    assert again.segments == pytest.approx(vector_map.segments, abs=1e-9)
    assert again.name == "map"


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("a.txt", "0,0,1,1\n\n1,2,3\n", "a.txt:3: expected 4 finite numbers"),
        ("a.txt", "0,0,1,nan\n", "a.txt:1: expected 4 finite numbers"),
        ("a.txt", "walls\n", "found 'walls'"),
        ("a.json", '[{"p0": {"x": 0, "y": 0}}]', "segment 1: p1: Field required"),
        ("a.json", '[\n{"p0": }]', "a.json:2: not JSON"),
        ("a.json", '{"p0": 1}', "a list of segments"),
        ("a.json", '[{"p0":{"x":NaN,"y":0},"p1":{"x":1,"y":0}}]', "p0.x"),
    ],
)
def test_mistakes_of_a_file_are_told_with_their_place(
    tmp_path: Path, name: str, text: str, said: str
) -> None:
    path = tmp_path / name
    path.write_text(text)
    with pytest.raises(WrongInputError) as caught:
        read_vector_map(path)
    assert said in str(caught.value)


def test_a_file_of_bytes_is_no_map(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_bytes(b"\xff\xfe\x00\x80")
    with pytest.raises(WrongInputError, match="not a text file"):
        read_vector_map(path)


@pytest.mark.skipif(not DATA.is_dir(), reason="the published maps are not here")
def test_both_published_formats_hold_the_same_map() -> None:
    text = read_vector_map(DATA / "maps/GHC7.vectormap.txt")
    json = read_vector_map(DATA / "maps/GHC7.vectormap.json")
    assert len(text) == 2171
    assert text.segments == pytest.approx(json.segments, abs=2e-4)


def test_a_number_that_is_too_long_is_told(tmp_path: Path) -> None:
    path = tmp_path / "map.json"
    path.write_text('[{"p0": {"x": ' + "9" * 5000 + ', "y": 0}, "p1": {"x": 1, "y": 0}}]')
    with pytest.raises(WrongInputError, match="a number in it is too long"):
        read_vector_map(path)
