"""Walking a step of a plan on a body, again and more gently while something is felt."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from mend.errors import IllegalTransitionError
from mend.robots.arm.behaviors.backing_off import back_off, try_again
from mend.robots.arm.behaviors.behavior import Move, Step
from mend.robots.arm.behaviors.contact import Contact, Try
from mend.robots.arm.behaviors.covering import Covering
from mend.robots.arm.behaviors.felt_motion import FeltMotion
from mend.robots.arm.behaviors.planning import Plan
from mend.robots.arm.behaviors.watch import ArmWatch
from mend.robots.arm.behaviors.work import Work
from mend.robots.arm.body import ToolPose
from mend.robots.execution.execution_state import ExecutionState
from mend.robots.execution.phase import Phase
from mend.robots.execution.routine import Routine
from mend.robots.link.messages import StepStarted

_MOST_REGRASPS = 2
"""What is askew once more is carried as it is: the last look tells whether it then stands there."""


@dataclass(frozen=True, slots=True)
class _Felt:
    """What ended a try: how hard it pushed, and the poses that lead back."""

    force_n: float
    way_back: Sequence[ToolPose]


class StepWalk:
    """Walks the steps of the plan in an execution's progress, one at a time."""

    def __init__(self, work: Work, watch: ArmWatch) -> None:
        self._work = work
        self._progress, self._arm, self._perception = work.progress, work.arm, work.perception
        self._watch = watch
        self._covering = Covering(work.assignment, work.perception)

    def take_all(self, plan: Plan) -> Routine[bool]:
        """All steps; False if what they were planned for has to be looked at again.

        Raises `Interruption`, and `CoveredResultGone`.
        """
        for number in range(plan.first, len(plan.steps) + 1):
            taken = yield from self._take(number)
            if not taken:
                return False
        return True

    def _take(self, number: int) -> Routine[bool]:
        """One step, tried again more gently while something is felt. Raises `Interruption`.

        False where the head camera has to tell, once the arm is out of its view, what an empty hand
        felt on its way to the object, or what the fingers have closed on askew.
        """
        progress, watch = self._progress, self._watch
        progress.step, progress.was_done = number, None
        name = progress.planned.steps[number - 1].name
        self._work.report(
            StepStarted(
                execution=self._work.assignment.execution,
                step=number,
                name=name,
                phase=progress.phase,
            )
        )
        tries = watch.tries(progress.phase) or [Try(math.inf, 1.0)]
        looks = progress.phase is Phase.APPROACH and bool(watch.tries(Phase.PREPARE))
        if not looks:
            progress.felt = None
        begin = 0 if progress.felt is None else progress.felt.tries
        for count, each in enumerate(tries[begin:], start=begin + 1):
            felt = yield from self._try(number, each)
            if felt is None:
                askew = self._perception.hand.has_askew
                if askew:
                    yield from self._let_go_to_regrasp()
                return not askew
            contact = Contact(felt.force_n, count)
            yield from back_off(self._work, watch, felt.way_back)
            if looks:
                progress.felt = contact
                progress.move_to(ExecutionState.PREPARING)
                return False
            try_again(self._work, watch, contact, last=count == len(tries))
        expected = f"a try of step {number}"
        raise IllegalTransitionError("the execution", progress.state, "none", expected)

    def _let_go_to_regrasp(self) -> Routine[None]:
        self._progress.regrasps += 1
        self._progress.move_to(ExecutionState.BACKING_OFF)
        self._perception.let_go()
        grasp = self._progress.planned.grasp
        yield from self._arm.open_gripper(None if grasp is None else grasp.opening_m)
        yield from self._arm.lift()
        self._progress.move_to(ExecutionState.PREPARING)

    def _try(self, number: int, attempt: Try) -> Routine[_Felt | None]:
        """One try of a step, checked at the camera's period; what was felt if something was.

        Raises `Interruption`.
        """
        step = self._progress.planned.steps[number - 1]
        motion = None
        if isinstance(step.action, Move):
            motion = FeltMotion(self._arm, step.action.to, attempt.limit_n)
        self._begin(number, step, attempt.speed)
        arrived_s: float | None = None
        # A step may be over before the camera's next picture; it is judged at its start as well.
        self._watch.check(None)
        while True:
            self._watch.check_if_due()
            now_s = self._arm.body.time_s()
            self._covering.look_if_due(self._progress.phase, now_s)
            if not self._arm.body.moving:
                arrived_s = now_s if arrived_s is None else arrived_s
                settled = now_s - arrived_s >= step.settle_s - 1e-9
                if settled and not self._watch.grip_is_open_question(arrived_s):
                    return None
            yield
            self._watch.note_force(self._arm.body.contact_force_n())
            if motion is not None and arrived_s is None and motion.is_held_up():
                return _Felt(motion.strongest_n, motion.way_back())

    def _begin(self, number: int, step: Step, speed: float) -> None:
        part, plan = self._work.assignment.part, self._progress.planned
        if isinstance(step.action, Move):
            if plan.path is not None:
                if step.action.opening_m is not None:
                    self._arm.start_opening_to(step.action.opening_m)
                self._arm.start(plan.path, plan.segment_of(number), step.action.speed * speed)
        elif step.action.to == "closed":
            if part is not None and step.phase is Phase.GRASP:
                regrasp = self._progress.regrasps < _MOST_REGRASPS
                self._perception.hand.watch_grip(part, plan.grasp, regrasp=regrasp)
            self._arm.start_closing()
        else:
            self._perception.let_go()
            self._arm.start_opening(step.action.opening_m)
