"""The check of scenes in the tabletop: with a task, and by themselves."""

import pytest

from mend.sim.random_scene import random_scene
from mend.sim.tabletop.adapter import TabletopAdapter


@pytest.mark.parametrize(("seed", "count"), [(1300004, 25), (1300000, 25), (1, 12)])
def test_a_scene_in_which_a_task_can_be_done_is_possible_by_itself(seed: int, count: int) -> None:
    adapter = TabletopAdapter()
    drawn = random_scene(seed, count, adapter.check_scene)
    assert adapter.check_scene(drawn.scene, []) == []
