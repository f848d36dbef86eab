"""Mischief: interventions at random, as a test of everything at once."""

from collections.abc import Sequence

import numpy as np

from mend.sim.free_pose import free_pose
from mend.tasks.intervention import Act, Intervention
from mend.tasks.scenario import ScriptedIntervention, Trigger
from mend.tasks.scene import Scene

_ACTS = (Act.STEAL, Act.MOVE, Act.BLOCK, Act.COVER)
_SHARES = (0.55, 0.22, 0.15, 0.08)
_SHARE_OF_OTHERS = 0.4
_ATTEMPTS = (1, 2)
_ATTEMPT_SHARES = (0.8, 0.2)


def random_interventions(
    objects: Sequence[str], scene: Scene, rng: np.random.Generator, steps: int = 8
) -> list[ScriptedIntervention]:
    """Steal, move, block and cover the camera at random moments, at most once per two leaves.

    Mostly it befalls the object that is handled at that moment, else any that a leaf handles: one
    that stands finished, or that is still to come. `objects` are those that the tree's leaves
    handle, `steps` how many steps their behavior has.
    """
    handled = list(dict.fromkeys(objects))
    count = int(rng.integers(0, (len(handled) + 1) // 2 + 1))
    chosen = [handled[index] for index in rng.permutation(len(handled))[:count]]
    return [
        ScriptedIntervention(
            when=Trigger(
                object=each,
                step=int(rng.integers(1, steps + 1)),
                fraction=round(float(rng.random()), 3),
                attempt=int(rng.choice(_ATTEMPTS, p=_ATTEMPT_SHARES)),
            ),
            do=_intervention(_victim(each, handled, rng), scene, rng),
        )
        for each in chosen
    ]


def _victim(handled_now: str, handled: Sequence[str], rng: np.random.Generator) -> str:
    other = handled[int(rng.integers(len(handled)))]
    return other if rng.random() < _SHARE_OF_OTHERS else handled_now


def _intervention(handled: str, scene: Scene, rng: np.random.Generator) -> Intervention:
    act = _ACTS[int(rng.choice(len(_ACTS), p=_SHARES))]
    if act in (Act.BLOCK, Act.COVER):
        return Intervention(act=act)
    if act is Act.MOVE and (to := free_pose(handled, scene, rng)) is not None:
        return Intervention(act=act, object=handled, to=to)
    return Intervention(
        act=Act.STEAL, object=handled, manner="pull" if rng.random() < 0.5 else "vanish"
    )
