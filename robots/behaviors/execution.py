"""The execution of one behavior: its steps walked on a body, watched by monitors."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from robots.arm import Arm, Routine
from robots.behaviors.behavior import Behavior, Move, SetGripper, Situation, Step
from robots.body import ArmPath, CameraImage, ToolPose
from robots.catalogue import Part
from robots.grasp import RELEASE_CLEARANCE_M, grasp_of
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
from robots.vision.forearm import GripReading
from robots.vision.head import HeadSighting
from robots.vision.obstruction import Obstruction
from tasks.scene import StrictModel

AT_PLACE_M = 0.02
"""A part is at its place if it is this near to it."""
AT_PLACE_HEIGHT_M = 0.015

_LOOKS = 3
"""So often a part that is not wholly seen is looked for before that is believed."""
_LOOK_AGAIN_S = 0.1
_CAREFUL = 0.5
_FREE_RADIUS_M = 0.15
_PUT_DOWN_SPEED = 0.4


class ExecutionState(StrEnum):
    """What an execution is doing."""

    PREPARING = "preparing"
    """Before step 1: the arm gets out of the camera's way, the object is looked for."""
    RUNNING = "running"
    RETREATING = "retreating"
    """On the way to neutral."""
    HOLDING = "holding"
    """Stopped; it can be resumed."""
    FINISHED = "finished"
    ENDED = "ended"
    """Given up at the service's command."""


_NEXT: dict[ExecutionState, frozenset[ExecutionState]] = {
    ExecutionState.PREPARING: frozenset(
        {
            ExecutionState.RUNNING,
            ExecutionState.RETREATING,
            ExecutionState.HOLDING,
            ExecutionState.FINISHED,
            ExecutionState.ENDED,
        }
    ),
    ExecutionState.RUNNING: frozenset(
        {ExecutionState.RETREATING, ExecutionState.HOLDING, ExecutionState.FINISHED}
    ),
    ExecutionState.RETREATING: frozenset({ExecutionState.HOLDING, ExecutionState.ENDED}),
    ExecutionState.HOLDING: frozenset(
        {ExecutionState.PREPARING, ExecutionState.RETREATING, ExecutionState.ENDED}
    ),
    ExecutionState.FINISHED: frozenset(),
    ExecutionState.ENDED: frozenset(),
}


class ExecutionTransitionError(Exception):
    """An execution was told to do what its state does not allow; the message says both."""


class Interruption(Exception):  # noqa: N818 - control flow, not an error
    """A monitor's issue ends the walk through the steps."""

    def __init__(self, monitor: Monitor[Any]) -> None:
        super().__init__(monitor.issue)
        self.monitor = monitor


@dataclass(frozen=True, slots=True)
class Assignment:
    """What is to be executed, under which id."""

    execution: str
    behavior: Behavior
    parameters: StrictModel
    part: Part | None
    target: Location | None
    needs_help: bool


@dataclass(frozen=True, slots=True)
class _Plan:
    """The steps still to walk, from number `first`, and the path of those that move."""

    steps: Sequence[Step]
    first: int
    path: ArmPath | None

    def segment_of(self, number: int) -> int:
        """Which segment of the path a moving step follows."""
        before = self.steps[self.first - 1 : number - 1]
        return sum(isinstance(each.action, Move) for each in before)


@dataclass(slots=True)
class _Seen:
    """What the head camera saw before the first step."""

    image: CameraImage | None = None
    sighting: HeadSighting | None = None
    path_found: bool = True
    obstruction: Obstruction | None = None


