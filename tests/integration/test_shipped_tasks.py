"""The shipped tasks are promises: done in every world, by the robot alone, and really."""

import pytest
from library import run_task

from mend.tasks.library import TREES

LONG_S = {"workshop": 60, "kit": 30, "tea_table": 20}


@pytest.mark.slow(5)
@pytest.mark.parametrize("task", TREES.names())
async def test_a_shipped_task_is_done_on_the_tabletop(task: str) -> None:
    outcome = await run_task(task, "tabletop", seed=1)
    assert (outcome.finished, outcome.issues, outcome.misplaced) == (True, [], [])
    assert max(outcome.errors_mm) < 5.0


@pytest.mark.parametrize(
    "task",
    [pytest.param(name, marks=pytest.mark.slow(LONG_S.get(name, 10))) for name in TREES.names()],
)
async def test_a_shipped_task_is_done_in_the_workcell(task: str) -> None:
    pytest.importorskip("pybullet")
    outcome = await run_task(task, "workcell", seed=1)
    assert (outcome.finished, outcome.issues, outcome.misplaced) == (True, [], [])
    assert max(outcome.errors_mm) < 5.0
