"""The simulated person who keeps, more or less, what the helper promised."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mend.sim.free_pose import free_pose
from mend.tasks.intervention import Act, Intervention
from mend.tasks.scenario import Person
from mend.tasks.scene import Scene

_ACTS = {
    "place": Act.PLACE,
    "put_back": Act.PUT_BACK,
    "hand_over": Act.HAND_OVER,
    "clear_way": Act.RELEASE,
    "clear_view": Act.UNCOVER,
    "put_in": Act.PUT_IN,
    "take_out": Act.TAKE_OUT,
    "charge": Act.CHARGE,
    "send_person": Act.SEND_PERSON,
}


TELL_PLACE = "tell_place"
"""Who has told a robot where it is has nothing left to do."""


@dataclass(frozen=True, slots=True)
class Promise:
    """What was promised: `help` is a dialogue's word for it (`place`, `put_back`, ...).

    `in_the_way` is the part, or the robot, that is to be cleared out of the way, if it is one;
    `robot` the one that it was promised to.
    """

    help: str
    object: str | None
    place: str | None
    in_the_way: str | None = None
    robot: str | None = None


@dataclass(frozen=True, slots=True)
class KeptPromise:
    """What the person really does, `delay_s` after the promise on the run's clock."""

    intervention: Intervention
    delay_s: float


def deed(
    promise: Promise,
    person: Person,
    scene: Scene,
    others: Sequence[str],
    rng: np.random.Generator,
) -> KeptPromise | None:
    """What comes of a promise; None when nothing does.

    `others` are the objects that the person may confuse with the promised one. Raises `ValueError`
    for help that nobody can give.
    """
    if promise.help == TELL_PLACE:
        return None
    if promise.help not in _ACTS:
        known = ", ".join(_ACTS)
        raise ValueError(f"a person cannot give the help '{promise.help}', only {known}")
    act = _ACTS[promise.help]
    # Always as many draws, so that one probability does not change what another one decides.
    never, late, wrong_object, wrong_place = rng.random(4)
    if not person.acts or never < person.never:
        return None
    delay_s = person.delay_s + (person.late_s if late < person.late else 0.0)
    if act is Act.RELEASE and promise.in_the_way is not None:
        return KeptPromise(Intervention(act=act, object=promise.in_the_way), delay_s)
    if act is Act.RELEASE:
        return KeptPromise(
            Intervention(act=act, object=promise.object, place=promise.place), delay_s
        )
    if act in (Act.PUT_IN, Act.TAKE_OUT):
        return KeptPromise(Intervention(act=act, object=promise.object), delay_s)
    if act is Act.CHARGE:
        return KeptPromise(Intervention(act=act, object=promise.robot), delay_s)
    if act in (Act.UNCOVER, Act.SEND_PERSON):
        return KeptPromise(Intervention(act=act), delay_s)
    if promise.object is None:
        return None
    handled = promise.object
    if others and wrong_object < person.wrong_object:
        handled = others[int(rng.integers(len(others)))]
    if wrong_place < person.wrong_place and (to := free_pose(handled, scene, rng)) is not None:
        return KeptPromise(Intervention(act=Act.MOVE, object=handled, to=to), delay_s)
    place = promise.place if act is Act.PLACE else None
    return KeptPromise(Intervention(act=act, object=handled, place=place), delay_s)
