"""What an image has of Debian: the packages that are named, all that they need, and no more."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parents[2] / "docker/system_root.py"

pytestmark = pytest.mark.skipif(
    shutil.which("dpkg-query") is None, reason="packages are told by dpkg, which is not here"
)


def system_root(root: Path, *packages: str) -> subprocess.CompletedProcess[str]:
    arguments = [sys.executable, SCRIPT, root, *packages]
    return subprocess.run(arguments, capture_output=True, text=True)


def test_a_package_comes_with_what_it_needs(tmp_path: Path) -> None:
    root = tmp_path / "root"
    assert system_root(root, "dash").returncode == 0
    listed = {path.name for path in (root / "var/lib/dpkg/status.d").iterdir()}
    assert {"dash", "libc6"} <= listed
    assert not {"bash", "coreutils", "debconf", "dpkg"} & listed
    assert (root / "tmp").stat().st_mode & 0o7777 == 0o1777
    assert not (root / "usr/share/man").exists()
    assert not list(root.glob("usr/lib/*/gconv/*"))


@pytest.mark.skipif(os.geteuid() != 0, reason="only root may enter another root")
def test_what_was_copied_runs_on_its_own(tmp_path: Path) -> None:
    root = tmp_path / "root"
    assert system_root(root, "dash").returncode == 0
    inside = ["chroot", root, "/bin/sh", "-c", "echo here; command -v ls || echo no ls"]
    said = subprocess.run(inside, capture_output=True, text=True)
    assert said.stdout == "here\nno ls\n", said.stderr


def test_a_package_that_is_not_installed_is_named(tmp_path: Path) -> None:
    done = system_root(tmp_path / "root", "dash", "no-such-package")
    assert done.returncode == 1
    assert done.stderr == "not installed here: no-such-package\n"
    assert not (tmp_path / "root").exists()
