"""The agent core of one robot in a simulated world."""

import math
from typing import Any

from mend.robots.agent import Emit, EmitPicture
from mend.robots.link.messages import (
    Avoid,
    CommandBody,
    Driven,
    Finished,
    Held,
    Hello,
    Hold,
    Holding,
    Intervene,
    Intervened,
    IssueDetected,
    Look,
    Looked,
    PoseLayout,
    Poses,
    Rejected,
    ReportBody,
    Shutdown,
    StepStarted,
    TakePicture,
)
from mend.robots.robot import Robot
from mend.robots.task_progress import TaskProgress
from mend.sim.surroundings import Surroundings

_SEEN_AT_ONCE = (StepStarted, IssueDetected, Finished, Looked, Rejected, Held)
"""Reports that the service must see before more time passes."""

_WITH_WORLD = (StepStarted, Finished, Holding, Intervened, IssueDetected)
"""Reports from which the world can be rebuilt; a look is one, too, that saw what it waited for."""

_LET_HOLD_GO_ON = (Intervene, TakePicture, Avoid)

_EPSILON_S = 1e-9


class SimulatedAgent:
    """An `Agent` over a robot in a world.

    People intervene, the clock runs while the arm holds still, and reports carry the world's
    state. Everything else is the robot's.
    """

    def __init__(self, robot: Robot, surroundings: Surroundings) -> None:
        self._robot = robot
        self._surroundings = surroundings
        self._emit: Emit | None = None
        self._hold: tuple[str, Hold] | None = None
        self._look: Look | None = None
        self._progress: TaskProgress | None = None

    # --- What it is ---------------------------------------------------------------------------

    @property
    def name(self) -> str:
        return self._robot.name

    def hello(self, boot: str) -> Hello:
        """What the robot is, and what it is doing now."""
        return self._robot.hello(boot).model_copy(update={"simulated": True})

    def pose_layout(self) -> PoseLayout:
        """What `poses` holds; the parts are the world's, where it shows them."""
        layout, objects = self._robot.pose_layout(), self._surroundings.shown_objects()
        return layout if objects is None else layout.model_copy(update={"objects": list(objects)})

    def poses(self) -> Poses:
        """Where everything is now; the parts where they really are, where the world shows that."""
        poses, objects = self._robot.poses(), self._surroundings.shown_poses()
        return poses if objects is None else poses.model_copy(update={"objects": list(objects)})

    def driven(self) -> Driven | None:
        """What its base has driven so far, by its wheels; None without one."""
        return self._robot.driven()

    def attach(self, emit: Emit, emit_picture: EmitPicture) -> None:
        """Say where reports and pictures go; called once, before anything else."""
        self._emit = emit
        self._robot.attach(self._pass_on, emit_picture)

    @property
    def holds(self) -> bool:
        """Whether it lets time pass and does nothing meanwhile."""
        return self._hold is not None

    @property
    def holds_until_s(self) -> float:
        """When its hold is over; infinite where it holds nothing."""
        return math.inf if self._hold is None else self._hold[1].until

    @property
    def busy(self) -> bool:
        return self._robot.busy or self.holds

    def pace(self, speed: float | None) -> float | None:
        """Simulated seconds per wall second that it wants now, at the `speed` of the run."""
        if self._hold is not None:
            return self._hold[1].rate
        if self._look is not None and self._look.rate is not None:
            return self._look.rate
        return speed

    # --- Commands -----------------------------------------------------------------------------

    def handle(self, command_id: str, body: CommandBody) -> None:
        """Take a command. One that cannot be carried out is answered by a `Rejected` report."""
        if not isinstance(body, _LET_HOLD_GO_ON):
            self._hold = self._look = None
        match body:
            case Hold():
                self._hold = (command_id, body)
            case Intervene():
                self._surroundings.intervene_when_due(self.name, command_id, body)
            case Shutdown():
                self._surroundings.shut_down = True
            case _:
                if isinstance(body, Look):
                    self._look = body
                self._robot.handle(command_id, body)
                self.note_progress()

    def end_hold(self) -> bool:
        """Report that the clock has reached what it waited for; False if it has not."""
        if self._hold is None or self._surroundings.time_s() < self._hold[1].until - _EPSILON_S:
            return False
        command_id, _ = self._hold
        self._hold = None
        self.report(Held(command=command_id))
        return True

    def note_progress(self) -> TaskProgress | None:
        """How far the task is, with all attempts counted; None if no behavior is under way."""
        progress = self._robot.task_progress
        if progress is None:
            return None
        self._progress = self._surroundings.count_attempts(progress)
        return self._progress

    # --- Reports ------------------------------------------------------------------------------

    def report(self, body: ReportBody) -> None:
        """Report what concerns the world now."""
        self._pass_on(body, self._surroundings.time_s(), None)

    def _pass_on(self, body: ReportBody, time_s: float, _: dict[str, Any] | None) -> None:
        self.note_progress()
        if isinstance(body, _SEEN_AT_ONCE):
            self._surroundings.told_at_once = True
        if isinstance(body, Looked):
            if body.fulfilled and self._look is not None:
                self._surroundings.withdraw(self.name, self._look.object)
            self._look = None
        if isinstance(body, Finished) and not body.found_in_place and self._progress is not None:
            self._surroundings.finish(self._progress)
        if self._emit is not None:
            seen = isinstance(body, Looked) and body.fulfilled
            told = seen or isinstance(body, _WITH_WORLD)
            self._emit(body, time_s, self._surroundings.snapshot() if told else None)
