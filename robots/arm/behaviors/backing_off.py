"""Backing off: after a contact the arm goes back, to look or to try again more gently."""

import math
from collections.abc import Sequence
from dataclasses import replace

from mend.robots.arm.behaviors.contact import Contact, ContactWatch
from mend.robots.arm.behaviors.planning import waypoints_of
from mend.robots.arm.behaviors.watch import ArmWatch
from mend.robots.arm.behaviors.work import Work
from mend.robots.arm.body import ToolPose
from mend.robots.execution.execution_state import ExecutionState
from mend.robots.execution.phase import Phase
from mend.robots.execution.routine import Routine

_SPEED = 0.3
_BIDE_S = 0.5
"""Who pulls at what the fingers hold has it in three times this, or has let go of it."""


def back_off(work: Work, watch: ArmWatch, way_back: Sequence[ToolPose]) -> Routine[None]:
    """Go back through these poses; where no way leads back, bide a while. Raises `Interruption`."""
    arm = work.arm
    work.progress.move_to(ExecutionState.BACKING_OFF)
    back = arm.body.plan_back(way_back) if way_back else None
    if back is None:
        yield from _watched(arm.wait(_BIDE_S), watch)
        return
    for segment in range(back.segments):
        arm.start(back, segment, _SPEED)
        yield from _watched(arm.settle(), watch)


def _watched(routine: Routine[None], watch: ArmWatch) -> Routine[None]:
    """A routine during which the monitors look as ever. Raises `Interruption`."""
    for _ in routine:
        watch.check_if_due()
        yield


def try_again(work: Work, watch: ArmWatch, contact: Contact, *, last: bool) -> None:
    """Plan the way on; after the last try, or where none leads on, judge what was felt.

    Raises `Interruption`.
    """
    progress = work.progress
    steps = progress.planned.steps
    again = None if last else work.arm.body.plan_path(waypoints_of(steps[progress.step - 1 :]))
    if again is None:
        watch.judge(contact)
    progress.plan = replace(progress.planned, first=progress.step, path=again)
    progress.move_to(ExecutionState.RUNNING)


def get_out_of_view(work: Work, watch: ArmWatch) -> Routine[None]:
    """Get out of the head camera's view; an arm that felt something goes feeling its way.

    Raises `Interruption`.
    """
    arm = work.arm
    tries = watch.tries(Phase.PREPARE) if work.progress.felt is not None else ()
    feeling = ContactWatch(tries[0].limit_n if tries else math.inf)
    for _ in arm.go_to_neutral():
        yield
        if feeling.feel(arm.body.contact_force_n(), arm.body.control_period_s):
            arm.stop()
            watch.judge(Contact(feeling.strongest_n, 1))
