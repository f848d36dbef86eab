"""Whether the arm can do a leaf: grasp its object, bring it to its place, and let it go there."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import product

from robots.behaviors.behavior import Situation, Step
from robots.behaviors.grasp_choice import LIFTS_M, clear_z
from robots.behaviors.legs import legs_of, table_box
from robots.behaviors.pick_and_place import PickAndPlace, PickAndPlaceParameters
from robots.body import Leg, NoWay, ToolPose
from robots.clearance import ROOM_M, in_the_way
from robots.feasibility.standing import Standing, beneath
from robots.grasp import Grasp, grasps_of
from robots.gripper import GripperModel
from robots.link.messages import Location
from robots.vision.seen_box import SeenBox
from tasks.scene import Pose, Scatter, Table
from tasks.scene_problem import SceneProblem

FindNoWay = Callable[[Sequence[Leg], Sequence[SeenBox]], NoWay | None]
"""Why the arm cannot go from neutral through all legs amid boxes, by the planner that it uses; None
where it can."""

_SEEN_M = 0.0015
"""A part may be seen so far away from where it is."""
_SIDES = (-1.0, 1.0)
_STEP_M, _STEPS = 0.002, 100


@dataclass(frozen=True, slots=True)
class Surroundings:
    """What stands around a part when it is grasped, and when it is let go."""

    start: Sequence[Standing]
    place: Sequence[Standing]


@dataclass(frozen=True, slots=True)
class _Tight:
    """A neighbour is `lacking_m` too close to a part, where it starts or where it is to go."""

    standing: Standing
    neighbour: str
    lacking_m: float
    at_start: bool

    @property
    def told(self) -> SceneProblem:
        name, apart = self.standing.name, f"put them {1e3 * self.lacking_m:.0f} mm further apart"
        if self.at_start:
            message = (
                f"{self.neighbour} stands too close to {name} for the fingers to grasp that: "
                f"{apart}"
            )
        else:
            message = (
                f"{self.neighbour} is too close to the place of {name} for the fingers to let it "
                f"go there: {apart}"
            )
        return SceneProblem(self.standing.where, message)


@dataclass(frozen=True, slots=True)
class ArmCheck:
    """The gripper and the reach of the robot that is to do it."""

    gripper: GripperModel
    no_way: FindNoWay
    scatter: Scatter
    table: Table

    def cannot_do(
        self, start: Standing, place: Standing | None, around: Surroundings
    ) -> SceneProblem | None:
        """Why the arm cannot take a part from `start` to `place`; None where it can."""
        grasps = grasps_of(start.part, self.gripper)
        tight = {grasp: self._tight(start, place, grasp, around) for grasp in grasps}
        roomy = [grasp for grasp, problem in tight.items() if problem is None]
        if not roomy:
            # What lacks least is what is easiest to mend.
            lacking = [problem for problem in tight.values() if problem is not None]
            return min(lacking, key=lambda each: each.lacking_m).told
        if any(self._reaches(start, place, grasp, around) for grasp in roomy):
            return self._barred(start, place, roomy, around)
        return self._out_of_reach(start, place, roomy, around)

    def _tight(
        self, start: Standing, place: Standing | None, grasp: Grasp, around: Surroundings
    ) -> "_Tight | None":
        """What leaves too little room for the fingers; None where there is enough."""
        sites = [(start, around.start, self.scatter.xy)]
        if place is not None:
            sites.append((place, around.place, 0.0))
        for standing, others, more_m in sites:
            tool = _tool(_at_rest(standing, others), standing.pose, grasp)
            near = self._near(tool, grasp, others, more_m)
            if near is not None:
                lacking_m = self._lacking_m(tool, grasp, near, more_m)
                return _Tight(standing, near.name or "something", lacking_m, standing is start)
        return None

    def _lacking_m(self, tool: ToolPose, grasp: Grasp, near: SeenBox, more_m: float) -> float:
        """How much further away from the part its neighbour would leave room."""
        dx, dy = near.x - tool.x, near.y - tool.y
        away_m = math.hypot(dx, dy)
        cos, sin = (dx / away_m, dy / away_m) if away_m > 0.0 else (1.0, 0.0)
        for step in range(1, _STEPS):
            shift_m = step * _STEP_M
            moved = replace(near, x=near.x + cos * shift_m, y=near.y + sin * shift_m)
            if self._in_the_way(tool, grasp, [moved], more_m) is None:
                return shift_m
        return _STEPS * _STEP_M

    def _near(
        self, tool: ToolPose, grasp: Grasp, others: Sequence[Standing], more_m: float
    ) -> SeenBox | None:
        boxes = [box for each in others for box in each.boxes]
        return self._in_the_way(tool, grasp, boxes, more_m)

    def _in_the_way(
        self, tool: ToolPose, grasp: Grasp, boxes: Sequence[SeenBox], more_m: float
    ) -> SeenBox | None:
        """What comes too near to the fingers while they close or open; `more_m` nearer at worst."""
        return in_the_way(
            self.gripper,
            tool,
            grasp.opening_m,
            boxes,
            ROOM_M,
            closed_m=grasp.width_m,
            stray_m=more_m,
        )

    def _reaches(
        self, start: Standing, place: Standing | None, grasp: Grasp, around: Surroundings
    ) -> bool:
        """Whether wherever the world may scatter the start to, some lift is within reach."""
        return all(
            any(
                self.no_way(self._legs(start, at, place, grasp, lift_m, around), ()) is None
                for lift_m in LIFTS_M
            )
            for at in self._scattered(start.pose)
        )

    def _scattered(self, pose: Pose) -> list[Pose]:
        """Where a start may come to be, or to be seen: the corners, or nearer and farther away."""
        shift_m = self.scatter.xy
        if shift_m == 0.0:
            away_m = max(math.hypot(pose.x, pose.y), _SEEN_M)
            shifts = [(pose.x * far, pose.y * far) for far in (-_SEEN_M / away_m, _SEEN_M / away_m)]
        else:
            off_m = shift_m + _SEEN_M
            shifts = [(dx * off_m, dy * off_m) for dx, dy in product(_SIDES, _SIDES)]
        return [pose.model_copy(update={"x": pose.x + dx, "y": pose.y + dy}) for dx, dy in shifts]

    def _barred(
        self,
        start: Standing,
        place: Standing | None,
        grasps: Sequence[Grasp],
        around: Surroundings,
    ) -> SceneProblem | None:
        """What the arm would touch on every way that it could take otherwise; None if nothing.

        What is to stand where the part itself starts or goes cannot stand there by then.
        """
        ends = [each for each in (start, place) if each is not None]
        standing = [
            each
            for each in dict.fromkeys([*around.start, *around.place])
            if not any(each.meets(end) for end in ends)
        ]
        boxes = [table_box(self.table), *(box for each in standing for box in each.boxes)]
        touched: SeenBox | None = None
        for over, grasp, lift_m in product((True, False), grasps, LIFTS_M):
            legs = self._legs(start, start.pose, place, grasp, lift_m, around, over=over)
            barred = self.no_way(legs, boxes)
            if barred is None:
                return None
            touched = touched or barred.touched
        if touched is None or touched.name is None:
            return None
        return SceneProblem(
            start.where,
            f"with {start.name} the arm would touch {touched.name} on its way: move one of them, "
            f"or let {touched.name} be taken away before",
        )

    def _legs(
        self,
        start: Standing,
        at: Pose,
        place: Standing | None,
        grasp: Grasp,
        lift_m: float,
        around: Surroundings,
        *,
        over: bool = True,
    ) -> list[Leg]:
        """The way of the tool point, as the behavior lays it out, `over` all that stands there."""
        steps = self._steps(start, at, place, grasp, lift_m, around, over=over)
        return legs_of(steps, start.part, grasp, self.gripper, carrying=False)

    def _steps(
        self,
        start: Standing,
        at: Pose,
        place: Standing | None,
        grasp: Grasp,
        lift_m: float,
        around: Surroundings,
        *,
        over: bool,
    ) -> Sequence[Step]:
        found = Location(x=at.x, y=at.y, z=start.bottom_z, yaw=at.yaw)
        target = found
        if place is not None:
            pose = place.pose
            target = Location(x=pose.x, y=pose.y, z=place.bottom_z, yaw=pose.yaw)
        boxes = [box for each in (*around.start, *around.place) for box in each.boxes]
        situation = Situation(
            start.part,
            found,
            target,
            self.table.height,
            self.gripper,
            grasp,
            clear_z(found, target, self.table.height, boxes) if over else self.table.height,
            lift_m,
        )
        parameters = PickAndPlaceParameters(object=start.name, place=start.name)
        return PickAndPlace().steps(parameters, situation)

    def _out_of_reach(
        self,
        start: Standing,
        place: Standing | None,
        grasps: Sequence[Grasp],
        around: Surroundings,
    ) -> SceneProblem:
        """Whether the start, the place or only the way between them cannot be reached."""
        if not any(self._reaches(start, None, grasp, around) for grasp in grasps):
            return SceneProblem(start.where, self._too_far(start.name, start, "starts"))
        assert place is not None
        if not any(self._reaches(place, None, grasp, around) for grasp in grasps):
            return SceneProblem(place.where, self._too_far(start.name, place, "is to go"))
        return SceneProblem(
            place.where,
            f"the arm reaches where {start.name} starts and where it is to go, but not both with "
            "one grasp: turn or move one of them",
        )

    def _too_far(self, name: str, standing: Standing, verb: str) -> str:
        pose = standing.pose
        return (
            f"the arm does not reach ({pose.x:.3f}, {pose.y:.3f}, {standing.bottom_z:.3f}), where "
            f"{name} {verb}, with the gripper pointing down"
        )


def _at_rest(standing: Standing, others: Sequence[Standing]) -> Standing:
    """On top of what carries it, where the height that is given for it is hardly lower."""
    tops = [each.deck_z for each in beneath(standing, others)]
    return replace(standing, bottom_z=max([standing.bottom_z, *tops]))


def _tool(standing: Standing, pose: Pose, grasp: Grasp) -> ToolPose:
    return grasp.tool_pose(pose.x, pose.y, standing.bottom_z, pose.yaw)
