"""The shipped tasks are promises: done in every world, by the robot alone, and really.

In the workcell a sample of the long ones is left to do, amid all their parts. From the beginning
`benchmarks/library.py` does them, over many seeds.
"""

import pytest
from begun_task import begun
from library import run_task
from sampled import sample

from mend.tasks.library import TREES

LEFT = {"workshop": 2, "kit": 2, "tea_table": 2}
ALL = 1000


@pytest.mark.slow(2)
@pytest.mark.parametrize("task", TREES.names())
async def test_a_shipped_task_is_done_on_the_tabletop(task: str) -> None:
    outcome = await run_task(task, "tabletop", seed=1)
    assert (outcome.finished, outcome.issues, outcome.misplaced) == (True, [], [])
    assert max(outcome.errors_mm) < 5.0


@pytest.mark.slow(8)
@pytest.mark.parametrize("task", TREES.names())
async def test_a_shipped_task_is_done_in_the_workcell(task: str) -> None:
    pytest.importorskip("pybullet")
    left = sample(LEFT.get(task, ALL), ALL)
    scene = None if left == ALL else begun(task, left, seed=1)
    outcome = await run_task(task, "workcell", seed=1, scene=scene)
    assert (outcome.finished, outcome.issues, outcome.misplaced) == (True, [], [])
    assert max(outcome.errors_mm) < 5.0
    assert outcome.moved >= min(left, len(outcome.errors_mm)) // 2
