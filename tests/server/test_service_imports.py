"""What a service brings into its process."""

import subprocess
import sys

import pytest

_LOADED = """
import sys
import mend.server.composition
print(*sorted({"numba", "scipy", "pybullet", "pinocchio", "coal", "ortools"} & sys.modules.keys()))
"""


@pytest.mark.slow
def test_what_robots_and_schedules_reckon_with_is_left_to_their_processes() -> None:
    loaded = subprocess.run(
        [sys.executable, "-c", _LOADED], capture_output=True, text=True, check=True
    )
    assert loaded.stdout.split() == []
