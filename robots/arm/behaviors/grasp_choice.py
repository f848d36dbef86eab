"""Which of its grasps an object can be taken and placed by, and over what it has to be lifted."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from mend.robots.arm.behaviors.behavior import Move, SetGripper, Situation, Step
from mend.robots.arm.behaviors.errand import Errand
from mend.robots.arm.body import ToolPose
from mend.robots.arm.clearance import ROOM_M, Gap, room_around
from mend.robots.arm.grasp import Grasp, grasps_of, half_turn
from mend.robots.arm.gripper import GripperModel
from mend.robots.catalogue import Part
from mend.robots.link.messages import Location
from mend.robots.vision.seen_box import SeenBox

Vector = NDArray[np.float64]

LIFTS_M = (0.14, 0.10, 0.07)
"""So high above pick and place the tool point passes, where nothing tall stands on the way; lower
where the arm does not reach so high."""

_OVER_M = 0.015
"""What is carried passes so far above the tallest thing on the way."""
_BESIDE_M = 0.12
"""What stands so near to the straight way is on it: half a gripper, and half of what it carries."""

_HARDLY_M = 0.0015
"""Sides that differ by no more are now and then taken for one another by the head camera."""

_SMALL_M = 0.018
_MOST_TURN_RAD = math.radians(15.0)
"""So far is a part that is no longer now and then seen turned; closing fingers turn it straight."""
_ANY_TURN_RAD = math.radians(45.0)
"""Of one that is hardly not square as well nobody can tell how it is turned."""
_TURN_STEP_RAD = math.radians(2.5)

MARGIN_M = 0.0005
"""The least between the gripper and what stands beside an object, as it is seen: hardly more than
the gripper model has to spare, as scenes are checked for more."""


@dataclass(frozen=True, slots=True)
class Grip:
    """Fingers that close from `opening_m` to `closed_m`, or `at_place` open the other way."""

    tool: ToolPose
    opening_m: float
    closed_m: float
    at_place: bool


@dataclass(frozen=True, slots=True)
class Crowding:
    """What leaves the fingers least room to grasp the object, or to let go of it at its place."""

    by: SeenBox
    grip: Grip
    room_m: float

    @property
    def at_place(self) -> bool:
        return self.grip.at_place

    def __str__(self) -> str:
        where = "at its place" if self.at_place else "to grasp it"
        return f"{self.by.name or 'something unknown'} leaves no room for the fingers {where}"


def ways_to_grasp(
    errand: Errand,
    gripper: GripperModel,
    table_z: float,
    boxes: Sequence[SeenBox],
    *,
    turned: bool = False,
) -> Iterator[Situation]:
    """The situations in which the steps may be laid out, the best first.

    `turned`: those of a small part that is to be picked, turned by as much as it may be seen off.
    Raises `UngraspableError` where the gripper cannot take the object at all.
    """
    part, target = errand.part, errand.target
    ways_round = _ways_round(part, errand.found, target)
    if turned:
        ways_round = _turned(errand, ways_round)
        if not ways_round:
            return
    over_z = clear_z(ways_round[0], target, table_z, boxes)
    grasps = _grasps(errand, gripper)
    # Where the arm does not reach so high it may still find a way between what stands there.
    for clear_m, found, grasp, lift_m in product((over_z, table_z), ways_round, grasps, LIFTS_M):
        yield Situation(part, found, target, table_z, gripper, grasp, clear_m, lift_m)


def others(part: Part | None, boxes: Sequence[SeenBox]) -> list[SeenBox]:
    """What is seen but the part itself."""
    return [box for box in boxes if part is None or box.name != part.name]


def roominess_m(tight: Crowding | None) -> float:
    """By how much room one way of grasping is better than another: more than enough is no better.

    What is seen is never exact, so that the least that fits may touch.
    """
    return ROOM_M if tight is None else min(tight.room_m, ROOM_M)


def grips(steps: Sequence[Step], grasp: Grasp | None, gripper: GripperModel) -> tuple[Grip, ...]:
    """Where on a way the fingers close or open."""
    found = []
    pose: ToolPose | None = None
    opening_m, closed_m = 0.0, (0.0 if grasp is None else grasp.width_m)
    for step in steps:
        if isinstance(step.action, Move):
            pose = step.action.to
            opening_m = step.action.opening_m or opening_m
            continue
        closing = step.action == SetGripper("closed")
        if not closing:
            opening_m = step.action.opening_m or gripper.max_opening_m
        if pose is not None and opening_m > 0.0:
            found.append(Grip(pose, opening_m, closed_m, at_place=not closing))
    return tuple(found)


def crowding(
    grips: Sequence[Grip], gripper: GripperModel, boxes: Sequence[SeenBox], stray_m: float = 0.0
) -> Crowding | None:
    """What stands closest to where the fingers close or open; None if nothing is near.

    Where they close it may stand `stray_m` nearer than it is said to.
    """
    found: Crowding | None = None
    for each in grips:
        room = room_for(each, gripper, boxes, stray_m)
        if room is not None and (found is None or room.room_m < found.room_m):
            found = Crowding(room.to, each, room.room_m)
    return found


def room_for(
    grip: Grip, gripper: GripperModel, boxes: Sequence[SeenBox], stray_m: float
) -> Gap | None:
    """The room around fingers that close or open; None if nothing is near."""
    stray_m = 0.0 if grip.at_place else stray_m
    opening_m, closed_m = grip.opening_m, grip.closed_m
    return room_around(gripper, grip.tool, opening_m, boxes, closed_m=closed_m, stray_m=stray_m)


def _grasps(errand: Errand, gripper: GripperModel) -> Sequence[Grasp | None]:
    if errand.part is None:
        return [None]
    if errand.held_by is not None:
        return [errand.held_by]
    return grasps_of(errand.part, gripper)


def _ways_round(
    part: Part | None, found: Location | None, target: Location | None
) -> list[Location | None]:
    """Where the object is; one that is square, or hardly not, may lie two ways round.

    Of what is square first the one that has to be turned less on its way; of what is hardly not
    first the one that was seen: a camera may be wrong about it.
    """
    if part is None or found is None:
        return [None]
    first, quarter = found.yaw, math.pi / 2
    if part.off_square_m == 0.0 and target is not None:
        first = target.yaw + math.remainder(first - target.yaw, quarter)
    yaws = [first] if part.off_square_m > _HARDLY_M else [first, first + quarter]
    return [Location(x=found.x, y=found.y, z=found.z, yaw=half_turn(yaw)) for yaw in yaws]


def _turned(errand: Errand, ways_round: Sequence[Location | None]) -> list[Location | None]:
    part = errand.part
    if part is None or errand.held_by is not None or max(part.size[:2]) > _SMALL_M:
        return []
    most = _ANY_TURN_RAD if part.off_square_m <= _HARDLY_M else _MOST_TURN_RAD
    steps = round(most / _TURN_STEP_RAD)
    turns = [sign * step * _TURN_STEP_RAD for step in range(1, steps + 1) for sign in (1, -1)]
    return [
        found.model_copy(update={"yaw": half_turn(found.yaw + turn)})
        for turn in turns
        for found in ways_round
        if found is not None
    ]


def clear_z(
    found: Location | None, target: Location | None, table_z: float, boxes: Sequence[SeenBox]
) -> float:
    """Over what stands on the way."""
    ends = [np.array([each.x, each.y]) for each in (found, target) if each is not None]
    tops = [table_z]
    if ends:
        tops += [each.top_z for each in boxes if _distance_m(each, ends[0], ends[-1]) < _BESIDE_M]
    return max(tops) + _OVER_M


def _distance_m(box: SeenBox, start: Vector, end: Vector) -> float:
    """From a box to the straight way, in the plane."""
    along = end - start
    length_2 = float(along @ along)
    to_box = np.array([box.x, box.y]) - start
    share = float(np.clip(to_box @ along / length_2, 0.0, 1.0)) if length_2 > 0.0 else 0.0
    nearest = start + share * along
    radius_m = math.hypot(box.size[0], box.size[1]) / 2
    return math.hypot(box.x - nearest[0], box.y - nearest[1]) - radius_m
