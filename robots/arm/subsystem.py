"""An arm with its gripper and cameras, as a subsystem of a robot."""

from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Any

from mend.robots.arm.arm import Arm
from mend.robots.arm.behaviors.behavior import ArmBehavior
from mend.robots.arm.behaviors.execution import ArmExecution
from mend.robots.arm.behaviors.foresight import plan_ahead
from mend.robots.arm.behaviors.plan_memory import PlanMemory
from mend.robots.arm.behaviors.progress import ArmProgress
from mend.robots.arm.behaviors.work import Work
from mend.robots.arm.body import ArmBody
from mend.robots.arm.command_resolver import CommandResolver
from mend.robots.arm.looks import Looker, look_as_told
from mend.robots.arm.looks.shown import detection_of
from mend.robots.arm.monitors.monitor import ArmView
from mend.robots.arm.perception import FOREARM, Perception
from mend.robots.arm.perception.head import HEAD
from mend.robots.arm.result import JudgedResult
from mend.robots.arm.shown_arm import ShownArm
from mend.robots.body import CameraImage
from mend.robots.catalogue import Catalogue, Part
from mend.robots.execution.behavior import Behavior, of_kind
from mend.robots.execution.execution import AnyExecution
from mend.robots.execution.execution_state import ExecutionState
from mend.robots.execution.monitor import AnyMonitor, for_view
from mend.robots.execution.routine import Routine
from mend.robots.link.messages import (
    Avoid,
    Detection,
    Location,
    Look,
    Looked,
    MakeWay,
    NoteTaken,
    PoseLayout,
    Poses,
    ReachLimits,
    ReportBody,
    RoomLimits,
    Start,
    SwingLimits,
)
from mend.robots.vision.color_model import ColorModel
from mend.robots.vision.warming_up import warm_up

_EXPLAINING = frozenset({"missing", "undone", "unreachable"})
"""Without these monitors an object that is not there would leave the service without a word."""


