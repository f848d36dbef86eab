"""What Mend does where none of its extras is installed."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

OF_EXTRAS = ("coal", "ortools", "pinocchio", "pocketsphinx", "pybullet", "ruckig", "sounddevice")

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
def test_a_task_is_done_on_the_tabletop_without_any_extra(tmp_path: Path) -> None:
    done = mend(
        tmp_path, "run", "eket", "--world", "tabletop", "--answers", "yes", "--speed", "max"
    )
    assert done.returncode == 0, done.stderr
    assert "the run has finished" in done.stdout


@pytest.mark.slow
def test_the_workcell_says_what_it_needs(tmp_path: Path) -> None:
    done = mend(tmp_path, "run", "eket", "--world", "workcell")
    assert done.returncode == 2
    assert "mend-robots[workcell]" in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize("command", ["trees", "scenes", "scenarios"])
def test_what_there_is_is_listed_without_any_extra(tmp_path: Path, command: str) -> None:
    done = mend(tmp_path, command)
    assert (done.returncode, done.stderr) == (0, "")
    assert "eket" in done.stdout
