"""Taking an object from a person's hand."""

import math
from enum import StrEnum

from mend.robots.arm.grasp import can_grasp
from mend.robots.arm.grip import GripState
from mend.robots.arm.grip.composition import likeliest
from mend.robots.arm.looks.looker import Looker
from mend.robots.arm.looks.shown import shown
from mend.robots.arm.perception import FOREARM
from mend.robots.catalogue import Part
from mend.robots.execution.routine import Routine
from mend.robots.link.messages import Detection, Holding, Looked

_STEADY_S = 0.3
_SURELY_ANOTHER_S = 1.0
_TRY_EVERY_S = 2.0
"""Where the picture cannot tell whether anything is held out, the fingers close that often."""


class _Offered(StrEnum):
    """What the forearm camera made of what was held out."""

    NOTHING = "nothing"
    ANOTHER = "another"
    """Something came between the fingers that has the colours of other parts."""
    PERHAPS = "perhaps"
    """The part, or something that cannot be told: the fingers will."""


def take_from_person(looker: Looker, command: str, part: Part, within_s: float) -> Routine[Looked]:
    """Go to the hand-over pose and close the gripper on what is held between its fingers.

    Where another part was held out and never this one, that is what was `felt`.
    """
    arm, perception, held = looker.arm, looker.perception, looker.held
    end_s = arm.body.time_s() + within_s
    if not can_grasp(part, arm.body.gripper):
        return looker.answer(command, fulfilled=False)
    if not perception.hand.holds(part.name):
        perception.let_go()
        yield from arm.go_to_hand_over()
        yield from arm.open_gripper()
    looker.report(Holding(execution=None if held is None else held.id, at="hand_over"))
    while not perception.hand.holds(part.name):
        offered = yield from _wait_until_offered(looker, part, end_s)
        if offered is not _Offered.PERHAPS:
            another = offered is _Offered.ANOTHER
            unseen = looker.answer(command, fulfilled=False, felt="another" if another else None)
            image = perception.hand.feel(()).image
            return shown(unseen, image, Detection(camera=FOREARM))
        yield from arm.close_gripper()
        perception.hand.watch_handed(part, perception.catalogue.parts.values())
        yield from _judge_grip(looker)
        if not perception.hand.holds(part.name):
            perception.let_go()
            yield from arm.open_gripper()
    return looker.answer(command, fulfilled=True)


def _wait_until_offered(looker: Looker, part: Part, end_s: float) -> Routine[_Offered]:
    """Watch until the part is held still between the fingers, or it is time to close and feel."""
    watch = looker.perception.hand.new_watch(part)
    period_s = looker.perception.hand.period_s
    needed = max(3, math.ceil(_STEADY_S / period_s))
    for_sure = max(needed, math.ceil(_SURELY_ANOTHER_S / period_s))
    offered, others = _Offered.NOTHING, 0
    # What lies below the open fingers all the time is not held out.
    before_it = False
    shown, begin_s = 0, looker.arm.body.time_s()
    while looker.arm.body.time_s() < end_s - 1e-9:
        seen = looker.perception.measure_grip(watch).composition
        what = None if seen is None else likeliest(seen)
        shown = shown + 1 if what == "right" else 0
        others = others + 1 if what == "other" else 0
        before_it |= what == "nothing"
        if before_it and others >= for_sure:
            offered = _Offered.ANOTHER
        blind = seen is None and looker.arm.body.time_s() - begin_s >= _TRY_EVERY_S
        if shown >= needed or blind:
            return _Offered.PERHAPS
        yield from looker.arm.wait(period_s)
    return offered


def _judge_grip(looker: Looker) -> Routine[None]:
    """Read until there is a verdict; in the end there is one."""
    while True:
        reading = looker.perception.read_grip()
        if reading is None or reading.state is not GripState.UNDECIDED:
            return
        yield from looker.arm.wait(looker.perception.hand.period_s)
