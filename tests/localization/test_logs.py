"""Logs: each format is read as it was meant, and mistakes are told."""

import gzip
from pathlib import Path

import numpy as np
import pytest
from localization_data import DATA
from written_csv import write_csv

from mend.errors import WrongInputError
from mend.localization.logs.carmen import read_carmen
from mend.localization.logs.csv_log import read_csv
from mend.localization.logs.log import Log, LogStep
from mend.localization.logs.reading import read_log
from mend.localization.logs.wean import read_wean
from mend.localization.pose import compose
from mend.localization.scan import Scan


def _flaser(pose: tuple[float, float, float], time_s: float, ranges: str = "1 2 50 50") -> str:
    told = " ".join(str(each) for each in pose)
    return f"FLASER {len(ranges.split())} {ranges} {told} {told} {time_s} host {time_s}"


def _odom(x: float, y: float, theta: float, time_s: float) -> str:
    return f"ODOM {x} {y} {theta} 0 0 0 {time_s} host {time_s}"


def _written(tmp_path: Path, *lines: str) -> Path:
    path = tmp_path / "drive.log"
    path.write_text("\n".join(lines) + "\n")
    return path


def test_corrected_logs_give_motions_within_a_scan_only(tmp_path: Path) -> None:
    # After the second scan the poses jump by 0.3 m: that is the correction, not a motion.
    path = _written(
        tmp_path,
        _flaser((0, 0, 0), 1.0),
        "NEFF 30",
        _odom(0.5, 0, 0, 1.5),
        _odom(1.0, 0, 0, 1.9),
        _flaser((1.3, 0, 0), 2.0),
        "NEFF 30",
        _odom(2.3, 0, 0, 2.5),
        _flaser((2.2, 0, 0), 3.0),
    )
    log = read_carmen(path)
    assert [step.odometry[0] for step in log.steps] == pytest.approx([0.0, 1.0, 1.0])
    assert log.references[:, 0] == pytest.approx([0.0, 1.3, 2.2])
    assert log.path_m() == pytest.approx(2.2)


def test_raw_logs_have_no_reference(tmp_path: Path) -> None:
    path = _written(
        tmp_path,
        _odom(0, 0, 0, 0.9),
        _flaser((0, 0, np.pi / 2), 1.0),
        _flaser((0, 1, np.pi / 2), 2.0),
    )
    log = read_carmen(path)
    assert log.start is None
    assert log.steps[1].odometry == pytest.approx([1.0, 0.0, 0.0])


def test_a_laser_pose_that_wanders_from_the_odometry_is_a_reference(tmp_path: Path) -> None:
    lines = [
        f"FLASER 2 1 2 {x + correction} 0 0 {x} 0 0 {x} host {x}"
        for x, correction in ((0.0, 0.0), (1.0, 0.1), (2.0, 0.3))
    ]
    log = read_carmen(_written(tmp_path, *lines))
    assert log.references[:, 0] == pytest.approx([0.0, 1.1, 2.3])
    assert [step.odometry[0] for step in log.steps] == pytest.approx([0.0, 1.0, 1.0])


def test_a_robot_laser_with_its_mount(tmp_path: Path) -> None:
    line = "ROBOTLASER1 0 -1.0 2.0 0.5 81 0.01 0 3 1 2 3 1 9 1.2 0 0 1 0 0 0 0 0 0 0 7.5 host 7.5"
    log = read_carmen(_written(tmp_path, line))
    scan = log.steps[0].scan
    assert scan.angles == pytest.approx([-1.0, -0.5, 0.0])
    assert scan.sensor_offset == pytest.approx([0.2, 0.0, 0.0])
    assert scan.time_s == 7.5


@pytest.mark.parametrize("beams", [180, 181, 360, 361])
def test_half_circles_are_known_by_their_beams(tmp_path: Path, beams: int) -> None:
    log = read_carmen(_written(tmp_path, _flaser((0, 0, 0), 1.0, " ".join(["1"] * beams))))
    scan = log.steps[0].scan
    assert np.degrees(scan.angle_min) == pytest.approx(-90.0)
    assert np.degrees(scan.angle_increment) == pytest.approx(1.0 if beams < 200 else 0.5)


def test_lines_that_are_cut_off_are_skipped_and_counted(tmp_path: Path) -> None:
    path = _written(
        tmp_path, _flaser((0, 0, 0), 1.0), "FLASER 180 1 2", "FLASER x", "ODOM 1 nan 2", "PARAM a b"
    )
    log = read_carmen(path)
    assert (len(log), log.skipped) == (1, 3)


def test_scans_with_another_number_of_beams_are_left_out_but_not_their_motion(
    tmp_path: Path,
) -> None:
    path = _written(
        tmp_path,
        _flaser((0, 0, 0), 1.0),
        _flaser((1, 0, 0), 2.0, "1 2 3"),
        _flaser((2, 0, 0), 3.0),
    )
    log = read_carmen(path)
    assert [step.odometry[0] for step in log.steps] == pytest.approx([0.0, 2.0])
    assert log.skipped == 1


