"""How far an execution has come: what each step is for, and the way that is left."""

import pytest
from drawn_scene import DrawnScene

from mend.errors import IllegalTransitionError
from mend.robots.arm.behaviors.behavior import Move, SetGripper, Step
from mend.robots.arm.behaviors.findings import Outcome
from mend.robots.arm.behaviors.planning import Plan
from mend.robots.arm.behaviors.progress import ArmProgress
from mend.robots.arm.body import ToolPose
from mend.robots.execution.execution_state import ExecutionState
from mend.robots.execution.phase import Phase
from mend.robots.vision.presence import Presence

PICK, PLACE = ToolPose(0.5, -0.4, 0.725, 0.0), ToolPose(0.5, 0.0, 0.725, 0.0)
STEPS = (
    Step("pick", Move(PICK, 1.0, 0.05), Phase.APPROACH),
    Step("close", SetGripper("closed"), Phase.GRASP),
    Step("place", Move(PLACE, 1.0), Phase.PLACE),
)


def under_way(step: int, first: int = 1) -> ArmProgress:
    plan = Plan(STEPS, first, None, None)
    return ArmProgress(was_done=None, state=ExecutionState.RUNNING, step=step, plan=plan)


@pytest.mark.parametrize("step", [1, 2, 3])
def test_a_step_under_way_says_what_it_is_for(step: int) -> None:
    assert under_way(step).phase is STEPS[step - 1].phase


def test_before_the_first_step_it_prepares_and_after_the_last_it_confirms() -> None:
    progress = under_way(0)
    assert progress.phase is Phase.PREPARE
    progress.move_to(ExecutionState.CONFIRMING)
    assert progress.phase is Phase.CONFIRM


def test_only_what_may_follow_follows() -> None:
    with pytest.raises(IllegalTransitionError, match=r"is running: .* but preparing came"):
        under_way(1).move_to(ExecutionState.PREPARING)


@pytest.mark.parametrize(
    ("step", "first", "left"), [(0, 1, [PICK, PLACE]), (0, 3, [PLACE]), (2, 1, [PLACE])]
)
def test_the_way_is_that_of_the_steps_still_to_come(step, first, left) -> None:
    assert under_way(step, first).way == left


def test_once_it_has_looked_at_the_outcome_no_way_is_left() -> None:
    progress = under_way(3)
    image = DrawnScene().picture()
    progress.outcome = Outcome(image, None, Presence.THERE)
    assert progress.way == []


def test_to_start_again_is_to_have_no_plan() -> None:
    progress = under_way(2)
    progress.start_again()
    assert (progress.step, progress.way, progress.phase) == (0, [], Phase.PREPARE)
    with pytest.raises(IllegalTransitionError, match="is running: expected a plan, but none came"):
        _ = progress.planned
