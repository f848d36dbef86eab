"""One robot: takes commands, drives executions and looks, and reports, over any body."""

import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from mend.robots.agent import Emit, EmitPicture
from mend.robots.body import Body, CameraImage
from mend.robots.clip import encode_clip
from mend.robots.execution.command_error import CommandError
from mend.robots.execution.execution import AnyExecution
from mend.robots.execution.execution_state import ExecutionState
from mend.robots.execution.monitor import BEFORE_FIRST_STEP
from mend.robots.execution.routine import Routine
from mend.robots.execution.subsystem import Subsystem
from mend.robots.execution.watch import MonitorFailedError
from mend.robots.link.messages import (
    IDENTITY,
    PROTOCOL_VERSION,
    ActiveExecution,
    Avoid,
    ClipTaken,
    CommandBody,
    Driven,
    Finished,
    Hello,
    Holding,
    Interrupt,
    IssueDetected,
    Look,
    Looked,
    MakeWay,
    NoteTaken,
    Picture,
    PoseLayout,
    Poses,
    Rejected,
    ReportBody,
    Resume,
    Shutdown,
    SlowDown,
    Start,
    TakePicture,
)
from mend.robots.task_progress import TaskProgress
from mend.robots.vision.drawing import encode_jpeg

log = logging.getLogger(__name__)

_SEEN_AT_ONCE = (IssueDetected, Finished, Looked, Rejected)
"""Reports that the service must see before more time passes."""


@dataclass(frozen=True, slots=True)
class _OwedClip:
    """What was seen before an issue that was reported at `time_s`."""

    execution: str
    issue: str
    time_s: float
    images: Sequence[CameraImage]


