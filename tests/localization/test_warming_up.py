"""Warming up compiles all that a localizer may come to need, also once it is lost."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

LOST_AFTER_WARMING_UP = """
import sys
import numpy as np
from numba.core.dispatcher import Dispatcher
from mend.maps.vector_map import VectorMap
from mend.localization.enml.localizer import EnmlLocalizer
from mend.localization.methods import warm_up
from synthetic.settings import SceneSettings
from synthetic.world import scene

def compiled():
    return {
        (name, value.py_func.__qualname__, str(signature))
        for name, module in list(sys.modules.items())
        if name.startswith("mend.localization.enml.")
        for value in vars(module).values()
        if isinstance(value, Dispatcher)
        for signature in value.signatures
    }

walls = [[0, 0, 9, 0], [9, 0, 9, 6], [9, 6, 0, 6], [0, 6, 0, 0], [3, 0, 3, 2], [6, 6, 6, 4]]
room = VectorMap.of(walls)
drive = scene(room, SceneSettings(length_m=3.0, people=1.0), 1)
warm_up("enml")
before = compiled()
localizer = EnmlLocalizer(room)
localizer.reset(np.zeros(3), np.diag([100.0, 100.0, 10.0]))
lost = [localizer.update(step.odometry, step.scan).is_lost for step in drive.log.steps]
assert before and lost[0]
print(*sorted(compiled() - before))
"""


@pytest.mark.slow
def test_nothing_is_left_to_compile_for_a_robot_that_is_lost() -> None:
    # Synthetic drives are the benchmarks'.
    folders = [str(Path(__file__).parents[2] / "benchmarks"), os.environ.get("PYTHONPATH", "")]
    left = subprocess.run(
        [sys.executable, "-c", LOST_AFTER_WARMING_UP],
        capture_output=True,
        text=True,
        check=True,
        env=os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, folders))},
    )
    assert left.stdout.strip() == ""
