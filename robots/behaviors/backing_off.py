"""Backing off: after a contact the arm goes back the way it came, ready to try again."""

from collections.abc import Sequence
from dataclasses import replace

from robots.arm import Arm, Routine
from robots.behaviors.contact import Contact
from robots.behaviors.execution_state import ExecutionState, ExecutionTransitionError
from robots.behaviors.preparation import waypoints_of
from robots.behaviors.progress import Progress
from robots.behaviors.watch import Watch
from robots.body import ToolPose

_SPEED = 0.3


def back_off(
    progress: Progress,
    way_back: Sequence[ToolPose],
    contact: Contact,
    arm: Arm,
    watch: Watch,
    *,
    last: bool,
) -> Routine[None]:
    """Go back through these poses, with a new path for the step under way. Raises `Interruption`.

    After the last try, or where no way leads on, the monitors judge what was felt.
    """
    progress.move_to(ExecutionState.BACKING_OFF)
    back = arm.body.plan_path(way_back) if way_back else None
    for segment in range(0 if back is None else back.segments):
        if back is not None:
            arm.start(back, segment, _SPEED)
        while arm.body.moving:
            watch.check_if_due()
            yield
    steps = progress.planned.steps
    again = None if last else arm.body.plan_path(waypoints_of(steps[progress.step - 1 :]))
    if again is None:
        progress.contact = contact
        watch.check(None)
        raise ExecutionTransitionError(
            f"expected an issue of {contact.force_n:.0f} N against the arm, got none"
        )
    progress.plan = replace(progress.planned, first=progress.step, path=again)
    progress.move_to(ExecutionState.RUNNING)
