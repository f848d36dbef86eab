"""Mischief is bounded, possible, and the same for the same seed."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from mend.sim.random_interventions import random_interventions
from mend.tasks.intervention import Act
from mend.tasks.scenario import ScriptedIntervention
from mend.tasks.scene import Place, Pose, Scene, SceneObject

NAMES = [f"cup_{index}" for index in range(8)]
SCENE = Scene(
    name="cups",
    objects={
        name: SceneObject(
            color=(1.0, 0.0, 0.0),
            size=(0.05, 0.05, 0.1),
            pose=Pose(x=0.55, y=-0.6 + 0.1 * index),
        )
        for index, name in enumerate(NAMES)
    },
    places={"tray": Place(pose=Pose(x=0.8, y=0.0))},
)


def mischief(seed: int, objects: list[str]) -> list[ScriptedIntervention]:
    return random_interventions(objects, SCENE, np.random.default_rng(seed))


@given(seed=st.integers(0, 2**31 - 1), objects=st.lists(st.sampled_from(NAMES)))
@settings(deadline=None)
def test_mischief_befalls_at_most_every_second_leaf_and_only_what_is_there(
    seed: int, objects: list[str]
) -> None:
    planned = mischief(seed, objects)
    assert len(planned) <= (len(set(objects)) + 1) // 2
    befallen = [each.when.object for each in planned if each.when is not None]
    assert len(befallen) == len(planned) == len(set(befallen))
    assert set(befallen) <= set(objects)
    for each in planned:
        assert each.when is not None
        assert 1 <= each.when.step <= 8
        assert each.do.object in (None, *objects)


def test_the_same_seed_gives_the_same_mischief() -> None:
    assert mischief(5, NAMES) == mischief(5, NAMES)


def test_mischief_is_of_every_kind() -> None:
    planned = [each.do for seed in range(60) for each in mischief(seed, NAMES)]
    assert {each.act for each in planned} == {Act.STEAL, Act.MOVE, Act.BLOCK, Act.COVER}
    planned_at = [each for seed in range(60) for each in mischief(seed, NAMES)]
    elsewhere = [each for each in planned_at if each.when and each.do.object != each.when.object]
    assert 0 < len(elsewhere) < len(planned_at)
    assert {each.manner for each in planned if each.act is Act.STEAL} == {"vanish", "pull"}
