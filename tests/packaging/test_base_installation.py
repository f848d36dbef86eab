"""What Mend does where none of its extras is installed."""

import json
import os
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import pytest

OF_EXTRAS = (
    "coal",
    "cv2",
    "numba",
    "ortools",
    "pinocchio",
    "pocketsphinx",
    "pybullet",
    "rosbags",
    "ruckig",
    "scipy",
    "sounddevice",
)
EXAMPLES = Path(__file__).parents[2] / "examples"

# What is None there cannot be imported; nor is it found by its name.
WITHOUT = f"""
import contextlib, importlib.util, io, json, sys
found = importlib.util.find_spec
importlib.util.find_spec = lambda name, *more: None if name in {OF_EXTRAS} else found(name, *more)
sys.modules.update(dict.fromkeys({OF_EXTRAS}))
from mend.server.cli import main
for arguments in json.load(sys.stdin):
    told, complaints, code = io.StringIO(), io.StringIO(), 0
    sys.argv = ["mend", *arguments]
    with contextlib.redirect_stdout(told), contextlib.redirect_stderr(complaints):
        try:
            main()
        except SystemExit as ended:
            code = ended.code
    print(json.dumps([code, told.getvalue(), complaints.getvalue()]))
"""
WORLDS = ("building", "tabletop", "workcell")
OTHERS = {
    ("schedule", str(EXAMPLES / "deliveries/corridor.yaml")): "scheduling",
    ("check", str(EXAMPLES / "deliveries/corridor.yaml")): "scheduling",
    (
        "localize",
        str(EXAMPLES / "localization/drive.csv"),
        "--map",
        str(EXAMPLES / "localization/floor.vectormap.txt"),
    ): "localization",
    ("train-colors", "colors.npz", "--scene", "eket"): "tabletop",
}
CHECKED = ("check", str(EXAMPLES / "tasks" / "shelf.yaml"))
LISTS = ("trees", "scenes", "scenarios")


def run_in(world: str) -> tuple[str, ...]:
    return ("run", "eket", "--world", world)


@dataclass(frozen=True)
class Outcome:
    """What a command came to."""

    code: int
    told: str
    complaints: str


Outcomes = Mapping[tuple[str, ...], Outcome]


@pytest.fixture(scope="module")
def outcomes(tmp_path_factory: pytest.TempPathFactory) -> Outcomes:
    """What all commands come to, one after the other in a process that has not even tried more."""
    folder = tmp_path_factory.mktemp("anywhere")
    commands = [*map(run_in, WORLDS), *OTHERS, CHECKED, *((each,) for each in LISTS)]
    done = subprocess.run(
        [sys.executable, "-c", WITHOUT],
        cwd=folder,
        env=os.environ | {"XDG_DATA_HOME": str(folder)},
        input=json.dumps(commands),
        capture_output=True,
        text=True,
    )
    assert (done.returncode, done.stderr) == (0, "")
    lines = done.stdout.splitlines()
    return {each: Outcome(*json.loads(line)) for each, line in zip(commands, lines, strict=True)}


@pytest.mark.slow
@pytest.mark.parametrize("world", WORLDS)
def test_a_simulated_world_says_what_it_needs(outcomes: Outcomes, world: str) -> None:
    done = outcomes[run_in(world)]
    assert done.code == 2
    told = f"the {world} world needs OpenCV: install Mend as 'mend-robots[{world}]'"
    assert told in done.complaints
    assert "Traceback" not in done.complaints


@pytest.mark.slow
@pytest.mark.parametrize(("arguments", "extra"), OTHERS.items(), ids=lambda each: each[0])
def test_a_command_says_what_it_needs(
    outcomes: Outcomes, arguments: tuple[str, ...], extra: str
) -> None:
    done = outcomes[arguments]
    assert done.code == 2
    assert f"install Mend as 'mend-robots[{extra}]'" in done.complaints
    assert "Traceback" not in done.complaints


@pytest.mark.slow
def test_a_task_for_live_robots_is_checked_without_any_extra(outcomes: Outcomes) -> None:
    done = outcomes[CHECKED]
    assert (done.code, done.complaints) == (0, "")


@pytest.mark.slow
@pytest.mark.parametrize("command", LISTS)
def test_what_there_is_is_listed_without_any_extra(outcomes: Outcomes, command: str) -> None:
    done = outcomes[command,]
    assert (done.code, done.complaints) == (0, "")
    assert "eket" in done.told
