"""Taking an object from a person's hand."""

import math

from mend.robots.arm.grasp import can_grasp
from mend.robots.arm.grip import GripState
from mend.robots.arm.grip.composition import likeliest
from mend.robots.arm.looks.looker import Looker
from mend.robots.catalogue import Part
from mend.robots.execution.routine import Routine
from mend.robots.link.messages import Holding, Looked

_STEADY_S = 0.3
_TRY_EVERY_S = 2.0
"""Where the picture cannot tell whether anything is held out, the fingers close that often."""


def take_from_person(looker: Looker, command: str, part: Part, within_s: float) -> Routine[Looked]:
    """Go to the hand-over pose and close the gripper on what is held between its fingers."""
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
        if not offered:
            return looker.answer(command, fulfilled=False)
        yield from arm.close_gripper()
        perception.hand.watch_handed(part, perception.catalogue.parts.values())
        yield from _judge_grip(looker)
        if not perception.hand.holds(part.name):
            perception.let_go()
            yield from arm.open_gripper()
    return looker.answer(command, fulfilled=True)


def _wait_until_offered(looker: Looker, part: Part, end_s: float) -> Routine[bool]:
    """Watch until the part is held still between the fingers, or it is time to close and feel."""
    watch = looker.perception.hand.new_watch(part)
    period_s = looker.perception.hand.period_s
    needed = max(3, math.ceil(_STEADY_S / period_s))
    shown, begin_s = 0, looker.arm.body.time_s()
    while looker.arm.body.time_s() < end_s - 1e-9:
        seen = looker.perception.measure_grip(watch).composition
        shown = shown + 1 if seen is not None and likeliest(seen) == "right" else 0
        blind = seen is None and looker.arm.body.time_s() - begin_s >= _TRY_EVERY_S
        if shown >= needed or blind:
            return True
        yield from looker.arm.wait(period_s)
    return False


def _judge_grip(looker: Looker) -> Routine[None]:
    """Read until there is a verdict; in the end there is one."""
    while True:
        reading = looker.perception.read_grip()
        if reading is None or reading.state is not GripState.UNDECIDED:
            return
        yield from looker.arm.wait(looker.perception.hand.period_s)
