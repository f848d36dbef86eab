"""`mend localize` and `mend map` from end to end, on the example that comes with Mend."""

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import mend.server.cli
from mend.server.cli.failures import CommandLineError

EXAMPLE = Path(__file__).parents[2] / "examples/localization"
DRIVE, FLOOR = EXAMPLE / "drive.csv", EXAMPLE / "floor.vectormap.txt"


def _run(*arguments: object) -> str:
    done = CliRunner().invoke(mend.server.cli.app, [str(each) for each in arguments])
    if done.exception is not None:
        raise done.exception
    return done.stdout


@pytest.mark.slow
@pytest.mark.parametrize("method", ["enml", "cgr", "mcl"])
def test_the_example_is_followed_by_every_method(tmp_path: Path, method: str) -> None:
    plot = tmp_path / "pictures/drive.svg"
    told = json.loads(
        _run("localize", DRIVE, "--map", FLOOR, "--method", method, "--json", "--plot", plot)
    )
    assert set(told) == {
        "scans",
        "path_m",
        "median_error_m",
        "p95_error_m",
        "max_error_m",
        "median_error_deg",
        "lost_events",
        "first_lost_m",
        "ms_per_update_p50",
        "ms_per_update_p95",
    }
    assert told["lost_events"] == 0
    assert told["first_lost_m"] is None
    assert told["median_error_m"] < 0.1
    assert plot.read_text().startswith("<svg")


def test_for_people_there_is_a_table(tmp_path: Path) -> None:
    film = tmp_path / "drive.gif"
    told = _run("localize", DRIVE, "--map", FLOOR, "--method", "cgr", "--animate", film)
    assert "lost\t0 times" in told
    assert film.read_bytes().startswith(b"GIF8")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--method", "amcl"], "there is no method 'amcl'; there are enml, cgr, mcl"),
        (["--plot", "drive.bmp"], "has to end in .png or .svg"),
        (["--animate", "drive.avi"], "has to end in .mp4 or .gif"),
        (["--start", "1,2"], "three numbers x,y,theta"),
        (["--start", "1,2,nan"], "three numbers x,y,theta"),
    ],
)
def test_what_cannot_be_done_is_said(arguments: list[str], said: str) -> None:
    with pytest.raises(CommandLineError, match=said):
        _run("localize", DRIVE, "--map", FLOOR, *arguments)


def test_a_log_is_no_map_and_a_map_no_log() -> None:
    with pytest.raises(CommandLineError, match="expected 4 finite numbers"):
        _run("localize", DRIVE, "--map", DRIVE)
    with pytest.raises(CommandLineError, match="neither a CARMEN log"):
        _run("localize", FLOOR, "--map", FLOOR)
    with pytest.raises(CommandLineError, match="No such file"):
        _run("localize", DRIVE, "--map", EXAMPLE / "nowhere.txt")


@pytest.mark.parametrize("method", ["enml", "cgr", "mcl"])
@pytest.mark.parametrize("far", ["millimetres", "beyond all bounds"])
def test_a_map_that_cannot_be_in_metres_is_refused(tmp_path: Path, far: str, method: str) -> None:
    rows = np.loadtxt(FLOOR, delimiter=",")
    rows = rows * 1000 if far == "millimetres" else np.where(rows == rows.max(), 1e308, rows)
    path = tmp_path / "far.vectormap.txt"
    np.savetxt(path, rows, delimiter=",")
    with pytest.raises(CommandLineError, match="are these millimetres"):
        _run("localize", DRIVE, "--map", path, "--method", method)


def test_without_references_the_start_has_to_be_given(tmp_path: Path) -> None:
    log = tmp_path / "raw.log"
    log.write_text("FLASER 2 1 2 0 0 0 0 0 0 1.0 host 1.0\n")
    with pytest.raises(CommandLineError, match="--start x,y,theta"):
        _run("localize", log, "--map", FLOOR)


@pytest.mark.slow
def test_a_map_is_built_drawn_and_cleaned(tmp_path: Path) -> None:
    built, picture, cleaned = (tmp_path / each for each in ("a.json", "a.png", "b.txt"))
    assert "segments" in _run("map", "build", DRIVE, "-o", built, "--plot", picture)
    assert picture.stat().st_size > 1000
    assert "segments of" in _run("map", "clean", built, "--output", cleaned)
    assert len(cleaned.read_text().splitlines()) <= len(json.loads(built.read_text()))


def test_a_log_in_which_nothing_is_seen_gives_no_map(tmp_path: Path) -> None:
    log = tmp_path / "blind.log"
    log.write_text("FLASER 2 90 90 0 0 0 0 0 0 1.0 host 1.0\n")
    with pytest.raises(CommandLineError, match="no wall is to be seen"):
        _run("map", "build", log, "-o", tmp_path / "map.txt")
