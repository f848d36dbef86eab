"""Scans: what is refused, what counts as a return, points and their normals."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mend.localization.points import scan_points
from mend.localization.scan import InvalidScanError, Scan, ScanStream

STILL = np.zeros(3)


def _scan(ranges: list[float], time_s: float = 0.0, **changed: object) -> Scan:
    fields: dict[str, object] = {
        "angle_min": -0.5,
        "angle_increment": 0.1,
        "max_range": 8.0,
        "time_s": time_s,
    }
    return Scan(np.array(ranges), **(fields | changed))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"angle_increment": 0.0}, "above 0"),
        ({"max_range": float("nan")}, "above 0"),
        ({"angle_min": float("inf")}, "finite"),
        ({"time_s": float("nan")}, "finite"),
        ({"sensor_offset": np.zeros(2)}, "sensor's offset"),
    ],
)
def test_a_scan_that_makes_no_sense_is_refused(changed: dict[str, object], said: str) -> None:
    with pytest.raises(InvalidScanError, match=said):
        _scan([1.0, 1.0], **changed)


@pytest.mark.parametrize("ranges", [np.empty(0), np.ones(1), np.ones((2, 2))])
def test_a_scan_needs_a_row_of_ranges(ranges: np.ndarray) -> None:
    with pytest.raises(InvalidScanError, match="ranges in a row"):
        Scan(ranges, 0.0, 0.1, 8.0)


def test_what_cannot_follow_is_refused_and_forgotten() -> None:
    stream = ScanStream()
    stream.accept(STILL, _scan([1.0, 2.0], 5.0))
    with pytest.raises(InvalidScanError, match="expected 2 ranges"):
        stream.accept(STILL, _scan([1.0, 2.0, 3.0], 6.0))
    with pytest.raises(InvalidScanError, match="4 s, is before the last one's, 5 s"):
        stream.accept(STILL, _scan([1.0, 2.0], 4.0))
    with pytest.raises(InvalidScanError, match="odometry needs 3 finite"):
        stream.accept(np.array([np.nan, 0.0, 0.0]), _scan([1.0, 2.0], 6.0))
    assert stream.accept(STILL, _scan([1.0, 2.0], 5.0)).tolist() == [0.0, 0.0, 0.0]


def test_only_what_came_back_is_a_point() -> None:
    scan = _scan([1.0, np.nan, 0.0, -1.0, np.inf, 8.0, 9.0, 2.0])
    assert scan_points(scan).beams.tolist() == [0, 7]


def test_nothing_came_back_gives_no_points() -> None:
    assert len(scan_points(_scan([np.inf] * 5))) == 0


@pytest.mark.parametrize(
    ("ranges", "covered"),
    [
        ([0.1] * 20, True),
        ([0.1] * 11 + [np.inf] * 9, True),
        ([0.1] * 10 + [np.inf] * 10, False),
        ([0.1] * 19 + [3.0], True),
        ([0.1] * 17 + [3.0] * 3, False),
        ([0.5] * 20, False),
        ([np.nan] * 20, False),
        ([0.0] * 20, False),
    ],
)
def test_a_laser_is_covered_that_sees_hardly_anything_but_its_cover(
    ranges: list[float], covered: bool
) -> None:
    assert _scan(ranges).is_covered(0.4) == covered


def test_points_are_in_the_robots_frame() -> None:
    scan = Scan(np.array([2.0, 2.0]), 0.0, 0.1, 8.0, 0.0, np.array([0.2, 0.1, np.pi / 2]))
    assert scan_points(scan).points[0] == pytest.approx([0.2, 2.1])


@given(
    beams=st.integers(180, 1081),
    bearing=st.floats(-1.0, 1.0),
    distance=st.floats(0.5, 5.0),
)
@settings(max_examples=25, deadline=None)
def test_normals_of_a_wall_face_the_sensor(beams: int, bearing: float, distance: float) -> None:
    increment = 1.5 * np.pi / (beams - 1)
    angles = -0.75 * np.pi + np.arange(beams) * increment
    with np.errstate(divide="ignore"):
        ranges = distance / np.cos(angles - bearing)
    ranges[np.abs(angles - bearing) > 1.3] = np.inf
    seen = scan_points(Scan(ranges, angles[0], increment, 20.0))
    towards = -np.array([np.cos(bearing), np.sin(bearing)])
    assert len(seen) > 20
    assert seen.normals == pytest.approx(np.tile(towards, (len(seen), 1)), abs=1e-6)


def test_at_a_corner_each_side_keeps_its_normal() -> None:
    angles = np.radians(np.arange(-60, 61))
    ranges = np.minimum(
        2.0 / np.cos(angles), np.where(angles > 0, 1.5 / np.sin(angles + 1e-12), 99)
    )
    seen = scan_points(Scan(ranges, angles[0], np.radians(1.0), 20.0))
    ahead = np.isclose(seen.points[:, 0], 2.0)
    assert seen.normals[ahead] == pytest.approx(np.tile([-1.0, 0.0], (ahead.sum(), 1)), abs=0.05)
    assert seen.normals[~ahead] == pytest.approx(
        np.tile([0.0, -1.0], ((~ahead).sum(), 1)), abs=0.05
    )


def test_a_lonely_point_has_no_normal() -> None:
    ranges = [np.inf] * 9
    ranges[4] = 2.0
    assert scan_points(_scan(ranges)).normals.tolist() == [[0.0, 0.0]]