def test_time_never_runs_backwards(tmp_path: Path) -> None:
    log = read_carmen(_written(tmp_path, _flaser((0, 0, 0), 5.0), _flaser((0, 0, 0), 4.0)))
    assert [step.scan.time_s for step in log.steps] == [5.0, 5.0]


def test_the_largest_range_is_no_return(tmp_path: Path) -> None:
    log = read_carmen(_written(tmp_path, _flaser((0, 0, 0), 1.0, "1 2 81.91 81.83")))
    assert log.steps[0].scan.returns(0.0, 100.0).tolist() == [True, True, False, False]


def test_a_log_without_scans_says_so(tmp_path: Path) -> None:
    with pytest.raises(WrongInputError, match="there is no scan"):
        read_log(_written(tmp_path, "PARAM robot_use_laser on"))


def test_what_is_no_log_says_what_would_be(tmp_path: Path) -> None:
    with pytest.raises(WrongInputError, match="neither a CARMEN log"):
        read_log(_written(tmp_path, "Dear diary"))


def test_a_damaged_archive_says_so(tmp_path: Path) -> None:
    path = tmp_path / "drive.log.gz"
    path.write_bytes(gzip.compress(b"ODOM 0 0 0 0 0 0 1 host 1\n" * 1000)[:40])
    with pytest.raises(WrongInputError, match="damaged"):
        read_log(path)


def test_wean_logs_are_in_centimetres(tmp_path: Path) -> None:
    ranges = " ".join(["100"] * 179 + ["8183"])
    path = _written(
        tmp_path,
        "O 0 0 0 0.1",
        f"L 0 0 0 25 0 0 {ranges} 0.2",
        f"L 50 0 0 75 0 0 {ranges} 0.3",
        "L 1 2 3",
    )
    log = read_log(path)
    assert log.steps[1].odometry == pytest.approx([0.5, 0.0, 0.0])
    assert log.steps[0].scan.sensor_offset == pytest.approx([0.25, 0.0, 0.0])
    assert log.steps[0].scan.returns(0.0, 100.0).sum() == 179
    assert (log.start, log.skipped) == (None, 1)


def test_csv_is_read_as_it_was_written(tmp_path: Path) -> None:
    steps = [
        LogStep(
            np.array([0.1 * number, 0.0, 0.02]) if number else np.zeros(3),
            Scan(np.array([1.0, np.inf, 3.0]), -0.5, 0.5, 8.0, number / 10, np.array([0.1, 0, 0])),
            np.array([number, 2.0, -1.0]),
        )
        for number in range(3)
    ]
    path = tmp_path / "drive.csv"
    write_csv(Log("drive", tuple(steps)), path)
    again = read_log(path)
    for step, read in zip(steps, again.steps, strict=True):
        assert read.odometry == pytest.approx(step.odometry, abs=2e-4)
        assert read.reference == pytest.approx(step.reference)
        assert read.scan.ranges == pytest.approx(step.scan.ranges)
        assert read.scan.sensor_offset == pytest.approx(step.scan.sensor_offset)


@pytest.mark.parametrize(
    ("row", "said"),
    [
        ("0.2,0,0", "drive.csv:6: expected 6 columns, found 3"),
        ("0.2,0,0,nan,1,2", "drive.csv:6: odom_x, odom_y, odom_theta have to be finite"),
        ("0.2,0,0,0,1,wall", "drive.csv:6: b has to be a number, which 'wall' is not"),
    ],
)
def test_mistakes_in_csv_are_told_with_their_line(tmp_path: Path, row: str, said: str) -> None:
    path = tmp_path / "drive.csv"
    head = (
        "# angle_min=0\n# angle_increment=0.1\n# max_range=8\ntime_s,odom_x,odom_y,odom_theta,a,b"
    )
    path.write_text(f"{head}\n0.1,0,0,0,1,2\n{row}\n")
    with pytest.raises(WrongInputError) as caught:
        read_csv(path)
    assert said in str(caught.value)


def test_csv_without_its_laser_says_what_is_missing(tmp_path: Path) -> None:
    path = tmp_path / "drive.csv"
    path.write_text("time_s,odom_x,odom_y,r0,r1\n")
    with pytest.raises(
        WrongInputError, match="angle_min, angle_increment, max_range, odom_theta missing"
    ):
        read_csv(path)


@pytest.mark.skipif(not DATA.is_dir(), reason="the published logs are not here")
def test_the_published_logs_hold_what_is_known_of_them() -> None:
    aces = read_log(DATA / "logs/aces-corrected.log.gz")
    assert (len(aces), aces.skipped) == (440, 0)
    assert aces.path_m() == pytest.approx(323.0, abs=1.0)
    off = np.array(
        [
            compose(before.reference, step.odometry)[:2] - step.reference[:2]
            for before, step in zip(aces.steps, aces.steps[1:], strict=False)
        ]
    )
    assert np.median(np.hypot(off[:, 0], off[:, 1])) == pytest.approx(0.051, abs=0.005)
    wean = read_wean(DATA / "wean/robotdata1.log")
    assert len(wean) == 713
    assert wean.path_m() == pytest.approx(41.2, abs=0.2)
