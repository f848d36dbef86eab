"""One robot: takes commands, walks behaviors, looks, and reports, over any body."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from pydantic import ValidationError

from robots.agent import Emit, EmitPicture
from robots.arm import Arm, Routine
from robots.behaviors.behavior import Behavior
from robots.behaviors.execution import Execution
from robots.behaviors.execution_state import ExecutionState
from robots.behaviors.preparation import Assignment
from robots.body import Body
from robots.catalogue import Catalogue, Part
from robots.link.messages import (
    PROTOCOL_VERSION,
    ActiveExecution,
    CommandBody,
    Finished,
    Hello,
    Holding,
    Interrupt,
    IssueDetected,
    Location,
    Look,
    Looked,
    Picture,
    PoseLayout,
    Poses,
    ReachLimits,
    Rejected,
    ReportBody,
    Resume,
    ShownObject,
    ShownPose,
    Shutdown,
    Sighting,
    SlowDown,
    Start,
    TakePicture,
)
from robots.looks import (
    AtPlace,
    Expectation,
    InReach,
    Looker,
    WayClear,
    look_once,
    look_until,
    take_from_person,
)
from robots.monitors.monitor import Monitor
from robots.senses import Senses
from robots.showing import JointedBody, pose_values, sighted_values
from robots.vision.color_model import ColorModel
from robots.vision.drawing import encode_jpeg

_SEEN_AT_ONCE = (IssueDetected, Finished, Looked, Rejected)
"""Reports that the service must see before more time passes."""

_EXPLAINING = frozenset({"missing", "unreachable"})
"""Without these monitors an object that is not there would leave the service without a word."""


class CommandError(Exception):
    """A command cannot be carried out; the message says why."""


@dataclass(frozen=True, slots=True)
class TaskProgress:
    """How far the behavior under way is: `fraction` in [0, 1] of `step`.

    `attempt` counts the starts of a behavior with this object from 1.
    """

    object: str | None
    step: int
    fraction: float
    attempt: int


class Robot:
    """An `AgentCore` over a body.

    One activity is under way at a time: an execution or a look. A new command replaces a look
    under way, which is then not reported. What comes while the arm retreats waits until it is
    at neutral.
    """

    def __init__(
        self,
        name: str,
        body: Body,
        model: ColorModel,
        catalogue: Catalogue,
        behaviors: Mapping[str, type[Behavior]],
        monitors: Mapping[str, type[Monitor[Any]]],
        monitor_parameters: Mapping[str, Mapping[str, Any]] | None = None,
        senses: Senses | None = None,
    ) -> None:
        if not monitors.keys() >= _EXPLAINING:
            raise ValueError(f"expected monitors for {sorted(_EXPLAINING)}, got {sorted(monitors)}")
        self._name = name
        self._body = body
        self._catalogue = catalogue
        self._behaviors = dict(behaviors)
        self._monitors = dict(monitors)
        self._monitor_parameters = dict(monitor_parameters or {})
        self._arm = Arm(body)
        self._senses = senses or Senses(body, model, catalogue)
        self._emit: Emit | None = None
        self._emit_picture: EmitPicture | None = None
        self._activity: Routine[None] | None = None
        self._decided: Routine[None] | None = None
        self._looking = False
        self._execution: Execution | None = None
        self._attempts: dict[str, int] = {}
        self._waiting: list[tuple[str, CommandBody]] = []
        self._located: dict[str, Sighting] = {}
        self._reported = False
        self._shut_down = False

    # --- What it is ---------------------------------------------------------------------------

    def hello(self, boot: str) -> Hello:
        """What the robot is, and what it is doing now."""
        reach = self._body.reach
        return Hello(
            protocol=PROTOCOL_VERSION,
            robot=self._name,
            boot=boot,
            behaviors=sorted(self._behaviors),
            cameras=sorted(self._body.cameras),
            reach=ReachLimits(
                x=reach.origin[0], y=reach.origin[1], min_m=reach.min_m, max_m=reach.max_m
            ),
            executing=self._active_execution(),
            time=self.time_s(),
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
        return self._activity is not None

    @property
    def task_progress(self) -> TaskProgress | None:
        """How far the behavior under way is; None if there is none."""
        execution = self._execution
        if execution is None or execution.over:
            return None
        name = None if execution.part is None else execution.part.name
        fraction = 1.0 if not self._body.moving else self._body.progress
        return TaskProgress(name, execution.step, fraction, self._attempts.get(name or "", 1))

    def pose_layout(self) -> PoseLayout:
        """What `poses` holds: the body's joints, and every part of the catalogue."""
        body = self._body if isinstance(self._body, JointedBody) else None
        return PoseLayout(
            model=body.model if body else None,
            joints=list(body.joint_names) if body else [],
            objects=[
                ShownObject(name=part.name, size=part.size, knob=part.knob)
                for part in self._catalogue.parts.values()
            ],
        )

    def poses(self) -> Poses:
        """The joints and the tool now, and every part where it was located last."""
        body = self._body if isinstance(self._body, JointedBody) else None
        return Poses(
            time=self.time_s(),
            joints=[float(each) for each in body.joint_positions()] if body else [],
            tool=pose_values(self._body.tool_pose()),
            opening_m=float(self._body.gripper_opening_m()),
            objects=[self._shown(name) for name in self._catalogue.parts],
        )

    def _shown(self, name: str) -> ShownPose:
        located = self._located.get(name)
        if self._senses.holds(name):
            return ShownPose(pose=pose_values(self._body.tool_pose()), held=True)
        if located is None:
            return ShownPose(pose=(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0), hidden=True)
        return ShownPose(pose=sighted_values(located))

    def attach(self, emit: Emit, emit_picture: EmitPicture) -> None:
        """Say where reports and pictures go; called once, before anything else."""
        self._emit, self._emit_picture = emit, emit_picture

    # --- Time ---------------------------------------------------------------------------------

    def advance(self, duration_s: float) -> bool:
        """Let up to `duration_s` pass; False when nothing is under way (no time passes then)."""
        end_s = self.time_s() + duration_s
        self._reported = False
        while self._activity is not None and not self._reported:
            if self._decided is not self._activity:
                self._decide(self._activity)
            elif self.time_s() < end_s - 1e-9:
                self._body.advance_cycle()
                self._decided = None
            else:
                break
        return self._activity is not None

    def _decide(self, activity: Routine[None]) -> None:
        """Let the activity decide, once, on what the next cycle is to do."""
        try:
            next(activity)
            self._decided = activity
        except StopIteration:
            if self._activity is activity:
                self._activity, self._looking = None, False
            self._take_waiting()

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
            self._report(Rejected(command=command_id, reason=str(error)))

    def _take(self, command_id: str, body: CommandBody) -> None:
        if isinstance(body, Start | Resume | Look) and self._retreating:
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
                self._arm.slow_down(body.factor)
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
        assignment = self._assign(start)
        self._drop_look()
        if self._execution is not None and not self._execution.over:
            self._execution.end()
        if assignment.part is not None:
            name = assignment.part.name
            self._attempts[name] = self._attempts.get(name, 0) + 1
        monitors = [
            kind.create(self._monitor_parameters.get(name, {}))
            for name, kind in self._monitors.items()
        ]
        self._execution = Execution(assignment, monitors, self._arm, self._senses, self._report)
        self._activity = self._execution.run()

    def _assign(self, start: Start) -> Assignment:
        behavior = self._behaviors.get(start.behavior)
        if behavior is None:
            known = ", ".join(sorted(self._behaviors))
            raise CommandError(f"behavior '{start.behavior}' is unknown; this robot has {known}")
        try:
            parameters = behavior.parameters.model_validate(start.parameters)
        except ValidationError as error:
            first = error.errors()[0]
            where = ".".join(str(each) for each in first["loc"]) or "parameters"
            raise CommandError(f"{start.behavior}: {where}: {first['msg']}") from error
        part = self._part(getattr(parameters, "object", None), start.size)
        target = start.target or self._target(getattr(parameters, "place", None))
        needs_help = bool(getattr(parameters, "needs_help", False))
        return Assignment(
            execution=start.execution,
            behavior=behavior(),
            parameters=parameters,
            part=part,
            target=target,
            needs_help=needs_help or (part is not None and part.needs_help),
        )

    def _part(self, name: str | None, size: tuple[float, float, float] | None) -> Part | None:
        if name is None:
            return None
        part = self._catalogue.parts.get(name)
        if part is None:
            if size is None:
                raise CommandError(f"object '{name}' is unknown, and the command gives no size")
            part = Part(name, size)
        if name not in self._senses.known_colors:
            raise CommandError(f"the colour model was not trained for object '{name}'")
        return part

    def _target(self, name: str | None) -> Location | None:
        if name is None:
            return None
        target = self._catalogue.places.get(name)
        if target is None:
            raise CommandError(f"place '{name}' is unknown, and the command gives no target")
        return target

    def _interrupt(self, interrupt: Interrupt) -> None:
        self._waiting.clear()
        self._arm.stop()
        self._drop_look()
        execution = self._execution
        if execution is None or execution.over:
            if interrupt.retreat:
                self._activity = self._retreat_idle()
            else:
                self._report(Holding(execution=None, at=self._where()))
        elif interrupt.retreat:
            self._activity = execution.retreat(end=True)
        else:
            self._activity = None
            execution.hold()
            self._report(Holding(execution=execution.id, at=self._where()))

    def _retreat_idle(self) -> Routine[None]:
        yield from self._arm.open_gripper()
        yield from self._arm.go_to_neutral()
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
        self._activity = execution.resume()

    def _look(self, command_id: str, look: Look) -> None:
        if self._executing:
            if look.expect is not None:
                raise CommandError(f"cannot look for '{look.expect}' while a behavior is under way")
            self._report(self._looker().answer(command_id, None))
            return
        routine = self._look_routine(command_id, look)
        self._drop_look()
        self._activity, self._looking = self._report_look(routine), True

    def _look_routine(self, command_id: str, look: Look) -> Routine[Looked]:
        looker = self._looker()
        if look.expect is None:
            return look_once(looker, command_id)
        if look.expect == "in_gripper":
            return take_from_person(looker, command_id, self._object_of(look), look.within_s)
        make: dict[str, Callable[[], Expectation]] = {
            "at_place": lambda: AtPlace(looker, self._object_of(look), self._place_of(look)),
            "in_reach": lambda: InReach(looker, self._object_of(look)),
            "way_clear": lambda: WayClear(looker),
        }
        return look_until(looker, command_id, make[look.expect](), look.within_s)

    def _object_of(self, look: Look) -> Part:
        part = self._part(look.object, None)
        if part is None:
            raise CommandError(f"a look for '{look.expect}' needs an object")
        return part

    def _place_of(self, look: Look) -> Location:
        target = self._target(look.place)
        if target is None:
            raise CommandError(f"a look for '{look.expect}' needs a place")
        return target

    def _report_look(self, routine: Routine[Looked]) -> Routine[None]:
        looked = yield from routine
        self._report(looked)

    def _take_picture(self, command_id: str, take: TakePicture) -> None:
        camera = self._body.cameras.get(take.camera)
        if camera is None:
            known = ", ".join(sorted(self._body.cameras))
            raise CommandError(f"camera '{take.camera}' is unknown; this robot has {known}")
        if self._emit_picture is not None:
            jpeg = encode_jpeg(camera.capture().bgr)
            self._emit_picture(Picture(command=command_id, camera=take.camera, jpeg=jpeg))

    # --- Within -------------------------------------------------------------------------------

    @property
    def _executing(self) -> bool:
        return self._activity is not None and not self._looking

    @property
    def _retreating(self) -> bool:
        execution = self._execution
        return (
            self._executing
            and execution is not None
            and execution.state is ExecutionState.RETREATING
        )

    def _drop_look(self) -> None:
        if self._looking:
            self._arm.stop()
            self._activity, self._looking = None, False

    def _looker(self) -> Looker:
        held = None if self._execution is None or self._execution.over else self._execution
        # What is held in the middle of a step stays there: only a resume or a retreat moves it.
        may_move = not self._executing and (held is None or held.step == 0)
        return Looker(
            arm=self._arm,
            senses=self._senses,
            report=self._report,
            execution=None if held is None else held.id,
            way=[] if held is None else held.way,
            may_move=may_move and not self._senses.holds(),
        )

    def _where(self) -> Any:
        return "neutral" if self._arm.at_neutral else "in_place"

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
        if isinstance(body, Looked):
            self._located = dict(body.objects)
        if self._emit is not None:
            self._emit(body, self.time_s(), None)
