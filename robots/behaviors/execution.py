"""The execution of one behavior: its steps walked on a body, watched by monitors."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from robots.arm import Arm, Routine
from robots.behaviors.assignment import Assignment, Findings
from robots.behaviors.behavior import Move, SetGripper, Step
from robots.behaviors.confirmation import Outcome, look_at_outcome
from robots.behaviors.contact import Contact, ContactWatch, Track, Try, hindering_n, is_arrival
from robots.behaviors.execution_state import (
    ExecutionState,
    ExecutionTransitionError,
    follow,
    is_over,
)
from robots.behaviors.phase import Phase
from robots.behaviors.preparation import (
    Plan,
    check_carrying,
    find,
    goes_on_carrying,
    make_plan,
    waypoints_of,
)
from robots.behaviors.put_down import put_down
from robots.body import ToolPose
from robots.catalogue import Part
from robots.grip import GripReading
from robots.link.messages import (
    Detection,
    Finished,
    Holding,
    IssueDetected,
    Location,
    ReportBody,
    Resumed,
    StepStarted,
)
from robots.monitors.monitor import BEFORE_FIRST_STEP, Meanwhile, Monitor, MonitorView
from robots.senses import FOREARM, HEAD, Senses
from robots.vision.drawing import draw_detection, encode_jpeg
from robots.vision.head import HeadSighting
from robots.vision.presence import Presence, is_at

_BACK_OFF_SPEED = 0.3
_CAREFUL = 0.5
"""While a person's hands are near, motion is scaled by this."""


class Interruption(Exception):  # noqa: N818 - control flow, not an error
    """A monitor's issue ends the walk through the steps."""

    def __init__(self, monitor: Monitor[Any]) -> None:
        super().__init__(monitor.issue)
        self.monitor = monitor


