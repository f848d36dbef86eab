"""Where a scatter may put a part and what stands around it, at its worst for the arm.

A world draws every part by itself, and anew what comes nearer to another than `DRAWN_APART_M`.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
import shapely
from numpy.typing import NDArray

from mend.robots.arm.behaviors.errand import Errand
from mend.robots.arm.behaviors.grasp_choice import MARGIN_M, Grip, grips, ways_to_grasp
from mend.robots.arm.clearance import rooms_around
from mend.robots.arm.feasibility.standing import Standing, beneath
from mend.robots.arm.gripper import GripperModel
from mend.robots.vision.seen_box import SeenBox
from mend.tasks.scene import DRAWN_APART_M, Pose, Scatter

Rooms = NDArray[np.float64]
"""The room in metres that each way to grasp (n) has."""

_MOST_STEP_M, _MOST_STEPS = 0.01, 4
"""Between the places of something that are looked at: in less room than fingers are thick."""
_MOST_TURN_RAD = 0.3
"""Between the directions of a part that are looked at."""
NEAR_M = 0.25
"""What is never so near to either end of the way is left where it is."""
_PLENTY_M = 0.01
"""More room for the fingers is no better."""
_PULL = 1e-3
"""What leaves the fingers as much room is worse where it is nearer to the arm's way."""


@dataclass(frozen=True, slots=True)
class Draw:
    """A part as it is seen at a pose, and what stands around it then."""

    at: Pose
    around: Sequence[Standing]


@dataclass(frozen=True, slots=True)
class Options:
    """The extremes of where a scatter may put something, first where the scene says.

    `outlines` (options, boxes) are those of `boxes`, `middles` (options, 2) where each stands; no
    corner is more than `strays_m` from where it is at rest.
    """

    standings: Sequence[Standing]
    boxes: Sequence[SeenBox]
    outlines: NDArray[np.object_]
    middles: NDArray[np.float64]
    strays_m: float

    @property
    def at_rest(self) -> Standing:
        """Where the scene says."""
        return self.standings[0]


def options_of(standing: Standing, scatter: Scatter) -> Options:
    """Where something that starts may be; what is at its place is there."""
    poses = [standing.pose]
    shifts_m = _spread(scatter.xy, _MOST_STEP_M, _MOST_STEPS)
    if standing.where[0] == "objects":
        moved = [
            standing.pose.model_copy(
                update={
                    "x": standing.pose.x + dx,
                    "y": standing.pose.y + dy,
                    "yaw": standing.pose.yaw + turn,
                }
            )
            for dx, dy, turn in product(shifts_m, shifts_m, turns_of(scatter))
        ]
        poses += [each for each in moved if each != standing.pose]
    standings = [replace(standing, pose=pose) for pose in poses]
    boxes = [box for each in standings for box in each.boxes]
    outlines = np.asarray(shapely.polygons(np.array([box.corners() for box in boxes])))
    middles = np.array([(pose.x, pose.y) for pose in poses])
    strays_m = 0.0
    if len(poses) > 1:
        turned_m = 2 * _radius_m(standing) * math.sin(min(scatter.yaw, math.pi) / 2)
        strays_m = math.sqrt(2) * scatter.xy + turned_m
    return Options(standings, boxes, outlines.reshape(len(poses), -1), middles, strays_m)


def turns_of(scatter: Scatter) -> list[float]:
    """The directions that are looked at, from one end to the other."""
    return _spread(scatter.yaw, _MOST_TURN_RAD)


def _spread(most: float, step: float, most_steps: int = 12) -> list[float]:
    """From -most to most, 0 among them, hardly farther apart than a step."""
    if most == 0.0:
        return [0.0]
    steps = min(math.ceil(most / step), most_steps)
    return [most * each / steps for each in range(-steps, steps + 1)]