class ArmSubsystem:
    """A `Subsystem`: what an arm does with the parts of a table, as its cameras see them."""

    def __init__(
        self,
        body: ArmBody,
        model: ColorModel,
        catalogue: Catalogue,
        behaviors: Mapping[str, type[Behavior]],
        monitors: Mapping[str, type[AnyMonitor]],
        perception: Perception | None = None,
        *,
        films: bool = True,
    ) -> None:
        """Of `behaviors` and `monitors` it takes those of arms.

        `films`: the forearm camera also takes pictures that only a clip before a fault needs.
        Raises `ValueError` without monitors that tell of a part that is not there.
        """
        if not monitors.keys() >= _EXPLAINING:
            raise ValueError(f"expected monitors for {sorted(_EXPLAINING)}, got {sorted(monitors)}")
        warm_up()
        self.effector = Arm(body)
        self._body = body
        self._behaviors = of_kind(behaviors, ArmBehavior)  # type: ignore[type-abstract]
        self._monitors = for_view(monitors.values(), ArmView)
        self._perception = perception or Perception(body, model, catalogue)
        self._resolver = CommandResolver(self._behaviors, catalogue, model.names)
        self._plans = PlanMemory()
        self._work: Work | None = None
        self._sought: tuple[Part, Location] | None = None
        self._films = films and FOREARM in body.cameras
        self._shown = ShownArm(body, catalogue, self._perception)

    keeps_clear = False
    driven = None
    avoids_ways = False
    base = None
    notes_taken = False
    between_floors = False

    @property
    def behaviors(self) -> Collection[str]:
        return self._behaviors

    @property
    def reach(self) -> ReachLimits:
        reach = self._body.reach
        return ReachLimits(
            x=reach.origin[0], y=reach.origin[1], min_m=reach.min_m, max_m=reach.max_m
        )

    @property
    def room(self) -> RoomLimits:
        room = self._body.room
        swing = room.swing
        return RoomLimits(
            resting=list(room.resting),
            hand_over=room.hand_over,
            around_m=room.around_m,
            swing=None if swing is None else SwingLimits(pivot=swing.pivot, tool=swing.tool),
            torso=list(room.torso),
        )

    def avoid(self, told: Avoid) -> None:
        """It goes nowhere."""

    def make_way(self, told: MakeWay) -> None:
        """An arm stands in nobody's way."""

    def note_taken(self, told: NoteTaken) -> None:
        """It has no basket."""

    def execution_of(self, start: Start, report: Callable[[ReportBody], None]) -> ArmExecution:
        """What a start command asks for, not begun. Raises `CommandError`."""
        assignment = self._resolver.assign(start)
        self._perception.hand.clip.begin()
        progress = ArmProgress(was_done=assignment.was_done, object_at=start.object_at)
        work = Work(assignment, progress, self.effector, self._perception, report, self._plans)
        self._work = work
        return ArmExecution(work, [each.create({}) for each in self._monitors])

    def look(
        self,
        command: str,
        look: Look,
        held: AnyExecution | None,
        report: Callable[[ReportBody], None],
    ) -> Routine[Looked]:
        """The routine of a look. Raises `CommandError`."""
        results = self._resolver.results_of(look.finished)
        # What is held in the middle of a step stays there: only a resume or a retreat moves it.
        may_move = (held is None or held.step == 0) and not self._perception.hand.holds()
        looker = self._looker(held, report, may_move=may_move, finished=results)
        routine = look_as_told(looker, command, look, self._resolver)
        self._sought = None
        if look.expect == "at_place":
            self._sought = self._resolver.object_of(look), self._resolver.place_of(look)
        return routine if look.expect is None else self._planning_ahead(routine)

    def _planning_ahead(self, routine: Routine[Looked]) -> Routine[Looked]:
        """Whoever waits for help with what is not done uses the time."""
        looked = yield from routine
        if self._work is not None and self._work.progress.state is not ExecutionState.FINISHED:
            plan_ahead(self._work)
        return looked

    def sought_in(self, camera: str, image: CameraImage) -> Detection | None:
        """The place of what a look waits to see there."""
        if self._sought is None or camera != HEAD:
            return None
        part, target = self._sought
        return detection_of(self._perception, image, part, None, target)

    def glance(self, command: str, held: AnyExecution | None) -> Looked:
        """What the head camera sees now; it judges no results."""
        return self._looker(held, _unheard, may_move=False).answer(command, None)

    def retreat(self) -> Routine[None]:
        """Open the gripper and go to neutral."""
        yield from self.effector.open_gripper()
        yield from self.effector.go_to_neutral()

    def film(self) -> None:
        """Take a picture for the clip if one is due."""
        if self._films:
            self._perception.hand.film()

    @property
    def clip(self) -> Sequence[CameraImage]:
        """What the forearm camera saw in the last seconds, oldest first."""
        return self._perception.hand.clip.images()

    def layout(self, layout: PoseLayout) -> PoseLayout:
        """Add the arm's joints, and every part of the catalogue."""
        return self._shown.layout(layout)

    def show(self, poses: Poses) -> Poses:
        """Add the joints and the tool now, and every part where it was located last."""
        return self._shown.poses(poses)

    def note(self, looked: Looked) -> None:
        """What was located is shown there from now on."""
        if looked.blind is None:
            self._shown.located = dict(looked.objects)

    def _looker(
        self,
        held: AnyExecution | None,
        report: Callable[[ReportBody], None],
        *,
        may_move: bool,
        finished: Sequence[JudgedResult] = (),
    ) -> Looker:
        return Looker(
            arm=self.effector,
            perception=self._perception,
            report=report,
            held=held if isinstance(held, ArmExecution) else None,
            may_move=may_move,
            finished=finished,
        )


def _unheard(_: Any) -> None:
    """A glance moves nothing, so that it has nothing to report."""
