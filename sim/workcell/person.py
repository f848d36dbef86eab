"""The person beside the table: carries out interventions, some over many cycles."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mend.robots.arm.grasp import can_grasp, grasp_of
from mend.robots.catalogue import Part as CataloguePart
from mend.sim.acts import PULL_M_PER_S, Acts, Impossible
from mend.sim.workcell.bench import Bench
from mend.sim.workcell.body import WorkcellBody
from mend.sim.workcell.clock import PERIOD_S, Clock
from mend.sim.workcell.gripper import PR2_GRIPPER
from mend.sim.workcell.hand import HOLD_FORCE_N, PULL_FORCE_N, Hand
from mend.sim.workcell.obstacle import (
    Obstacle,
    center_above,
    centers_ahead,
    centers_below,
    sinks,
)
from mend.sim.workcell.parts import PartPose, RigidPart
from mend.sim.workcell.physics import LEAST_DISTANCE_M, Client, Point
from mend.tasks.footprint import Footprint
from mend.tasks.scene import Pose

PULLED_OUT_M = 0.5
_CLEAR_M = 0.15
"""So far a part is pulled out from between the fingers, or lifted off the table, before it turns
up or sideways."""

_GRIPPED_CYCLES = 24
"""So long both fingers press on a part before the person trusts the grip."""

_LEVEL = 0.3
_UPRIGHT_RAD = 0.2
_DROP_M = 0.001
_DEFAULT_TOOL_HEIGHT_M = 0.20
"""Above the table: where the tool passes on most ways."""


Direction = NDArray[np.float64]
_UP: Direction = np.array([0.0, 0.0, 1.0])


@dataclass(slots=True)
class _Pull:
    """A part on its way out of the robot's reach, `first` one way and `then` another."""

    hand: Hand
    first: Direction
    then: Direction
    pulled_m: float = 0.0

    def go_on(self, way_m: float) -> None:
        self.pulled_m += way_m
        clear_m = min(self.pulled_m, _CLEAR_M)
        x, y, z = self.first * clear_m + self.then * (self.pulled_m - clear_m)
        self.hand.move_by((float(x), float(y), float(z)))


@dataclass(slots=True)
class WorkcellHandOver:
    """A part that somebody holds out, or waits to, until the clock reads `until_s`.

    While it is in the `hand`, it is held out to `taker`.
    """

    part: RigidPart
    until_s: float
    hand: Hand | None = None
    taker: WorkcellBody | None = None
    gripped_cycles: int = 0


