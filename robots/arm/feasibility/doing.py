"""Whether the arm can do a leaf amid what stands around: take its object and bring it there."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import product

from mend.robots.arm.behaviors.behavior import Situation, Step
from mend.robots.arm.behaviors.errand import Errand
from mend.robots.arm.behaviors.grasp_choice import Crowding, room_for
from mend.robots.arm.behaviors.pick_and_place import PickAndPlace, PickAndPlaceParameters, lifting
from mend.robots.arm.behaviors.plan import carries
from mend.robots.arm.behaviors.planning import (
    AS_SEEN,
    Barred,
    Planner,
    Spare,
    at_once,
    bar_of,
    plan_amid,
)
from mend.robots.arm.clearance import ROOM_M
from mend.robots.arm.feasibility.scattering import Options, Surroundings, options_of, turns_of
from mend.robots.arm.feasibility.standing import Standing, beneath
from mend.robots.arm.feasibility.strewn import strewn_part
from mend.robots.link.messages import Location
from mend.robots.vision.seen_box import SeenBox
from mend.tasks.scene import Pose, Scatter, Table
from mend.tasks.scene_problem import SceneProblem

_SEEN_M = 0.0015
"""A part may be seen so far away from where it is."""
_SIDES = (-1.0, 1.0)
_STEP_M, _STEPS = 0.002, 100
_TRIES = 30
"""So many steps more than what is measured are tried by planning."""


@dataclass(frozen=True, slots=True)
class Hindrance:
    """Why a part cannot be taken from `start` to `place` amid `around`, wherever it is seen."""

    start: Standing
    place: Standing | None
    around: Sequence[Standing]
    drawn: Sequence[Standing]
    errand: Errand
    barred: Barred

    @property
    def names(self) -> set[str | None]:
        """What is too near, or would be touched."""
        boxes = [
            each.by if isinstance(each, Crowding) else each.touched for each in self.barred.refusals
        ]
        return {box.name for box in boxes if box is not None}


@dataclass(frozen=True, slots=True)
class _Case:
    """An errand amid what stands there then; `exact` is the same with the part seen where it is."""

    errand: Errand
    drawn: Sequence[Standing]
    spare: Spare = AS_SEEN
    exact: Errand | None = None


@dataclass(frozen=True, slots=True)
class ArmCheck:
    """The arm of the robot that is to do it."""

    planner: Planner
    scatter: Scatter
    table: Table
    _known: dict[tuple[object, ...], Options] = field(default_factory=dict, compare=False)

    def hindrance(
        self, start: Standing, place: Standing | None, around: Sequence[Standing]
    ) -> Hindrance | None:
        """What keeps the arm from taking a part from `start` to `place`; None if nothing does.

        Without a place it is only to be lifted.
        """
        for case in self._cases(start, place, around):
            found = self._tried(case)
            if found is None:
                continue
            if isinstance(found.reason, Crowding) and case.exact is not None:
                # The fingers have room by what is so: that is only seen otherwise now and then.
                case = replace(case, errand=case.exact, exact=None)
                found = self._tried(case)
            if found is not None:
                return Hindrance(start, place, around, case.drawn, case.errand, found)
        return None

    def _tried(self, case: "_Case") -> Barred | None:
        boxes = _boxes(case.drawn)
        found = at_once(plan_amid(case.errand, self.planner, self.table, boxes, case.spare))
        return found if isinstance(found, Barred) else None

    def told(self, hindrance: Hindrance, moved: set[str]) -> SceneProblem:
        """The hindrance in a sentence; `moved` are the parts that leaves take away."""
        reason = hindrance.barred.reason
        strewn = strewn_part(
            hindrance.start,
            self.scatter,
            lambda scatter: replace(self, scatter=scatter).possible(hindrance),
        )
        if strewn is not None:
            return strewn
        if isinstance(reason, Crowding):
            return self._tight(hindrance)
        bar = self._bar(hindrance)
        if bar is not None:
            return self._in_the_way(hindrance, bar, moved)
        if reason.touched is not None:
            return self._touching(hindrance, reason.touched)
        return self._out_of_reach(hindrance)

    def possible(self, hindrance: Hindrance) -> bool:
        """Whether the same part could be taken there amid the same things."""
        return self.hindrance(hindrance.start, hindrance.place, hindrance.around) is None

    def _cases(
        self, start: Standing, place: Standing | None, around: Sequence[Standing]
    ) -> Iterator["_Case"]:
        """Where a start may be seen, what stands around it then, and what room the fingers need.

        Where it is, with room to spare; and nearer and farther away, or at the corners of what it
        is scattered over, amid what is scattered as well.
        """
        bottom_z = _rest_z(start, around)

        def errand_at(pose: Pose, dx: float, dy: float) -> Errand:
            seen = pose.model_copy(update={"x": pose.x + dx, "y": pose.y + dy})
            return _errand(start, seen, bottom_z, place, around)

        pose, scatter = start.pose, self.scatter
        yield _Case(errand_at(pose, 0.0, 0.0), around, Spare(ROOM_M))
        away_m = max(math.hypot(pose.x, pose.y), _SEEN_M)
        shares = (-_SEEN_M / away_m, _SEEN_M / away_m)
        if scatter == Scatter():
            for share in shares:
                yield _Case(errand_at(pose, share * pose.x, share * pose.y), around)
            return
        options = [self._options_of(each) for each in around]
        amid = Surroundings(start, place, options, self.planner.gripper, self.table.height)
        turns = turns_of(scatter)
        for number, (x, y) in enumerate(product(_SIDES, _SIDES)):
            moved = {"x": pose.x + x * scatter.xy, "y": pose.y + y * scatter.xy}
            corner = [
                pose.model_copy(update={**moved, "yaw": pose.yaw + turn})
                for turn in (turns if number % 2 else turns[::-1])
            ]
            worst = amid.worst([(errand_at(at, 0.0, 0.0), at) for at in corner])
            if worst is not None:
                exact, draw = worst
                seen = errand_at(draw.at, x * _SEEN_M, y * _SEEN_M)
                yield _Case(seen, draw.around, exact=exact)

    def _options_of(self, standing: Standing) -> Options:
        pose = standing.pose
        key = (standing.where, pose.x, pose.y, pose.yaw, self.scatter.xy, self.scatter.yaw)
        if key not in self._known:
            self._known[key] = options_of(standing, self.scatter)
        return self._known[key]

    def _tight(self, hindrance: Hindrance) -> SceneProblem:
        """What lacks least is what is easiest to mend."""
        crowded = [each for each in hindrance.barred.refusals if isinstance(each, Crowding)]
        lacking_m, least = min(
            ((self._lacking_m(each), each) for each in crowded), key=lambda pair: pair[0]
        )
        name, neighbour = hindrance.start.name, _spoken_of(least.by, hindrance.drawn)
        enough_m = self._enough_m(hindrance, least, lacking_m)
        apart = (
            "move one of them"
            if enough_m is None
            else f"put them at least {1e3 * enough_m:.0f} mm further apart"
        )
        if least.at_place and hindrance.place is not None:
            return SceneProblem(
                hindrance.place.where,
                f"{neighbour} is too close to the place of {name} for the fingers to let {name} go "
                f"there: {apart}",
            )
        return SceneProblem(
            hindrance.start.where,
            f"{neighbour} is too close to {name} for the fingers to grasp {name}: {apart}",
        )

    def _enough_m(self, hindrance: Hindrance, crowding: Crowding, lacking_m: float) -> float | None:
        """How much further away the neighbour is in nobody's way; None if none of it is enough.

        It moves straight away from the part; what only others hinder then is told of them.
        """
        end = hindrance.start
        if crowding.at_place and hindrance.place is not None:
            end = hindrance.place
        number = next(n for n, each in enumerate(hindrance.drawn) if crowding.by in each.boxes)
        where = hindrance.drawn[number].where
        near = next(each for each in hindrance.around if each.where == where)
        dx, dy = near.pose.x - end.pose.x, near.pose.y - end.pose.y
        away_m = math.hypot(dx, dy)
        if away_m == 0.0:
            return None
        for step in range(_TRIES):
            shift_m = lacking_m + step * _STEP_M
            pose = near.pose.model_copy(
                update={
                    "x": near.pose.x + dx / away_m * shift_m,
                    "y": near.pose.y + dy / away_m * shift_m,
                }
            )
            moved = replace(near, pose=pose)
            around = [moved if each is near else each for each in hindrance.around]
            found = self.hindrance(hindrance.start, hindrance.place, around)
            if found is None or near.name not in found.names:
                return shift_m
        return None

    def _lacking_m(self, crowding: Crowding) -> float:
        """How much further away from the part its neighbour would leave room."""
        near, tool = crowding.by, crowding.grip.tool
        gripper, spare = self.planner.gripper, Spare(ROOM_M)
        dx, dy = near.x - tool.x, near.y - tool.y
        away_m = math.hypot(dx, dy)
        cos, sin = (dx / away_m, dy / away_m) if away_m > 0.0 else (1.0, 0.0)
        for step in range(1, _STEPS):
            shift_m = step * _STEP_M
            moved = replace(near, x=near.x + cos * shift_m, y=near.y + sin * shift_m)
            room = room_for(crowding.grip, gripper, [moved], spare.stray_m)
            if room is None or room.room_m >= spare.least_m:
                return shift_m
        return _STEPS * _STEP_M

    def _bar(self, hindrance: Hindrance) -> Standing | None:
        """What could stand elsewhere so that there would be a way."""
        errand = hindrance.errand
        bar = at_once(
            bar_of(
                hindrance.barred,
                _boxes(hindrance.drawn),
                lambda boxes: plan_amid(errand, self.planner, self.table, boxes),
                lambda box: carries(box, errand, self.table.height),
            )
        )
        return None if bar is None else next(e for e in hindrance.drawn if bar in e.boxes)

    def _in_the_way(self, hindrance: Hindrance, bar: Standing, moved: set[str]) -> SceneProblem:
        end = self._barred_end(hindrance)
        name = hindrance.start.name
        to = name if end is hindrance.start else f"the place of {name}"
        mend = "move one of them"
        if bar.where[0] == "places":
            mend += f", or let {name} be placed before {bar.name}"
        elif bar.name in moved:
            mend += f", or let {bar.name} be placed before {name}"
        verb = "would stand" if bar.where[0] == "places" else "stands"
        return SceneProblem(end.where, f"{bar.name} {verb} in the arm's way to {to}: {mend}")

    def _touching(self, hindrance: Hindrance, touched: SeenBox) -> SceneProblem:
        end = self._barred_end(hindrance)
        name = hindrance.start.name
        to = name if end is hindrance.start else f"the place of {name}"
        return SceneProblem(
            end.where, f"the arm would touch {touched.name} on its way to {to}: move one of them"
        )

    def _barred_end(self, hindrance: Hindrance) -> Standing:
        """The start if the arm cannot even lift the part there, else the place."""
        start, place = hindrance.start, hindrance.place
        if place is None or self.hindrance(start, None, hindrance.around) is not None:
            return start
        return place

    def _out_of_reach(self, hindrance: Hindrance) -> SceneProblem:
        """Whether the start, the place or only the way between them cannot be reached."""
        start, place = hindrance.start, hindrance.place
        if place is None or self.hindrance(start, None, ()) is not None:
            return SceneProblem(start.where, _too_far(start.name, start, "starts"))
        if self.hindrance(place, None, ()) is not None:
            return SceneProblem(place.where, _too_far(start.name, place, "is to go"))
        return SceneProblem(
            place.where,
            f"the arm reaches where {start.name} starts and where it is to go, but not both with "
            "one grasp: turn or move one of them",
        )


def _too_far(name: str, standing: Standing, verb: str) -> str:
    pose = standing.pose
    return (
        f"the arm does not reach ({pose.x:.3f}, {pose.y:.3f}, {standing.bottom_z:.3f}), where "
        f"{name} {verb}, with the gripper pointing down"
    )


def _spoken_of(box: SeenBox, around: Sequence[Standing]) -> str:
    """A part where it stands, or the place where it is to be by then."""
    standing = next((each for each in around if box in each.boxes), None)
    if standing is not None and standing.where[0] == "places":
        return f"the place of {standing.name}"
    return str(box.name)


def _boxes(around: Sequence[Standing]) -> list[SeenBox]:
    return [box for each in around for box in each.boxes]


def _rest_z(standing: Standing, others: Sequence[Standing]) -> float:
    """On top of what carries it, where the height that is given for it is hardly lower."""
    return max([standing.bottom_z, *(each.deck_z for each in beneath(standing, others))])


def _errand(
    start: Standing,
    at: Pose,
    bottom_z: float,
    place: Standing | None,
    around: Sequence[Standing],
) -> Errand:
    """What `PickAndPlace` is to do with a part that is seen at a pose; without a place, lift it."""
    found = Location(x=at.x, y=at.y, z=bottom_z, yaw=at.yaw)
    if place is None:
        return Errand(lifting, start.part, found, None)
    goal = place.pose
    target = Location(x=goal.x, y=goal.y, z=_rest_z(place, around), yaw=goal.yaw)
    parameters = PickAndPlaceParameters(object=start.name, place=start.name)

    def lay_out(situation: Situation) -> Sequence[Step]:
        return PickAndPlace().steps(parameters, situation)

    return Errand(lay_out, start.part, found, target)