class Robot:
    """An `AgentCore` over a body, with an arm, a base, or both.

    One activity is under way at a time: an execution or a look. A new command replaces a look
    under way, which is then not reported. What comes while it retreats or brakes waits for its end.
    A behavior is done by the subsystem that has it; looks belong to that of the execution that
    waits, or else to the first.
    """

    def __init__(self, name: str, body: Body, subsystems: Sequence[Subsystem]) -> None:
        """Raises `ValueError` without a subsystem, and where two have a behavior of one name."""
        self._subsystem_of = {name: each for each in subsystems for name in each.behaviors}
        if not subsystems or len(self._subsystem_of) < sum(len(e.behaviors) for e in subsystems):
            raise ValueError("expected subsystems, of which no two have a behavior of one name")
        self._name = name
        self._body = body
        self._subsystems = tuple(subsystems)
        self._acting = subsystems[0]
        self._emit: Emit | None = None
        self._emit_picture: EmitPicture | None = None
        self._activity: Routine[None] | None = None
        self._decided: Routine[None] | None = None
        self._looker: Subsystem | None = None
        self._calming: Routine[None] | None = None
        self._execution: AnyExecution | None = None
        self._attempts: dict[str, int] = {}
        self._waiting: list[tuple[str, CommandBody]] = []
        self._owed_clip: _OwedClip | None = None
        self._reported = False
        self._shut_down = False
        self._told = ""
        """The command by which it began or went on last."""
        self._unfit: str | None = None
        """Why it does nothing any more."""

    # --- What it is ---------------------------------------------------------------------------

    @property
    def name(self) -> str:
        return self._name

    def hello(self, boot: str) -> Hello:
        """What the robot is, and what it is doing now."""
        subsystems = self._subsystems
        return Hello(
            protocol=PROTOCOL_VERSION,
            robot=self._name,
            boot=boot,
            behaviors=sorted(self._subsystem_of),
            cameras=sorted(self._body.cameras),
            reach=next((each.reach for each in subsystems if each.reach is not None), None),
            executing=self._active_execution(),
            time=self.time_s(),
            room=next((each.room for each in subsystems if each.room is not None), None),
            keeps_clear=all(each.keeps_clear for each in subsystems),
            avoids_ways=any(each.avoids_ways for each in subsystems),
            base=next((each.base for each in subsystems if each.base is not None), None),
            notes_taken=any(each.notes_taken for each in subsystems),
        )

    @property
    def pace(self) -> float | None:
        """As fast as the body's own clock goes."""
        return None

    def time_s(self) -> float:
        """The world's clock."""
        return self._body.time_s()

    @property
    def shut_down(self) -> bool:
        """Whether a `shutdown` command came."""
        return self._shut_down

    @property
    def busy(self) -> bool:
        """Whether anything is under way."""
        return self._activity is not None or self._owed_clip is not None

    @property
    def task_progress(self) -> TaskProgress | None:
        """How far the behavior under way is; None if there is none."""
        execution = self._execution
        if execution is None or execution.over:
            return None
        name = execution.object
        attempt = self._attempts.get(name or "", 1)
        return TaskProgress(name, execution.step, execution.fraction, attempt)

    def pose_layout(self) -> PoseLayout:
        """What `poses` holds: the body's joints, and all that is known of."""
        layout = PoseLayout()
        for each in self._subsystems:
            layout = each.layout(layout)
        return layout

    def poses(self) -> Poses:
        """Where all of that is now."""
        poses = Poses(time=self.time_s(), tool=IDENTITY, opening_m=0.0)
        for each in self._subsystems:
            poses = each.show(poses)
        return poses

    def driven(self) -> Driven | None:
        """What its base has driven so far; None without one."""
        told = (each.driven for each in self._subsystems)
        return next((each for each in told if each is not None), None)

    def attach(self, emit: Emit, emit_picture: EmitPicture) -> None:
        """Say where reports and pictures go; called once, before anything else."""
        self._emit, self._emit_picture = emit, emit_picture

    # --- Time ---------------------------------------------------------------------------------

    def advance(self, duration_s: float) -> bool:
        """Let up to `duration_s` pass; False when nothing is under way (no time passes then)."""
        end_s = self.time_s() + duration_s
        self.begin_slice()
        self.decide()
        while self.active and not self._reported and self.time_s() < end_s - 1e-9:
            self._body.advance_cycle()
            self.end_cycle()
            self.decide()
        return self.busy

    def begin_slice(self) -> None:
        """Some time is about to pass, of which the service has heard all that came before."""
        self._reported = False
        self._hand_in_clip()

    def decide(self) -> None:
        """Decide, once, on what the next control cycle is to do."""
        while self._activity is not None and not self._reported:
            if self._decided is self._activity:
                return
            self._decide(self._activity)

    def end_cycle(self) -> None:
        """A control cycle has passed."""
        if self._activity is None:
            return
        self._decided = None
        if self._walking:
            self._acting.film()

    @property
    def active(self) -> bool:
        """Whether it needs time to pass."""
        return self._activity is not None

    @property
    def attempts(self) -> Mapping[str, int]:
        """How often it was told to handle each object."""
        return self._attempts

    def _hand_in_clip(self) -> None:
        """Report what was seen before the last issue, which people have heard of by now."""
        owed, self._owed_clip = self._owed_clip, None
        if owed is not None:
            pictures = encode_clip(owed.images, owed.time_s)
            self._report(ClipTaken(execution=owed.execution, issue=owed.issue, pictures=pictures))

    def _decide(self, activity: Routine[None]) -> None:
        """Let the activity decide, once, on what the next cycle is to do."""
        try:
            next(activity)
            self._decided = activity
        except StopIteration:
            if self._activity is activity:
                self._activity = self._looker = None
            self._take_waiting()
        except MonitorFailedError as error:
            log.exception("robot %s does nothing any more", self._name)
            self._activity, self._unfit = None, str(error)
            self._acting.effector.stop()
            self._reject(self._told, self._unfit)

    def _take_waiting(self) -> None:
        waiting, self._waiting = self._waiting, []
        for command_id, body in waiting:
            self.handle(command_id, body)

    # --- Commands -----------------------------------------------------------------------------

    def handle(self, command_id: str, body: CommandBody) -> None:
        """Take a command. One that cannot be carried out is answered by a `Rejected` report."""
        try:
            self._take(command_id, body)
        except CommandError as error:
            self._reject(command_id, str(error))

    def _reject(self, command_id: str, reason: str) -> None:
        unfit = self._unfit is not None
        self._report(Rejected(command=command_id, reason=reason, for_good=unfit))

    def _take(self, command_id: str, body: CommandBody) -> None:
        if isinstance(body, Start | Resume):
            if self._unfit is not None:
                raise CommandError(self._unfit)
            self._told = command_id
        if isinstance(body, Start | Resume | Look) and self._coming_to_rest:
            self._waiting.append((command_id, body))
            return
        if isinstance(body, Start) and not self._executing and self._between_floors:
            self._drop_look()
            self._activity = self._calming = self._ride_on()
            self._waiting.append((command_id, body))
            return
        match body:
            case Start():
                self._start(body)
            case Interrupt():
                self._interrupt(body)
            case Resume():
                self._resume(body)
            case Look():
                self._look(command_id, body)
            case SlowDown():
                for each in self._subsystems:
                    each.effector.slow_down(body.factor)
            case Avoid():
                for each in self._subsystems:
                    each.avoid(body)
            case MakeWay():
                for each in self._subsystems:
                    each.make_way(body)
            case NoteTaken():
                for each in self._subsystems:
                    each.note_taken(body)
            case TakePicture():
                self._take_picture(command_id, body)
            case Shutdown():
                self._shut_down = True
            case _:
                raise CommandError(f"only a simulated world can do '{body.type}'")

    def _start(self, start: Start) -> None:
        if self._executing:
            raise CommandError(
                f"a behavior is still under way; interrupt it before starting '{start.behavior}'"
            )
        subsystem = self._subsystem_of.get(start.behavior)
        if subsystem is None:
            known = ", ".join(sorted(self._subsystem_of))
            raise CommandError(f"behavior '{start.behavior}' is unknown; this robot has {known}")
        execution = subsystem.execution_of(start, self._report)
        self._drop_look()
        if self._execution is not None and not self._execution.over:
            self._execution.end()
        if execution.object is not None:
            self._attempts[execution.object] = self._attempts.get(execution.object, 0) + 1
        self._acting, self._execution = subsystem, execution
        self._activity = execution.run()

    def _interrupt(self, interrupt: Interrupt) -> None:
        self._waiting.clear()
        self._acting.effector.stop()
        self._drop_look()
        execution = self._execution
        if execution is None or execution.over:
            if interrupt.retreat:
                self._activity = self._calming = self._retreat_idle()
            else:
                self._hold(None)
        elif interrupt.retreat:
            self._activity = execution.retreat(end=True)
        else:
            execution.hold()
            self._hold(execution.id)

    def _hold(self, execution: str | None) -> None:
        """Say that it holds, once it stands."""
        if self._acting.effector.braking:
            self._activity = self._calming = self._brake(execution)
        else:
            self._activity = None
            self._report(Holding(execution=execution, at=self._where()))

    def _brake(self, execution: str | None) -> Routine[None]:
        while self._acting.effector.braking:
            yield
        self._report(Holding(execution=execution, at=self._where()))

    def _ride_on(self) -> Routine[None]:
        """Wait until it is on a floor: its program may have begun anew in the middle of a ride."""
        while self._between_floors:
            yield

    def _retreat_idle(self) -> Routine[None]:
        for each in self._subsystems:
            yield from each.retreat()
        self._report(Holding(execution=None, at="neutral"))

    def _resume(self, resume: Resume) -> None:
        execution = self._execution
        if execution is None or execution.over or execution.id != resume.execution:
            raise CommandError(f"execution '{resume.execution}' is not held by this robot")
        if execution.state is not ExecutionState.HOLDING:
            raise CommandError(
                f"execution '{resume.execution}' is {execution.state}; only a held one can resume"
            )
        self._drop_look()
        self._activity = execution.resume(resume)

    def _look(self, command_id: str, look: Look) -> None:
        held = None if self._execution is None or self._execution.over else self._execution
        subsystem = self._subsystems[0] if held is None else self._acting
        if self._executing:
            if look.expect is not None:
                raise CommandError(f"cannot look for '{look.expect}' while a behavior is under way")
            self._report(subsystem.glance(command_id, held))
            return
        routine = subsystem.look(command_id, look, held, self._report)
        self._drop_look()
        self._activity, self._looker = self._report_look(routine), subsystem

    def _report_look(self, routine: Routine[Looked]) -> Routine[None]:
        looked = yield from routine
        self._report(looked)

    def _take_picture(self, command_id: str, take: TakePicture) -> None:
        camera = self._body.cameras.get(take.camera)
        if camera is None:
            known = ", ".join(sorted(self._body.cameras))
            raise CommandError(f"camera '{take.camera}' is unknown; this robot has {known}")
        if self._emit_picture is None:
            return
        image, looker = camera.capture(), self._looker
        self._emit_picture(
            Picture(
                command=command_id,
                camera=take.camera,
                jpeg=encode_jpeg(image.bgr),
                detection=None if looker is None else looker.sought_in(take.camera, image),
            )
        )

    # --- Within -------------------------------------------------------------------------------

    @property
    def _executing(self) -> bool:
        return self._activity is not None and self._looker is None

    @property
    def _between_floors(self) -> bool:
        return any(each.between_floors for each in self._subsystems)

    @property
    def _walking(self) -> bool:
        """Whether an execution is between its first step and its last."""
        execution = self._execution
        return execution is not None and execution.state is ExecutionState.RUNNING

    @property
    def _coming_to_rest(self) -> bool:
        """Whether it retreats, or brakes before it holds, with an execution or without."""
        if self._activity is not None and self._activity is self._calming:
            return True
        execution = self._execution
        return (
            self._executing
            and execution is not None
            and execution.state is ExecutionState.RETREATING
        )

    def _drop_look(self) -> None:
        if self._looker is not None:
            self._acting.effector.stop()
            self._activity = self._looker = None

    def _where(self) -> Any:
        return "neutral" if self._acting.effector.at_rest else "in_place"

    def _active_execution(self) -> ActiveExecution | None:
        execution = self._execution
        if execution is None or execution.over:
            return None
        names: dict[ExecutionState, Any] = {
            ExecutionState.HOLDING: "holding",
            ExecutionState.RETREATING: "retreating",
        }
        state = names.get(execution.state, "running")
        return ActiveExecution(execution=execution.id, state=state, step=execution.step)

    def _report(self, body: ReportBody) -> None:
        if isinstance(body, _SEEN_AT_ONCE):
            self._reported = True
        if isinstance(body, IssueDetected) and body.step > BEFORE_FIRST_STEP:
            images = self._acting.clip
            if images:
                self._owed_clip = _OwedClip(body.execution, body.issue, self.time_s(), images)
        if isinstance(body, Looked):
            for each in self._subsystems:
                each.note(body)
        if self._emit is not None:
            self._emit(body, self.time_s(), None)