class WorkcellPerson(Acts[RigidPart, PartPose]):
    """Everybody who is not the robot."""

    def __init__(
        self, client: Client, bench: Bench, clock: Clock, bodies: Sequence[WorkcellBody]
    ) -> None:
        super().__init__(bench.scene, bench.parts)
        self._client = client
        self._bench = bench
        self._clock = clock
        self._bodies = bodies
        self._pulls: list[_Pull] = []
        self.hand_over: WorkcellHandOver | None = None
        self.obstacle = Obstacle(client)

    def act(self) -> None:
        """Go on with what takes longer than one cycle."""
        for pull in tuple(self._pulls):
            self._go_on_pulling(pull)
        if self.hand_over is not None:
            self._go_on_handing_over(self.hand_over)

    def has_in_hand(self, part: RigidPart) -> bool:
        """Whether somebody is just pulling a part away or handing it over."""
        handed = self.hand_over is not None and self.hand_over.part is part
        return handed or self.is_pulling(part)

    def is_pulling(self, part: RigidPart) -> bool:
        return any(pull.hand.part is part for pull in self._pulls)

    def withdraw(self) -> None:
        """Stop everything that is under way (a rebuilt world)."""
        for pull in self._pulls:
            pull.hand.let_go()
        self._pulls.clear()
        if self.hand_over is not None:
            self._end_hand_over(self.hand_over)
        self.obstacle.withdraw()

    def hold_out(self, part: RigidPart, until_s: float) -> None:
        """Hold a part between the robot's fingers once they are open and at rest.

        Raises `Impossible` for a part that they do not fit.
        """
        if not can_grasp(_as_catalogued(part), PR2_GRIPPER):
            raise Impossible(f"'{part.name}' does not fit between the robot's fingers")
        part.hide()
        self.hand_over = WorkcellHandOver(part, until_s)

    # --- What a workcell adds -----------------------------------------------------------------

    def _now_s(self) -> float:
        return self._clock.time_s()

    def _is_gone(self, part: RigidPart) -> bool:
        return part.stolen or self.is_pulling(part)

    def _is_held(self, part: RigidPart) -> bool:
        return self._holder_of(part) is not None

    def _offered(self) -> RigidPart | None:
        return None if self.hand_over is None else self.hand_over.part

    def _stands_in_the_way(self) -> bool:
        return self.obstacle.center is not None

    def _stand_in_the_way(self) -> None:
        parts = [part.body_id for part in self._bench.parts.values()]
        arms = [body.pr2.body_id for body in self._bodies]
        for center in self._spots_in_the_way():
            self.obstacle.stand_at(center)
            if self.obstacle.is_clear_of(arms, parts):
                return
        self.obstacle.withdraw()
        raise Impossible("there is no room to stand in the arm's way")

    def _spots_in_the_way(self) -> Iterator[Point]:
        """Where an arm will meet somebody, the soonest first: on its task, or going home."""
        body = self._under_way()
        pr2, base = body.pr2, body.pr2.base
        *task, home = body.ways_ahead()
        tool = pr2.tool_in_scene()
        yield from centers_ahead(base, pr2.tool, task)
        if sinks(pr2.tool, tool, task):
            x, y, z = (float(each) for each in (base @ pr2.forearm_camera_pose())[:3, 3])
            yield from centers_below(pr2.wrist(tool), (x, y, z))
        yield from centers_ahead(base, pr2.tool, [home])
        yield self._between_starts_and_places()

    def _step_aside(self) -> None:
        self.obstacle.withdraw()

    def _take_away(self, part: RigidPart, *, by_force: bool) -> None:
        out_of_sight = self._is_waiting_to_hand_over(part)
        self._take(part)
        if out_of_sight or not by_force:
            part.take_away()
            return
        hand = Hand.take_hold(self._client, part, PULL_FORCE_N)
        holder = self._holder_of(part)
        sideways = self._way_out(part, holder or self._bodies[0])
        if holder is not None:
            self._pulls.append(_Pull(hand, first=sideways, then=_UP))
        else:
            self._pulls.append(_Pull(hand, first=_UP, then=sideways))

    def _start_of(self, part: RigidPart) -> PartPose:
        return part.start

    def _pose_at(self, pose: Pose) -> PartPose:
        return PartPose.at(pose, self._bench.scene.table.height)

    def _footprint(self, part: RigidPart) -> Footprint | None:
        if part.stolen or self.has_in_hand(part) or self._is_held(part):
            return None
        pose, size = part.pose(), part.definition.size
        x, y, _ = pose.position
        if pose.tilt_rad > _UPRIGHT_RAD:
            # Whichever side it lies on, it covers no more than this.
            return Footprint(x, y, 0.0, max(size), max(size))
        return Footprint(x, y, pose.yaw, size[0], size[1])

    def _top_z(self, part: RigidPart) -> float:
        _, high = self._client.getAABB(part.body_id)
        return float(high[2])

    # --- How ----------------------------------------------------------------------------------

    def _is_waiting_to_hand_over(self, part: RigidPart) -> bool:
        hand_over = self.hand_over
        return hand_over is not None and hand_over.part is part and hand_over.hand is None

    def _take(self, part: RigidPart) -> None:
        """Let go of a part with whichever hand holds it."""
        for pull in [pull for pull in self._pulls if pull.hand.part is part]:
            pull.hand.let_go()
            self._pulls.remove(pull)
        if self.hand_over is not None and self.hand_over.part is part:
            self._end_hand_over(self.hand_over)

    def _put(self, part: RigidPart, at: PartPose, where: str) -> None:
        """Put a part down, out of the robot's fingers if need be, unless something is there."""
        before, was_stolen = part.pose(), part.stolen
        x, y, z = at.position
        part.put(PartPose((x, y, z + _DROP_M), at.quaternion))
        problem = self._conflict(part)
        if problem is None:
            self._take(part)
            return
        part.put(before)
        part.stolen = was_stolen
        raise Impossible(f"{problem} is {where}, so '{part.name}' cannot be put there")

    def _conflict(self, part: RigidPart) -> str | None:
        other = next(self._bench.intersecting(part), None)
        if other is not None:
            return f"'{other.name}'"
        near = self._client.getClosestPoints
        arms = (body.pr2.body_id for body in self._bodies)
        if any(near(part.body_id, arm, LEAST_DISTANCE_M) for arm in arms):
            return "the robot's arm"
        return None

    def _holder_of(self, part: RigidPart) -> WorkcellBody | None:
        """Whose fingers hold a part."""
        held = (body for body in self._bodies if self._bench.held(body.pr2) is part)
        return next(held, None)

    def _under_way(self) -> WorkcellBody:
        """Whoever carries something, else whoever moves."""
        if len(self._bodies) == 1:
            return self._bodies[0]
        held = [self._bench.held(body.pr2) is not None for body in self._bodies]
        pairs = zip(held, self._bodies, strict=True)
        return max(pairs, key=lambda pair: (pair[0], pair[1].moving))[1]

    def _way_out(self, part: RigidPart, body: WorkcellBody) -> Direction:
        """Level, along the fingers' sides, away from the other parts."""
        tool = body.pr2.tool_in_scene()
        level = np.array([tool[0, 2], tool[1, 2], 0.0])
        if np.linalg.norm(level) < _LEVEL:
            level = np.array([0.0, -1.0, 0.0])
        level /= np.linalg.norm(level)
        others = [
            other.pose().position
            for other in self._bench.parts.values()
            if other is not part and not other.stolen
        ]
        here = np.array(part.pose().position)
        towards = np.mean(others, axis=0) - here if others else np.zeros(3)
        return np.asarray(-level if np.dot(level, towards) > 0.0 else level)

    def _between_starts_and_places(self) -> Point:
        scene = self._bench.scene
        poses = [
            [each.pose for each in scene.objects.values()],
            [each.pose for each in scene.places.values()],
        ]
        middles = [
            np.mean([(pose.x, pose.y) for pose in group], axis=0) for group in poses if group
        ]
        x, y = np.mean(middles, axis=0) if middles else scene.table.center
        return center_above(float(x), float(y), scene.table.height + _DEFAULT_TOOL_HEIGHT_M)

    # --- What goes on over cycles -------------------------------------------------------------

    def _go_on_pulling(self, pull: _Pull) -> None:
        pull.go_on(PULL_M_PER_S * PERIOD_S)
        if pull.pulled_m >= PULLED_OUT_M:
            self._pulls.remove(pull)
            pull.hand.let_go()
            pull.hand.part.take_away()

    def _go_on_handing_over(self, hand_over: WorkcellHandOver) -> None:
        part, hand, taker = hand_over.part, hand_over.hand, hand_over.taker
        if self._clock.time_s() >= hand_over.until_s:
            self._end_hand_over(hand_over)
            part.put(part.last_rest)
        elif hand is None or taker is None:
            self._hold_between_fingers(hand_over)
        elif taker.moving and not taker.gripper_closing:
            # The robot turned away: try again when it is back.
            hand.let_go()
            hand_over.hand = hand_over.taker = None
            part.hide()
        else:
            self._feel_grip(hand_over, taker)

    def _hold_between_fingers(self, hand_over: WorkcellHandOver) -> None:
        """Of several robots, between those of the one that stretches its arm out for it."""
        bodies = self._bodies
        if len(bodies) > 1:
            bodies = [each for each in bodies if each.stretched_out]
        taker = next((each for each in bodies if each.ready_to_take), None)
        if taker is not None:
            hand_over.part.put(_pose_between_fingers(hand_over.part, taker))
            hand_over.hand = Hand.take_hold(self._client, hand_over.part, HOLD_FORCE_N)
            hand_over.taker = taker

    def _feel_grip(self, hand_over: WorkcellHandOver, taker: WorkcellBody) -> None:
        gripped = all(taker.pr2.touched_by(hand_over.part.body_id))
        hand_over.gripped_cycles = hand_over.gripped_cycles + 1 if gripped else 0
        if hand_over.gripped_cycles >= _GRIPPED_CYCLES:
            self._end_hand_over(hand_over)

    def _end_hand_over(self, hand_over: WorkcellHandOver) -> None:
        if hand_over.hand is not None:
            hand_over.hand.let_go()
        self.hand_over = None


def _pose_between_fingers(part: RigidPart, taker: WorkcellBody) -> PartPose:
    """Upright, with its thin sides to the fingers, grasped where the robot would."""
    grasp = grasp_of(_as_catalogued(part), taker.gripper)
    tool = taker.pr2.tool_in_scene()
    x, y, z = (float(value) for value in tool[:3, 3])
    yaw = math.atan2(tool[1, 1], tool[0, 1]) - grasp.yaw
    return PartPose.upright(x, y, z - grasp.height_m, yaw)


def _as_catalogued(part: RigidPart) -> CataloguePart:
    """As the robot knows the part."""
    return CataloguePart(part.name, part.definition.size, part.definition.knob)
