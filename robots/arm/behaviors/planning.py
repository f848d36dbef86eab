"""The plan for an errand amid what stands around: the one answer to whether an arm can do it."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

from mend.robots.arm.behaviors.behavior import Move, Step
from mend.robots.arm.behaviors.errand import Errand
from mend.robots.arm.behaviors.grasp_choice import (
    MARGIN_M,
    Crowding,
    Grip,
    crowding,
    grips,
    roominess_m,
    ways_to_grasp,
)
from mend.robots.arm.behaviors.legs import legs_of, table_box
from mend.robots.arm.body import ArmPath, Leg, NoWay, ToolPose
from mend.robots.arm.clearance import ROOM_M
from mend.robots.arm.grasp import Grasp
from mend.robots.arm.gripper import GripperModel
from mend.robots.execution.routine import Routine, T
from mend.robots.vision.seen_box import SeenBox
from mend.tasks.scene import Table

_MOST_BARS = 3
"""Where more stand in the arm's way, none of them is said to be."""


class Planner(Protocol):
    """What of a body is asked for a plan (`mend.robots.body.Body`)."""

    @property
    def gripper(self) -> GripperModel: ...

    def plan_among(self, legs: Sequence[Leg], boxes: Sequence[SeenBox]) -> ArmPath | NoWay: ...


@dataclass(frozen=True, slots=True)
class Spare:
    """The least room for the fingers, where what they close beside may stand `stray_m` nearer.

    `turns`: where there is none a small part may be turned otherwise than it is said to be.
    """

    least_m: float = MARGIN_M
    stray_m: float = 0.0
    turns: bool = False

    def is_left(self, tight: Crowding | None) -> bool:
        """Whether what stands closest leaves so much."""
        return tight is None or tight.room_m >= self.least_m


AS_SEEN = Spare(turns=True)
"""For a plan amid what is seen."""


@dataclass(frozen=True, slots=True)
class Plan:
    """All steps, the number of the first that is still to walk, and the path from there on."""

    steps: Sequence[Step]
    first: int
    path: ArmPath | None
    grasp: Grasp | None

    def segment_of(self, number: int) -> int:
        """Which segment of the path a moving step follows."""
        return len(waypoints_of(self.steps[self.first - 1 : number - 1]))

    @property
    def way(self) -> list[ToolPose]:
        """The poses that are still to go through."""
        return waypoints_of(self.steps[self.first - 1 :])

    @property
    def picked_at(self) -> ToolPose | None:
        """Where the tool point is when the gripper first closes; None if it holds already."""
        pose = None
        for step in self.steps[self.first - 1 :]:
            if isinstance(step.action, Move):
                pose = step.action.to
            elif step.action.to == "closed":
                return pose
        return None


@dataclass(frozen=True, slots=True)
class Barred:
    """Why there is no plan: what became of each way to grasp; `way` is what the best would be."""

    way: Sequence[ToolPose]
    refusals: Sequence[NoWay | Crowding]

    @property
    def reason(self) -> NoWay | Crowding:
        """No path, or no room; where there was room, that there is none otherwise is no reason."""
        return next((each for each in self.refusals if isinstance(each, NoWay)), self.refusals[0])

    @property
    def touched(self) -> Iterator[SeenBox]:
        """What the arm would touch, by one way to grasp or another."""
        for each in self.refusals:
            if isinstance(each, NoWay) and each.touched is not None:
                yield each.touched


@dataclass(frozen=True, slots=True)
class _WayToDo:
    """One way of doing it: its steps, the first that is to walk, and what leaves it least room."""

    steps: Sequence[Step]
    first: int
    grasp: Grasp | None
    tight: Crowding | None

    @property
    def left(self) -> Sequence[Step]:
        return self.steps[self.first - 1 :]


def plan_amid(
    errand: Errand,
    planner: Planner,
    table: Table,
    boxes: Sequence[SeenBox],
    spare: Spare = AS_SEEN,
) -> Routine[Plan | Barred]:
    """The plan by the way to grasp the object that has most room, of those that have a path.

    More than enough room is no better; of equals it is the first. Where many ways have no path that
    takes a while, so that a control cycle passes after each. Raises `UngraspableError`.
    """
    obstacles = [table_box(table), *boxes]
    refusals: list[NoWay | Crowding] = []
    best: _WayToDo | None = None
    for way in _roomiest_first(errand, planner.gripper, table, boxes, spare):
        best = best or way
        if way.tight is not None and not spare.is_left(way.tight):
            refusals.append(way.tight)
            continue
        legs = legs_of(way.left, errand.part, way.grasp, planner.gripper, carrying=errand.carrying)
        path = planner.plan_among(legs, obstacles) if legs else None
        if not isinstance(path, NoWay):
            return Plan(way.steps, way.first, path, way.grasp)
        refusals.append(path)
        yield
    return Barred([] if best is None else waypoints_of(best.left), refusals)


def bar_of(
    barred: Barred,
    boxes: Sequence[SeenBox],
    plan_without: Callable[[Sequence[SeenBox]], Routine[Plan | Barred]],
    stays: Callable[[SeenBox], bool],
) -> Routine[SeenBox | None]:
    """What could be taken away so that there is a path; None if that would not help.

    `stays` tells what cannot: the object stands on it, or is to. Raises `UngraspableError`.
    """
    first: SeenBox | None = None
    for _ in range(_MOST_BARS):
        touched = next((each for each in barred.touched if each in boxes and not stays(each)), None)
        if touched is None:
            return None
        first = first or touched
        # A plate and its knob have one name; pieces of something unknown have none, and go at once.
        boxes = [each for each in boxes if each.name != touched.name]
        without = yield from plan_without(boxes)
        if isinstance(without, Plan):
            return first
        barred = without
    return None


def at_once(routine: Routine[T]) -> T:
    """What comes of a routine that nobody has to wait for: it moves nothing."""
    while True:
        try:
            next(routine)
        except StopIteration as end:
            outcome: T = end.value
            return outcome


def waypoints_of(steps: Sequence[Step]) -> list[ToolPose]:
    """The poses that steps move through."""
    return [each.action.to for each in steps if isinstance(each.action, Move)]


def _roomiest_first(
    errand: Errand,
    gripper: GripperModel,
    table: Table,
    boxes: Sequence[SeenBox],
    spare: Spare,
) -> Iterator[_WayToDo]:
    """All ways, in their order where they have as much room; those that differ in nothing once.

    To find all of them takes long: one that has room enough is told before the next is laid out.
    """
    tight: list[_WayToDo] = []
    laid_out: set[tuple[Grasp | None, tuple[Step, ...]]] = set()
    known: dict[Sequence[Grip], Crowding | None] = {}
    for turned in (False, True):
        for situation in ways_to_grasp(errand, gripper, table.height, boxes, turned=turned):
            steps, grasp = errand.lay_out(situation), situation.grasp
            if (grasp, tuple(steps)) in laid_out:
                continue
            laid_out.add((grasp, tuple(steps)))
            first = errand.first(steps)
            # Ways that only pass higher grasp and let go alike.
            closings = grips(steps[first - 1 :], grasp, gripper)
            if closings not in known:
                known[closings] = crowding(closings, gripper, boxes, spare.stray_m)
            way = _WayToDo(steps, first, grasp, known[closings])
            if roominess_m(way.tight) >= ROOM_M:
                yield way
            else:
                tight.append(way)
        if not spare.turns or any(spare.is_left(each) for each in known.values()):
            break
    yield from sorted(tight, key=lambda each: -roominess_m(each.tight))