class Execution:
    """Walks one behavior's steps; `run`, `resume` and `retreat` give the routines to drive.

    Only one of them may be under way. Reports go to `report`.
    """

    def __init__(
        self,
        assignment: Assignment,
        monitors: Sequence[Monitor[Any]],
        arm: Arm,
        senses: Senses,
        report: Callable[[ReportBody], None],
    ) -> None:
        self._assignment = assignment
        self._monitors = monitors
        self._arm = arm
        self._senses = senses
        self._report = report
        self._state = ExecutionState.PREPARING
        self._step = BEFORE_FIRST_STEP
        self._plan: Plan | None = None
        self._picked_at: ToolPose | None = None
        self._seen = Findings()
        self._outcome: Outcome | None = None
        self._was_done = assignment.was_done
        self._raised: set[str] = set()
        self._forces_n: list[float] = []
        self._contact: Contact | None = None
        self._felt: Contact | None = None
        """What the empty hand felt last on its way to the object."""
        self._track = Track()
        self._next_check_s = -math.inf
        self._read_s = -math.inf

    @property
    def id(self) -> str:
        return self._assignment.execution

    @property
    def part(self) -> Part | None:
        return self._assignment.part

    @property
    def state(self) -> ExecutionState:
        return self._state

    @property
    def step(self) -> int:
        """The step under way, counted from 1; 0 before the first."""
        return self._step

    @property
    def over(self) -> bool:
        """Whether nothing can follow."""
        return is_over(self._state)

    @property
    def way(self) -> list[ToolPose]:
        """The poses that the steps still to come lead through."""
        if self._plan is None or self._outcome is not None:
            return []
        return waypoints_of(self._plan.steps[max(self._step, self._plan.first) - 1 :])

    @property
    def destination(self) -> tuple[Part, Location | None] | None:
        """The object and where it goes; None for a behavior without."""
        part = self._assignment.part
        return None if part is None else (part, self._assignment.target)

    # --- Routines -----------------------------------------------------------------------------

    def run(self) -> Routine[None]:
        """Look, plan and walk all steps."""
        return self._attempt(resumed=False)

    def resume(self) -> Routine[None]:
        """Go on after a hold, where the hands allow it. Raises `ExecutionTransitionError`."""
        self._move_to(ExecutionState.PREPARING)
        return self._attempt(resumed=True)

    def hold(self) -> None:
        """Stop within one control cycle and hold. Raises `ExecutionTransitionError`."""
        self._arm.stop()
        if self._state is not ExecutionState.HOLDING:
            self._move_to(ExecutionState.HOLDING)

    def end(self) -> None:
        """Another execution takes its place. Raises `ExecutionTransitionError`."""
        self._arm.be_careful(1.0)
        self._move_to(ExecutionState.ENDED)

    def retreat(self, end: bool) -> Routine[None]:
        """Put down or let go what is held, move to neutral, and hold there (or `end`).

        Raises `ExecutionTransitionError`.
        """
        if self._state is not ExecutionState.RETREATING:
            self._move_to(ExecutionState.RETREATING)
        self._arm.stop()
        return self._retreat(end)

    def _retreat(self, end: bool) -> Routine[None]:
        yield from put_down(self._arm, self._senses, self._picked_at)
        yield from self._arm.go_to_neutral()
        self._arm.be_careful(1.0)
        self._step = BEFORE_FIRST_STEP
        self._move_to(ExecutionState.ENDED if end else ExecutionState.HOLDING)
        self._report(Holding(execution=self.id, at="neutral"))

    # --- Before the first step ----------------------------------------------------------------

    def _attempt(self, resumed: bool) -> Routine[None]:
        self._felt = None
        try:
            there = False
            while not there:
                plan = yield from self._prepare()
                if plan is None:
                    self._finish(found_in_place=True)
                    return
                self._move_to(ExecutionState.RUNNING)
                if resumed:
                    self._report(Resumed(execution=self.id, step=plan.first))
                    resumed = False
                there = (yield from self._take_steps(plan)) and (yield from self._confirm())
            self._finish(found_in_place=False)
        except Interruption as interruption:
            yield from self._react(interruption.monitor.meanwhile)

    def _prepare(self) -> Routine[Plan | None]:
        """The plan to walk; None if there is nothing left to do. Raises `Interruption`."""
        earlier, before = self._plan, self._seen.sighting
        self._step, self._plan, self._seen = BEFORE_FIRST_STEP, None, Findings()
        self._outcome = self._contact = None
        part, arm, senses = self._assignment.part, self._arm, self._senses
        carrying = yield from check_carrying(part, arm, senses)
        self._seen.carrying = carrying and goes_on_carrying(self._assignment, arm, senses)
        if not self._seen.carrying:
            yield from put_down(arm, senses, self._picked_at)
            yield from self._go_to_neutral()
            yield from find(part, arm, senses, self._seen)
            if self._in_place():
                return None
            if self._felt is not None and self._is_hidden(before):
                self._plan = earlier
                self._judge(self._felt)
            self._picked_at = None
        self._plan = make_plan(self._assignment, arm, senses, self._seen)
        self._check(senses.read_grip() if self._seen.carrying else None)
        if self._felt is not None and self._felt.tries >= len(self._tries(Phase.PREPARE)):
            # Nothing that is seen explains it.
            self._judge(self._felt)
        if self._plan is None:
            raise ExecutionTransitionError(
                f"expected a path for {self._assignment.behavior.name} or an issue, got neither"
            )
        self._picked_at = self._plan.picked_at or self._picked_at
        return self._plan

    def _in_place(self) -> bool:
        sighting, target = self._seen.sighting, self._assignment.target
        part, image, senses = self._assignment.part, self._seen.image, self._senses
        if part is None or target is None or image is None:
            return False
        if sighting is not None and is_at(sighting, target, senses.catalogue.height_of(target)):
            return True
        # What is out of sight at its place since it was seen there needs nobody to fetch it.
        hidden = senses.presence(image, part, target) is Presence.HIDDEN
        return self._was_done == "there" and hidden

    def _is_hidden(self, before: HeadSighting | None) -> bool:
        """Whether something may hide the object where it was seen before."""
        part, image = self._assignment.part, self._seen.image
        if self._seen.sighting is not None or part is None or image is None or before is None:
            return False
        where = Location(x=before.x, y=before.y, z=before.z, yaw=before.yaw)
        return self._senses.presence(image, part, where) is Presence.HIDDEN

    # --- The steps ----------------------------------------------------------------------------

    def _take_steps(self, plan: Plan) -> Routine[bool]:
        """All steps; False if what they were planned for has to be looked at again.

        Raises `Interruption`.
        """
        for number in range(plan.first, len(plan.steps) + 1):
            taken = yield from self._take_step(number)
            if not taken:
                return False
        return True

    def _take_step(self, number: int) -> Routine[bool]:
        """One step, tried again more gently while something is felt. Raises `Interruption`.

        False where an empty hand on its way to the object felt something: the head camera can
        tell what it was once the arm is out of its view.
        """
        self._step, self._was_done = number, None
        name = self._planned.steps[number - 1].name
        self._report(StepStarted(execution=self.id, step=number, name=name))
        tries = self._tries(self._phase) or [Try(math.inf, 1.0)]
        looks = self._phase is Phase.APPROACH and bool(self._tries(Phase.PREPARE))
        if not looks:
            self._felt = None
        begin = 0 if self._felt is None else self._felt.tries
        for count, each in enumerate(tries[begin:], start=begin + 1):
            felt_n = yield from self._walk(number, each)
            if felt_n is None:
                return True
            contact = Contact(felt_n, count)
            yield from self._go_back()
            if looks:
                self._felt = contact
                self._move_to(ExecutionState.PREPARING)
                return False
            self._try_again(number, contact, last=count == len(tries))
        raise ExecutionTransitionError(f"expected a try of step {number}, got none")

    def _tries(self, phase: Phase) -> Sequence[Try]:
        """The tries of the first monitor of a phase to which it matters what is felt."""
        return next((each.tries for each in self._watching(phase) if each.tries), ())

    def _go_back(self) -> Routine[None]:
        """Back off the way the arm came. Raises `Interruption`."""
        self._move_to(ExecutionState.BACKING_OFF)
        passed = self._track.way_back()
        back = self._arm.body.plan_path(passed) if passed else None
        for segment in range(0 if back is None else back.segments):
            if back is not None:
                self._arm.start(back, segment, _BACK_OFF_SPEED)
            while self._arm.body.moving:
                self._check_if_due()
                yield

    def _try_again(self, number: int, contact: Contact, *, last: bool) -> None:
        """Plan the way on; after the last try, or where none leads on, judge what was felt.

        Raises `Interruption`.
        """
        steps = self._planned.steps
        again = None if last else self._arm.body.plan_path(waypoints_of(steps[number - 1 :]))
        if again is None:
            self._judge(contact)
        self._plan = replace(self._planned, first=number, path=again)
        self._move_to(ExecutionState.RUNNING)

    def _judge(self, contact: Contact) -> None:
        """Let the monitors judge what was felt. Raises `Interruption`."""
        self._contact = contact
        self._check(None)
        raise ExecutionTransitionError(
            f"expected an issue of {contact.force_n:.0f} N against the arm, got none"
        )

    def _go_to_neutral(self) -> Routine[None]:
        """Get out of the head camera's view; an arm that felt something goes feeling its way.

        Raises `Interruption`.
        """
        tries = self._tries(Phase.PREPARE) if self._felt is not None else ()
        watch = ContactWatch(tries[0].limit_n if tries else math.inf)
        for _ in self._arm.go_to_neutral():
            yield
            if watch.feel(self._arm.body.contact_force_n(), self._arm.body.control_period_s):
                self._arm.stop()
                self._judge(Contact(watch.strongest_n, 1))

    def _walk(self, number: int, attempt: Try) -> Routine[float | None]:
        """One try of a step, checked at the camera's period; the force if something was felt.

        Raises `Interruption`.
        """
        plan = self._planned
        step = plan.steps[number - 1]
        self._track, contact = Track(), ContactWatch(attempt.limit_n)
        self._begin(plan, number, step, attempt.speed)
        arrived_s: float | None = None
        # A step may be over before the camera's next picture; it is judged at its start as well.
        self._check(None)
        while True:
            self._check_if_due()
            now_s = self._arm.body.time_s()
            if not self._arm.body.moving:
                arrived_s = now_s if arrived_s is None else arrived_s
                settled = now_s - arrived_s >= step.settle_s - 1e-9
                if settled and not self._grip_is_open_question(arrived_s):
                    return None
            yield
            self._forces_n.append(self._arm.body.contact_force_n())
            if isinstance(step.action, Move) and arrived_s is None:
                felt_n = self._feel(step.action, contact)
                if felt_n is not None:
                    return felt_n

    def _feel(self, move: Move, contact: ContactWatch) -> float | None:
        """Stop where something pushes lastingly; its force unless that ends the move."""
        body, here = self._arm.body, self._arm.tool_pose()
        self._track.note(here)
        force = body.contact_force()
        strength_n = body.contact_force_n() if here is None else hindering_n(force, here, move.to)
        if not contact.feel(strength_n, body.control_period_s):
            return None
        self._arm.stop()
        return None if here is not None and is_arrival(here, move.to) else contact.strongest_n

    @property
    def _planned(self) -> Plan:
        """The plan that is walked. Raises `ExecutionTransitionError` before there is one."""
        if self._plan is None:
            raise ExecutionTransitionError(f"expected a plan while it is {self._state}, got none")
        return self._plan

    @property
    def _phase(self) -> Phase:
        """What the step under way is for."""
        if self._state is ExecutionState.CONFIRMING:
            return Phase.CONFIRM
        if self._plan is None or self._step == BEFORE_FIRST_STEP:
            return Phase.PREPARE
        phase = self._plan.steps[self._step - 1].phase
        if self._state is ExecutionState.BACKING_OFF and phase is Phase.PLACE:
            # What it was about to put down it carries again, unless that was taken from it.
            return Phase.CARRY
        return phase

    def _begin(self, plan: Plan, number: int, step: Step, speed: float) -> None:
        part = self._assignment.part
        if isinstance(step.action, Move):
            if plan.path is not None:
                if step.action.opening_m is not None:
                    self._arm.start_opening_to(step.action.opening_m)
                self._arm.start(plan.path, plan.segment_of(number), step.action.speed * speed)
        elif step.action.to == "closed":
            if part is not None and step.phase is Phase.GRASP:
                self._senses.watch_grip(part, plan.grasp)
            self._arm.start_closing()
        else:
            self._senses.let_go()
            self._arm.start_opening(step.action.opening_m)

    def _grip_is_open_question(self, arrived_s: float) -> bool:
        """Whether the pictures have yet to show what the gripper holds.

        The last step in which they are looked at ends with one taken after the arm has arrived.
        """
        grip = self._senses.grip
        if grip is None or self._plan is None or not self._judges_grip(self._phase):
            return False
        following = self._plan.steps[self._step : self._step + 1]
        if following and self._judges_grip(following[0].phase):
            return grip.in_doubt
        return grip.in_doubt or self._read_s < arrived_s

    def _judges_grip(self, phase: Phase) -> bool:
        return any(each.camera == FOREARM for each in self._watching(phase))

    def _watching(self, phase: Phase) -> list[Monitor[Any]]:
        name = self._assignment.behavior.monitored_as
        return [each for each in self._monitors if each.watches(name, phase)]

    def _check_if_due(self) -> None:
        """Check at the forearm camera's period. Raises `Interruption`."""
        now = self._arm.body.time_s()
        if now < self._next_check_s - 1e-9:
            return
        self._next_check_s = now + self._senses.forearm_period_s
        looking = self._judges_grip(self._phase) and not self._closing()
        self._read_s = now if looking else self._read_s
        self._check(self._senses.read_grip() if looking else None)

    def _closing(self) -> bool:
        """Whether the fingers are still on their way together."""
        plan = self._plan
        if plan is None or not self._arm.body.moving:
            return False
        return plan.steps[self._step - 1].action == SetGripper("closed")

    def _check(self, grip: GripReading | None) -> None:
        """Let the monitors of this step judge. Raises `Interruption` for the first that must."""
        view = self._view(grip)
        self._forces_n.clear()
        for monitor in self._watching(self._phase):
            if monitor.issue in self._raised:
                continue
            detection = monitor.check(view)
            if detection is None:
                continue
            if monitor.interrupts:
                self._arm.stop()
            else:
                self._raised.add(monitor.issue)
                self._arm.be_careful(_CAREFUL)
            self._report_issue(monitor, detection, view)
            if monitor.interrupts:
                raise Interruption(monitor)

    def _view(self, grip: GripReading | None) -> MonitorView:
        pictures, outcome = {}, self._outcome
        seen = self._seen if outcome is None else outcome
        if seen.image is not None:
            pictures[HEAD] = seen.image
        if grip is not None:
            pictures[FOREARM] = grip.image
        return MonitorView(
            time_s=self._arm.body.time_s(),
            step=self._step,
            phase=self._phase,
            part=self._assignment.part,
            needs_help=self._assignment.needs_help,
            was_done=self._was_done,
            reach=self._arm.body.reach,
            table_z=self._senses.catalogue.table.height,
            sighting=self._seen.sighting,
            refusal=self._seen.refusal,
            obstruction=self._seen.obstruction,
            grip=grip,
            placed=None if outcome is None else outcome.sighting,
            presence=None if outcome is None else outcome.presence,
            contact=self._contact,
            contact_forces_n=tuple(self._forces_n),
            pictures=pictures,
        )

    def _report_issue(self, monitor: Monitor[Any], detection: Detection, view: MonitorView) -> None:
        image = view.pictures.get(detection.camera)
        fresh = view.phase in (Phase.PREPARE, Phase.CONFIRM)
        if image is None or (detection.camera == HEAD and not fresh):
            image = self._arm.body.cameras[detection.camera].capture()
        height, width = image.bgr.shape[:2]
        detection = detection.model_copy(update={"size_px": (width, height)})
        self._report(
            IssueDetected(
                execution=self.id,
                issue=monitor.issue,
                step=self._step,
                interrupts=monitor.interrupts,
                detection=detection,
                jpeg=encode_jpeg(draw_detection(image.bgr, detection)),
            )
        )

    # --- After the steps ----------------------------------------------------------------------

    def _confirm(self) -> Routine[bool]:
        """Whether the object is at its place, as far as is seen; if not, it is to be placed again.

        Raises `Interruption`.
        """
        part, target = self._assignment.part, self._assignment.target
        if part is None or target is None:
            return True
        self._move_to(ExecutionState.CONFIRMING)
        self._arm.be_careful(1.0)
        self._outcome = yield from look_at_outcome(part, target, self._arm, self._senses)
        self._check(None)
        if self._outcome.presence is not Presence.GONE:
            return True
        self._raised.clear()
        self._move_to(ExecutionState.PREPARING)
        return False

    def _react(self, meanwhile: Meanwhile) -> Routine[None]:
        if meanwhile is Meanwhile.GO_TO_NEUTRAL:
            # What the fingers may still touch is not theirs to put anywhere any more.
            self._senses.let_go()
            yield from self.retreat(end=False)
            return
        self._move_to(ExecutionState.HOLDING)
        at_neutral = self._arm.at_neutral
        self._report(Holding(execution=self.id, at="neutral" if at_neutral else "in_place"))

    def _finish(self, found_in_place: bool) -> None:
        self._arm.be_careful(1.0)
        self._move_to(ExecutionState.FINISHED)
        self._report(Finished(execution=self.id, found_in_place=found_in_place))

    def _move_to(self, state: ExecutionState) -> None:
        self._state = follow(self._state, state)
