"""The shipped tasks are promises: done in every world, by the robot alone, and really.

Of most of them a sample is left to do, amid all their parts. From the beginning each is done in the
benchmarks: here with everything, and by `benchmarks/library.py` over many seeds.
"""

import pytest
from begun_task import begun, placed
from library import run_task
from sampled import sample

from mend.tasks.library import TREES

ALL = 1000
LEFT = {
    "tabletop": {"workshop": 6, "kit": 4, "tea_table": 6},
    # Of the base the top, and of the tower the two uppermost: what is put onto other parts.
    "workcell": {"eket": 2, "kit": 1, "order": 4, "tea_table": 2, "tower": 2, "workshop": 1},
}
KIT_SEED = 11
"""With which the arm on the tabletop can do what is left."""


async def require_done(task: str, world: str) -> None:
    """A task that nobody helps with, of which enough was left to do."""
    left = sample(LEFT[world].get(task, ALL), ALL)
    scene, scenario = None, None
    if left != ALL and task == "tower":
        scenario = placed(task, left)
    elif left != ALL:
        scene = begun(task, left, KIT_SEED if task == "kit" else 1)
    outcome = await run_task(task, world, seed=1, scene=scene, scenario=scenario)
    assert (outcome.finished, outcome.issues, outcome.misplaced) == (True, [], [])
    assert max(outcome.errors_mm) < 5.0
    assert outcome.moved >= max(1, min(left, len(outcome.errors_mm)) // 2)


@pytest.mark.slow
@pytest.mark.parametrize("task", TREES.names())
async def test_a_shipped_task_is_done_on_the_tabletop(task: str) -> None:
    await require_done(task, "tabletop")


@pytest.mark.slow(5)
@pytest.mark.parametrize("task", TREES.names())
async def test_a_shipped_task_is_done_in_the_workcell(task: str) -> None:
    pytest.importorskip("pybullet")
    await require_done(task, "workcell")
