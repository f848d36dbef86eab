"""The agent core of a robot in a simulated world: the robot, and the world around it."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from mend.robots.agent import Emit, EmitPicture
from mend.robots.link.messages import (
    CommandBody,
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
from mend.sim.interventions import HELPER, PendingInterventions, PendingSnapshot, PersonAction
from mend.sim.world import ShownWorld, World
from mend.tasks.intervention import Act, Intervention
from mend.tasks.scenario import ScriptedIntervention
from mend.tasks.scene import StrictModel

_SEEN_AT_ONCE = (StepStarted, IssueDetected, Finished, Looked, Rejected, Held)
"""Reports that the service must see before more time passes."""

_WITH_WORLD = (StepStarted, Finished, Holding, Intervened, IssueDetected)
"""Reports from which the world can be rebuilt; a look is one, too, that saw what it waited for."""

_LET_HOLD_GO_ON = (Intervene, TakePicture)

_PUT_DOWN = (Act.PUT_BACK, Act.PLACE)
_LAST_STEP = 2**31

_EPSILON_S = 1e-9


class AgentSnapshot(StrictModel):
    """A simulated world, how often each object was tried, and what people have still to do."""

    world: dict[str, Any]
    attempts: dict[str, int]
    pending: PendingSnapshot


class SimulatedAgent:
    """An `AgentCore` over a robot in a world.

    People intervene, the clock runs while the arm holds still, and reports carry the world's
    state. Everything else is the robot's.
    """

    def __init__(
        self,
        robot: Robot,
        world: World,
        *,
        speed: float | None,
        interventions: Sequence[ScriptedIntervention] = (),
        snapshot: dict[str, Any] | None = None,
    ) -> None:
        """`speed`: simulated seconds per second, None as fast as possible.

        Raises `ValueError` for a snapshot that does not fit the world.
        """
        self._robot = robot
        self._world = world
        self._shown = world if isinstance(world, ShownWorld) else None
        self._speed = speed
        self._pending = PendingInterventions(interventions)
        self._attempts: dict[str, int] = {}
        self._earlier_attempts: dict[str, int] = {}
        self._emit: Emit | None = None
        self._hold: tuple[str, Hold] | None = None
        self._look: Look | None = None
        self._progress: TaskProgress | None = None
        self._reported = False
        self._shut_down = False
        if snapshot is not None:
            self._restore(AgentSnapshot.model_validate(snapshot))

    # --- What it is ---------------------------------------------------------------------------

    @property
    def world(self) -> World:
        """The world as it really is; for tests and benchmarks to judge by."""
        return self._world

    def hello(self, boot: str) -> Hello:
        """What the robot is, and what it is doing now."""
        return self._robot.hello(boot).model_copy(update={"simulated": True})

    def pose_layout(self) -> PoseLayout:
        """What `poses` holds; the parts are the world's, where it shows them."""
        layout = self._robot.pose_layout()
        if self._shown is None:
            return layout
        return layout.model_copy(update={"objects": list(self._shown.shown_objects)})

    def poses(self) -> Poses:
        """Where everything is now; the parts where they really are, where the world shows that."""
        poses = self._robot.poses()
        if self._shown is None:
            return poses
        return poses.model_copy(update={"objects": list(self._shown.shown_poses())})

    def attach(self, emit: Emit, emit_picture: EmitPicture) -> None:
        """Say where reports and pictures go; called once, before anything else."""
        self._emit = emit
        self._robot.attach(self._pass_on, emit_picture)

    @property
    def pace(self) -> float | None:
        """Simulated seconds per wall second wanted now; None as fast as possible."""
        if self._hold is not None:
            return self._hold[1].rate
        if self._look is not None and self._look.rate is not None:
            return self._look.rate
        return self._speed

    def time_s(self) -> float:
        """The world's clock."""
        return self._robot.time_s()

    @property
    def shut_down(self) -> bool:
        """Whether a `shutdown` command came."""
        return self._shut_down

    def snapshot(self) -> dict[str, Any]:
        """The state from which an agent in the same scene can be rebuilt; JSON-compatible."""
        return {
            "world": self._world.snapshot(),
            "attempts": dict(self._attempts),
            "pending": self._pending.snapshot().model_dump(mode="json"),
        }

    # --- Commands -----------------------------------------------------------------------------

    def handle(self, command_id: str, body: CommandBody) -> None:
        """Take a command. One that cannot be carried out is answered by a `Rejected` report."""
        if not isinstance(body, _LET_HOLD_GO_ON):
            self._hold = self._look = None
        match body:
            case Hold():
                self._hold = (command_id, body)
            case Intervene():
                self._intervene_when_due(command_id, body)
            case Shutdown():
                self._shut_down = True
            case _:
                if isinstance(body, Look):
                    self._look = body
                self._robot.handle(command_id, body)
                self._note_progress()

    def _intervene_when_due(self, command_id: str, command: Intervene) -> None:
        if command.at is None or command.at <= self.time_s():
            self._intervene(PersonAction(command.intervention, command.by, command_id))
        else:
            self._pending.queue(command_id, command, command.at)

    # --- Time ---------------------------------------------------------------------------------

    def advance(self, duration_s: float) -> bool:
        """Let up to `duration_s` of the robot's clock pass; False when there is nothing to do."""
        end_s = self.time_s() + duration_s
        self._reported = False
        while not self._reported and not self._shut_down:
            self._let_people_act()
            if self._end_hold():
                break
            if not self._busy or self.time_s() >= end_s - _EPSILON_S:
                break
            self._let_cycle_pass()
        return self._busy

    @property
    def _busy(self) -> bool:
        return not self._shut_down and (self._robot.busy or self._hold is not None)

    def _let_cycle_pass(self) -> None:
        """One control cycle at most, so that people act in the very cycle that is theirs."""
        if self._robot.busy:
            self._robot.advance(self._world.body.control_period_s)
        else:
            self._world.body.advance_cycle()

    def _end_hold(self) -> bool:
        if self._hold is None or self.time_s() < self._hold[1].until - _EPSILON_S:
            return False
        command_id, _ = self._hold
        self._hold = None
        self._pass_on(Held(command=command_id), self.time_s(), None)
        return True

    # --- People -------------------------------------------------------------------------------

    def _let_people_act(self) -> None:
        """Let people do what is due at this moment."""
        if self._pending.any_left:
            self._do_due(self._note_progress())

    def _note_progress(self) -> TaskProgress | None:
        """How far the task is, with all attempts counted; None if no behavior is under way."""
        progress = self._robot.task_progress
        if progress is None:
            return None
        if progress.object is not None:
            # The robot's own count begins anew when its process is started again.
            attempt = progress.attempt + self._earlier_attempts.get(progress.object, 0)
            self._attempts[progress.object] = attempt
            progress = replace(progress, attempt=attempt)
        self._progress = progress
        return progress

    def _do_due(self, progress: TaskProgress | None) -> None:
        for deed in self._pending.take_due(self.time_s(), progress):
            self._intervene(deed)

    def _intervene(self, deed: PersonAction) -> None:
        if deed.by == HELPER and deed.do.act in _PUT_DOWN:
            # What somebody stands in front of would be put down in vain: the robot is to see it.
            step_aside = Intervention(act=Act.RELEASE)
            if not self._world.intervene(step_aside):
                self._pass_on(Intervened(intervention=step_aside, by=HELPER), self.time_s(), None)
        problem = self._world.intervene(deed.do)
        report = Intervened(
            intervention=deed.do, by=deed.by, ok=not problem, detail=problem, command=deed.command
        )
        self._pass_on(report, self.time_s(), None)

    # --- Reports ------------------------------------------------------------------------------

    def _pass_on(self, body: ReportBody, time_s: float, _: dict[str, Any] | None) -> None:
        self._note_progress()
        if isinstance(body, _SEEN_AT_ONCE):
            self._reported = True
        if isinstance(body, Looked):
            if body.fulfilled and self._look is not None:
                # Nobody still does what the robot has just said that it sees done.
                self._pending.withdraw(self._look.object)
            self._look = None
        if isinstance(body, Finished) and not body.found_in_place and self._progress is not None:
            # The last moments of the last step are over before anybody can ask for them.
            self._do_due(replace(self._progress, step=_LAST_STEP, fraction=1.0))
        if self._emit is not None:
            seen = isinstance(body, Looked) and body.fulfilled
            world = self.snapshot() if seen or isinstance(body, _WITH_WORLD) else None
            self._emit(body, time_s, world)

    def _restore(self, snapshot: AgentSnapshot) -> None:
        self._world.restore(snapshot.world)
        self._attempts = dict(snapshot.attempts)
        self._earlier_attempts = dict(snapshot.attempts)
        self._pending.restore(snapshot.pending)
