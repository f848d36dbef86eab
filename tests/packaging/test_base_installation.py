"""What Mend does where none of its extras is installed."""

import os
import subprocess
import sys
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
import importlib.util, sys
found = importlib.util.find_spec
importlib.util.find_spec = lambda name, *more: None if name in {OF_EXTRAS} else found(name, *more)
sys.modules.update(dict.fromkeys({OF_EXTRAS}))
from mend.server.cli import main
main()
"""


def mend(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", WITHOUT, *arguments],
        cwd=folder,
        env=os.environ | {"XDG_DATA_HOME": str(folder)},
        capture_output=True,
        text=True,
    )


@pytest.mark.slow
@pytest.mark.parametrize("world", ["building", "tabletop", "workcell"])
def test_a_simulated_world_says_what_it_needs(tmp_path: Path, world: str) -> None:
    done = mend(tmp_path, "run", "eket", "--world", world)
    assert done.returncode == 2
    assert f"the {world} world needs OpenCV: install Mend as 'mend-robots[{world}]'" in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arguments", "extra"),
    [
        (("schedule", "deliveries/corridor.yaml"), "scheduling"),
        (("check", "deliveries/corridor.yaml"), "scheduling"),
        (
            ("localize", "localization/drive.csv", "--map", "localization/floor.vectormap.txt"),
            "localization",
        ),
        (("train-colors", "colors.npz", "--scene", "eket"), "tabletop"),
    ],
)
def test_a_command_says_what_it_needs(
    tmp_path: Path, arguments: tuple[str, ...], extra: str
) -> None:
    told = [str(EXAMPLES / each) if "/" in each else each for each in arguments]
    done = mend(tmp_path, *told)
    assert done.returncode == 2
    assert f"install Mend as 'mend-robots[{extra}]'" in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.slow
def test_a_task_for_live_robots_is_checked_without_any_extra(tmp_path: Path) -> None:
    done = mend(tmp_path, "check", str(EXAMPLES / "tasks" / "shelf.yaml"))
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize("command", ["trees", "scenes", "scenarios"])
def test_what_there_is_is_listed_without_any_extra(tmp_path: Path, command: str) -> None:
    done = mend(tmp_path, command)
    assert (done.returncode, done.stderr) == (0, "")
    assert "eket" in done.stdout
