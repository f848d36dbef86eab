"""`mend localize` on what users have: bags, occupancy maps, and a localizer to be judged."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from synthetic.occupancy_picture import write_occupancy
from typer.testing import CliRunner
from written_bag import BagFormat, BagMessages, messages_of

import mend.server.cli
from mend.localization.logs.reading import read_log
from mend.localization.pose import compose
from mend.maps.vector_map_file import read_vector_map
from mend.server.cli.failures import CommandLineError

EXAMPLE = Path(__file__).parents[2] / "examples/localization"
DRIVE, FLOOR = EXAMPLE / "drive.csv", EXAMPLE / "floor.vectormap.txt"
LOST_FROM = 60


def _run(*arguments: object) -> str:
    done = CliRunner().invoke(mend.server.cli.app, [str(each) for each in arguments])
    if done.exception is not None:
        raise done.exception
    return done.stdout


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    """The example's drive; the localizer of /amcl_pose is lost from one step on."""
    log = read_log(DRIVE)
    aside = np.array([1.5, 0.5, 0.2])
    steps = [
        step
        if number < LOST_FROM or step.reference is None
        else replace(step, reference=compose(step.reference, aside))
        for number, step in enumerate(log.steps)
    ]
    messages = BagMessages(BagFormat.SQLITE)
    sent = messages_of(replace(log, steps=tuple(steps)), messages)
    return messages.write(tmp_path / "drive", sent)


@pytest.fixture
def floor(tmp_path: Path) -> Path:
    """The example's floor, as Nav2 has it."""
    return write_occupancy(read_vector_map(FLOOR), tmp_path / "floor", noise_m=0.015)


@pytest.mark.slow(seconds=5)
def test_a_lost_localizer_is_found_out(tmp_path: Path, bag: Path, floor: Path) -> None:
    report, picture = tmp_path / "out/report.html", tmp_path / "out/judged.svg"
    told = json.loads(
        _run(
            *("localize", bag, "--map", floor, "--judge", "/amcl_pose", "--json"),
            *("--report", report, "--plot", picture),
        )
    )
    (stretch,) = told["stretches"]
    assert stretch["standing"] == "lost"
    assert stretch["since"]["step"] == LOST_FROM
    assert stretch["until"] is None
    assert told["judged"] == "/amcl_pose"
    page = report.read_text()
    assert "It was lost once, first from" in page
    assert "<svg" in page
    assert picture.read_text().startswith("<svg")


@pytest.mark.slow(seconds=5)
def test_for_people_it_is_said_in_a_sentence(bag: Path) -> None:
    told = _run("localize", bag, "--map", FLOOR, "--judge", "amcl_pose", "--method", "mcl")
    first, second = told.splitlines()
    assert first.startswith("amcl_pose: It was lost once, first from 15.")
    assert second.startswith("- lost since 15.")
    assert "until the end" in second


def test_the_lines_of_a_map_are_drawn_over_its_cells(
    tmp_path: Path, bag: Path, floor: Path
) -> None:
    picture = tmp_path / "map.svg"
    _run(
        *("localize", bag, "--map", floor, "--reference", "/amcl_pose", "--method", "cgr"),
        *("--plot-map", picture),
    )
    assert "lines" in picture.read_text()


def test_lines_are_written_as_a_vector_map(tmp_path: Path, floor: Path) -> None:
    lines, picture = tmp_path / "lines.txt", tmp_path / "lines.png"
    assert "segments" in _run("map", "lines", floor, "-o", lines, "--plot", picture)
    assert len(read_vector_map(lines)) > 10
    assert picture.stat().st_size > 1000


def test_without_a_start_the_topics_that_tell_one_are_named(bag: Path) -> None:
    with pytest.raises(CommandLineError, match=r"--reference .* in the bag: /amcl_pose .*, /odom"):
        _run("localize", bag, "--map", FLOOR)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--judge", "/amcl_pose"], "only a ROS bag has topics and frames to choose"),
        (["--scan", "/scan"], "only a ROS bag has topics"),
        (["--report", "a.html"], "--report is about what --judge finds"),
        (["--judge", "a", "--reference", "b"], "--reference cannot stand with it"),
        (["--judge", "a", "--animate", "a.mp4"], "but no animation"),
        (["--judge", "a", "--report", "a.pdf"], "has to end in .html"),
        (["--laser-pose", "1,2"], "--laser-pose needs three numbers"),
        (["--plot-map", "a.bmp"], "has to end in .png or .svg"),
    ],
)
def test_what_cannot_be_done_is_said(arguments: list[str], said: str) -> None:
    with pytest.raises(CommandLineError, match=said):
        _run("localize", DRIVE, "--map", FLOOR, *arguments)


def test_a_bag_that_is_not_there_is_said_plainly(tmp_path: Path) -> None:
    with pytest.raises(CommandLineError, match=r"nowhere\.bag': No such file"):
        _run("localize", tmp_path / "nowhere.bag", "--map", FLOOR)


@pytest.mark.slow
def test_a_map_is_built_of_a_bag(tmp_path: Path, bag: Path) -> None:
    built = tmp_path / "built.txt"
    assert "segments" in _run("map", "build", bag, "-o", built, "--reference", "/amcl_pose")