class Surroundings:
    """What stands around a part and its place, wherever a scatter may put it."""

    def __init__(
        self,
        start: Standing,
        place: Standing | None,
        options: Sequence[Options],
        gripper: GripperModel,
        table_z: float,
    ) -> None:
        self._start = start
        self._gripper, self._table_z = gripper, table_z
        ends = [(each.pose.x, each.pose.y) for each in (start, place) if each is not None]
        self._ends = np.array(ends)
        ordered = sorted(options, key=lambda each: self._away_m(each)[0])
        self._near = [each for each in ordered if self._away_m(each).min() < NEAR_M]
        self._far = [each.at_rest for each in ordered if self._away_m(each).min() >= NEAR_M]
        self._below = {each.where for each in beneath(start, [e.at_rest for e in options])}
        self._at_rest = [(box, each.strays_m) for each in self._near for box in each.at_rest.boxes]
        self._rest_outlines = _joined([each.outlines[0] for each in self._near])
        self._boxes = [box for each in self._near for box in each.boxes]
        self._outlines = _joined([each.outlines.ravel() for each in self._near])
        self._left: dict[Grip, Rooms] = {}

    def worst(self, cases: Sequence[tuple[Errand, Pose]]) -> tuple[Errand, Draw] | None:
        """Of some errands with a part at a pose the one with least room for the fingers.

        And what then stands around it, where that leaves least. None where a world would draw all
        of them anew.
        """
        tight = [(errand, at) for errand, at in cases if self._may_be_tight(errand)]
        worst: tuple[float, Errand, Draw] | None = None
        for errand, at in tight or cases:
            found = self._drawn(at, list(self._ways(errand)) if tight else [])
            if found is not None and (worst is None or found[0] < worst[0]):
                worst = (found[0], errand, found[1])
                if not tight:
                    break
        return None if worst is None else worst[1:]

    def _may_be_tight(self, errand: Errand) -> bool:
        """Whether no way to grasp has room enough however near things may come."""
        if not self._near:
            return False
        boxes = [box for box, _ in self._at_rest]
        enough_m = np.array([MARGIN_M + strays_m for _, strays_m in self._at_rest])
        return not any(
            all(
                (self._around(grip, boxes, self._rest_outlines, enough_m.max()) >= enough_m).all()
                for grip in way
            )
            for way in self._ways(errand)
        )

    def _drawn(self, at: Pose, ways: Sequence[tuple[Grip, ...]]) -> tuple[float, Draw] | None:
        """What leaves least room, and how much that is for the way to grasp that has most."""
        rooms = np.full(len(ways), _PLENTY_M)
        part = replace(self._start, pose=at)
        body = [shapely.Polygon(box.corners()) for box in part.boxes]
        chosen: list[tuple[Standing, Sequence[shapely.Polygon]]] = []
        for each, left in zip(self._near, self._rooms(ways), strict=True):
            free = self._admissible(each, part, body, chosen)
            if not free.any():
                return None
            badness = np.minimum(rooms[:, None], left).clip(0.0).sum(axis=0)
            badness = badness + _PULL * self._away_m(each)
            best = int(np.where(free, badness, np.inf).argmin())
            rooms = np.minimum(rooms, left[:, best])
            chosen.append((each.standings[best], each.outlines[best].tolist()))
        around = [*(standing for standing, _ in chosen), *self._far]
        return float(rooms.max(initial=0.0)), Draw(at, around)

    def _away_m(self, options: Options) -> Rooms:
        """How far each option is from the nearer end of the way."""
        apart = np.linalg.norm(options.middles[:, None] - self._ends[None], axis=-1)
        return np.asarray(apart.min(axis=1))

    def _admissible(
        self,
        options: Options,
        part: Standing,
        body: Sequence[shapely.Polygon],
        chosen: Sequence[tuple[Standing, Sequence[shapely.Polygon]]],
    ) -> NDArray[np.bool_]:
        """Which options a world would not draw anew; what is at its place stays there."""
        first = options.at_rest
        free = np.ones(len(options.standings), bool)
        if len(free) == 1:
            return free
        if first.where not in self._below and _may_meet(options, part):
            free &= _apart(options, part, body)
        for other, outlines in chosen:
            scattered = other.where[0] == "objects" and _may_meet(options, other)
            if scattered and not _stacked(first, other):
                free &= _apart(options, other, outlines)
        return free

    def _ways(self, errand: Errand) -> Iterator[tuple[Grip, ...]]:
        """Where the fingers close and open, for each way to grasp."""
        seen = set()
        for situation in ways_to_grasp(errand, self._gripper, self._table_z, ()):
            yaw = None if situation.found is None else situation.found.yaw
            if (yaw, situation.grasp) not in seen:
                seen.add((yaw, situation.grasp))
                yield grips(errand.lay_out(situation), situation.grasp, self._gripper)

    def _rooms(self, ways: Sequence[tuple[Grip, ...]]) -> list[Rooms]:
        """The room (ways, options) that each thing near leaves."""
        if not ways:
            return [np.empty((0, len(each.standings))) for each in self._near]
        left = np.array(
            [np.minimum.reduce([self._left_by_all(grip) for grip in way]) for way in ways]
        )
        sizes = [each.outlines.size for each in self._near]
        parts = np.split(left, np.cumsum(sizes)[:-1], axis=1)
        return [
            part.reshape(len(ways), *each.outlines.shape).min(axis=2)
            for each, part in zip(self._near, parts, strict=True)
        ]

    def _left_by_all(self, grip: Grip) -> Rooms:
        """Places and what is let go there are the same for all cases."""
        if grip not in self._left:
            self._left[grip] = self._around(grip, self._boxes, self._outlines, _PLENTY_M)
        return self._left[grip]

    def _around(
        self, grip: Grip, boxes: Sequence[SeenBox], outlines: NDArray[np.object_], most_m: float
    ) -> Rooms:
        return rooms_around(
            self._gripper,
            grip.tool,
            grip.opening_m,
            boxes,
            outlines,
            closed_m=grip.closed_m,
            most_m=most_m,
        )


def _joined(some: Sequence[NDArray[np.object_]]) -> NDArray[np.object_]:
    return np.concatenate(some) if some else np.empty(0, object)


def _apart(
    options: Options, other: Standing, outlines: Sequence[shapely.Polygon]
) -> NDArray[np.bool_]:
    free = np.ones(len(options.standings), bool)
    for number, mine in enumerate(options.standings[0].boxes):
        for box, outline in zip(other.boxes, outlines, strict=True):
            over_m = max(mine.bottom_z - box.top_z, box.bottom_z - mine.top_z)
            if over_m < DRAWN_APART_M:
                apart_m = shapely.distance(options.outlines[:, number], outline)
                free &= apart_m >= DRAWN_APART_M
    return free


def _may_meet(options: Options, other: Standing) -> bool:
    """Whether anything may be too near to any of the options, by circles around them."""
    first = options.at_rest
    apart_m = math.hypot(first.pose.x - other.pose.x, first.pose.y - other.pose.y)
    near_m = _radius_m(first) + _radius_m(other) + DRAWN_APART_M
    return apart_m < near_m + options.strays_m


def _radius_m(standing: Standing) -> float:
    return math.hypot(*standing.part.size[:2]) / 2


def _stacked(one: Standing, other: Standing) -> bool:
    return bool(beneath(one, [other]) or beneath(other, [one]))