class Execution:
    """Walks one behavior's steps; `run`, `resume` and `retreat` are its routines.

    Only one routine may be under way. Reports go to `report`.
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
        self._plan: _Plan | None = None
        self._picked_at: ToolPose | None = None
        self._seen = _Seen()
        self._raised: set[str] = set()
        self._forces_n: list[float] = []
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
        return not _NEXT[self._state]

    @property
    def way(self) -> list[ToolPose]:
        """The poses that the steps still to come lead through."""
        if self._plan is None:
            return []
        begin = max(self._step, self._plan.first) - 1
        return [
            each.action.to for each in self._plan.steps[begin:] if isinstance(each.action, Move)
        ]

    # --- Routines -----------------------------------------------------------------------------

    def run(self) -> Routine[None]:
        """Look, plan and walk all steps."""
        yield from self._attempt(resumed=False)

    def resume(self) -> Routine[None]:
        """Go on after a hold, where the hands allow it. Raises `ExecutionTransitionError`."""
        self._move_to(ExecutionState.PREPARING)
        yield from self._attempt(resumed=True)

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
        yield from self.put_down()
        yield from self._arm.go_to_neutral()
        self._arm.be_careful(1.0)
        self._step = BEFORE_FIRST_STEP
        self._move_to(ExecutionState.ENDED if end else ExecutionState.HOLDING)
        self._report(Holding(execution=self.id, at="neutral"))

    def put_down(self) -> Routine[None]:
        """Free the gripper: what it holds goes back to where it was picked, or straight down."""
        if self._senses.holds():
            for waypoints in self._ways_down():
                path = self._arm.body.plan_path(waypoints)
                if path is not None:
                    yield from self._arm.follow(path, _PUT_DOWN_SPEED)
                    break
        self._senses.let_go()
        yield from self._arm.open_gripper()

    # --- Before the first step ----------------------------------------------------------------

    def _attempt(self, resumed: bool) -> Routine[None]:
        try:
            plan = yield from self._prepare()
            if plan is None:
                self._finish(found_in_place=True)
                return
            self._move_to(ExecutionState.RUNNING)
            if resumed:
                self._report(Resumed(execution=self.id, step=plan.first))
            for number in range(plan.first, len(plan.steps) + 1):
                yield from self._walk(plan, number)
            self._finish(found_in_place=False)
        except Interruption as interruption:
            yield from self._react(interruption.monitor.meanwhile)

    def _prepare(self) -> Routine[_Plan | None]:
        """The plan to walk; None if there is nothing left to do. Raises `Interruption`."""
        self._step, self._plan, self._seen = BEFORE_FIRST_STEP, None, _Seen()
        carrying = yield from self._check_carrying()
        if not carrying:
            yield from self._free_view()
            yield from self._find()
            if self._in_place():
                return None
        plan = self._make_plan(carrying)
        self._plan = plan
        self._check(self._senses.read_grip() if carrying else None)
        if plan is None:
            raise ExecutionTransitionError(
                f"expected a path for {self._assignment.behavior.name} or an issue, got neither"
            )
        return plan

    def _check_carrying(self) -> Routine[bool]:
        """Whether the object is in the gripper now, by fresh forearm pictures."""
        part = self._assignment.part
        if part is None or not self._senses.holds(part.name):
            return False
        for _ in range(_LOOKS):
            self._senses.read_grip()
            yield from self._arm.wait(self._senses.forearm_period_s)
        return self._senses.holds(part.name)

    def _free_view(self) -> Routine[None]:
        yield from self.put_down()
        yield from self._arm.go_to_neutral()

    def _find(self) -> Routine[None]:
        part = self._assignment.part
        for attempt in range(_LOOKS):
            if attempt:
                yield from self._arm.wait(_LOOK_AGAIN_S)
            self._seen.image = self._senses.look()
            if part is None:
                return
            self._seen.sighting = self._senses.sight(part, self._seen.image)
            if self._seen.sighting is not None and self._seen.sighting.complete:
                return

    def _in_place(self) -> bool:
        sighting, target = self._seen.sighting, self._assignment.target
        if sighting is None or target is None:
            return False
        return is_at(sighting, target, self._senses.catalogue.height_of(target))

    def _make_plan(self, carrying: bool) -> _Plan | None:
        """A path through the steps to walk; None if there is none, or the object was not seen."""
        sighting, part = self._seen.sighting, self._assignment.part
        if part is not None and sighting is None and not carrying:
            return None
        found = None
        if sighting is not None:
            found = Location(x=sighting.x, y=sighting.y, z=sighting.z, yaw=sighting.yaw)
        behavior = self._assignment.behavior
        situation = Situation(
            part, found, self._assignment.target, self._senses.catalogue.table.height
        )
        steps = behavior.steps(self._assignment.parameters, situation)
        first = behavior.carry_from if carrying else 1
        waypoints = _waypoints(steps[first - 1 :])
        path = self._arm.body.plan_path(waypoints) if waypoints else None
        if waypoints and path is None:
            self._seen.path_found = False
            return None
        if self._seen.image is not None:
            self._seen.obstruction = self._senses.obstruction(
                self._seen.image, waypoints, self._arm.at_neutral
            )
        self._picked_at = None if carrying else _picked_at(steps)
        return _Plan(steps, first, path)

    # --- The steps ----------------------------------------------------------------------------

    def _walk(self, plan: _Plan, number: int) -> Routine[None]:
        """One step, checked at the camera's period. Raises `Interruption`."""
        step = plan.steps[number - 1]
        self._step = number
        self._report(StepStarted(execution=self.id, step=number, name=step.name))
        self._begin(plan, number, step)
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
                    return
            yield
            self._forces_n.append(self._arm.body.contact_force_n())

    def _begin(self, plan: _Plan, number: int, step: Step) -> None:
        part = self._assignment.part
        if isinstance(step.action, Move):
            if plan.path is not None:
                self._arm.start(plan.path, plan.segment_of(number), step.action.speed)
        elif step.action.to == "closed":
            if part is not None:
                self._senses.watch_grip(part)
            self._arm.start_closing()
        else:
            self._senses.let_go()
            self._arm.start_opening()

    def _grip_is_open_question(self, arrived_s: float) -> bool:
        """Whether the pictures have yet to show what the gripper holds.

        The last step in which they are looked at ends with one taken after the arm has arrived.
        """
        grip = self._senses.grip
        if grip is None or not self._judges_grip(self._step):
            return False
        unseen = self._read_s < arrived_s and not self._judges_grip(self._step + 1)
        return grip.in_doubt or unseen

    def _judges_grip(self, step: int) -> bool:
        return any(each.camera == FOREARM for each in self._monitors if each.watches(step))

    def _check_if_due(self) -> None:
        """Check at the forearm camera's period. Raises `Interruption`."""
        now = self._arm.body.time_s()
        if now < self._next_check_s - 1e-9:
            return
        self._next_check_s = now + self._senses.forearm_period_s
        looking = self._judges_grip(self._step) and not self._closing()
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
        for monitor in self._monitors:
            if not monitor.watches(self._step) or monitor.issue in self._raised:
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
        pictures = {}
        if self._seen.image is not None:
            pictures[HEAD] = self._seen.image
        if grip is not None:
            pictures[FOREARM] = grip.image
        return MonitorView(
            time_s=self._arm.body.time_s(),
            step=self._step,
            part=self._assignment.part,
            needs_help=self._assignment.needs_help,
            reach=self._arm.body.reach,
            table_z=self._senses.catalogue.table.height,
            sighting=self._seen.sighting,
            path_found=self._seen.path_found,
            obstruction=self._seen.obstruction,
            grip=grip,
            contact_forces_n=tuple(self._forces_n),
            pictures=pictures,
        )

    def _report_issue(self, monitor: Monitor[Any], detection: Detection, view: MonitorView) -> None:
        image = view.pictures.get(detection.camera)
        if image is None or (self._step > BEFORE_FIRST_STEP and detection.camera == HEAD):
            image = self._arm.body.cameras[detection.camera].capture()
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

    def _ways_down(self) -> list[list[ToolPose]]:
        """Where what is held can be put down, the best first."""
        ways = []
        if self._picked_at is not None:
            pick = self._picked_at
            ways.append([ToolPose(pick.x, pick.y, pick.z + 0.14, pick.yaw), pick])
        pose, grip = self._arm.tool_pose(), self._senses.grip
        if pose is not None and grip is not None and self._is_free_below(pose, grip.part):
            height_m = grasp_of(grip.part).height_m + RELEASE_CLEARANCE_M
            down = self._senses.catalogue.table.height + height_m
            ways.append([ToolPose(pose.x, pose.y, down, pose.yaw)])
        return ways

    def _is_free_below(self, pose: ToolPose, held: Part) -> bool:
        others = self._senses.sight_all(self._senses.look())
        return all(
            name == held.name or math.hypot(each.x - pose.x, each.y - pose.y) > _FREE_RADIUS_M
            for name, each in others.items()
        )

    def _move_to(self, state: ExecutionState) -> None:
        if state not in _NEXT[self._state]:
            expected = " or ".join(sorted(_NEXT[self._state])) or "nothing more"
            raise ExecutionTransitionError(
                f"an execution that is {self._state} can become {expected}, not {state}"
            )
        self._state = state


def is_at(sighting: HeadSighting, target: Location, target_z: float) -> bool:
    """Whether an object rests where it is to be."""
    near = math.hypot(sighting.x - target.x, sighting.y - target.y) <= AT_PLACE_M
    return near and abs(sighting.z - target_z) <= AT_PLACE_HEIGHT_M


def _waypoints(steps: Sequence[Step]) -> list[ToolPose]:
    return [each.action.to for each in steps if isinstance(each.action, Move)]


def _picked_at(steps: Sequence[Step]) -> ToolPose | None:
    """Where the tool point is when the gripper first closes."""
    pose = None
    for step in steps:
        if isinstance(step.action, Move):
            pose = step.action.to
        elif step.action.to == "closed":
            return pose
    return None
