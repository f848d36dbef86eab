"""The person beside the table: carries out interventions, some over many cycles."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robots.catalogue import Part as CataloguePart
from robots.grasp import grasp_of
from sim.workcell.bench import Bench
from sim.workcell.body import PERIOD_S, WorkcellBody
from sim.workcell.hand import HOLD_FORCE_N, PULL_FORCE_N, Hand
from sim.workcell.obstacle import Obstacle, center_above, centers_ahead
from sim.workcell.parts import Part, PartPose
from sim.workcell.physics import Client, Point
from sim.workcell.pr2 import Pr2
from tasks.intervention import Act, Intervention

PULL_M_S = 0.4
PULLED_OUT_M = 0.5
_CLEAR_M = 0.15
"""So far a part is pulled out from between the fingers, or lifted off the table, before it turns
up or sideways."""

HAND_OVER_S = 15.0
"""How long somebody holds a part out to the robot."""

_GRIPPED_CYCLES = 24
"""So long both fingers press on a part before the person trusts the grip."""

_LEVEL = 0.3
_DROP_M = 0.001
_DEFAULT_TOOL_HEIGHT_M = 0.20
"""Above the table: where the tool passes on most ways."""


Direction = NDArray[np.float64]
_UP: Direction = np.array([0.0, 0.0, 1.0])


class _Impossible(Exception):  # noqa: N818 - an answer to the one who asked, not a failure
    """An intervention cannot be carried out; the message says why."""


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
class HandOver:
    """A part that somebody holds out, or waits to, until the clock reads `until_s`."""

    part: Part
    until_s: float
    hand: Hand | None = None
    gripped_cycles: int = 0


class Person:
    """Everybody who is not the robot."""

    def __init__(self, client: Client, bench: Bench, pr2: Pr2, body: WorkcellBody) -> None:
        self._client = client
        self._bench = bench
        self._pr2 = pr2
        self._body = body
        self._pulls: list[_Pull] = []
        self.hand_over: HandOver | None = None
        self.obstacle = Obstacle(client)
        self._acts: dict[Act, Callable[[Intervention], None]] = {
            Act.STEAL: self._steal,
            Act.PUT_BACK: self._put_back,
            Act.PLACE: self._place,
            Act.HAND_OVER: self._hand_over,
            Act.MOVE: self._move,
            Act.BLOCK: self._block,
            Act.RELEASE: self._release,
        }

    def intervene(self, intervention: Intervention) -> str:
        """Start an intervention; an empty string, or one sentence that says why not."""
        try:
            self._acts[intervention.act](intervention)
        except _Impossible as reason:
            return str(reason)
        return ""

    def act(self) -> None:
        """Go on with what takes longer than one cycle."""
        for pull in tuple(self._pulls):
            self._go_on_pulling(pull)
        if self.hand_over is not None:
            self._go_on_handing_over(self.hand_over)

    def has_in_hand(self, part: Part) -> bool:
        """Whether somebody is just pulling a part away or handing it over."""
        handed = self.hand_over is not None and self.hand_over.part is part
        return handed or self.is_pulling(part)

    def is_pulling(self, part: Part) -> bool:
        return any(pull.hand.part is part for pull in self._pulls)

    def withdraw(self) -> None:
        """Stop everything that is under way (a rebuilt world)."""
        for pull in self._pulls:
            pull.hand.let_go()
        self._pulls.clear()
        if self.hand_over is not None:
            self._end_hand_over(self.hand_over)
        self.obstacle.withdraw()

    def hold_out(self, part: Part, until_s: float) -> None:
        """Hold a part between the robot's fingers once they are open and at rest."""
        part.hide()
        self.hand_over = HandOver(part, until_s)

    # --- Acts ---------------------------------------------------------------------------------

    def _steal(self, intervention: Intervention) -> None:
        part = self._part(intervention)
        if part.stolen or self.is_pulling(part):
            raise _Impossible(f"'{part.name}' is gone already")
        if self._is_waiting_to_hand_over(part) or intervention.manner == "vanish":
            self._take(part)
            part.take_away()
            return
        self._take(part)
        hand = Hand.take_hold(self._client, part, PULL_FORCE_N)
        sideways = self._way_out(part)
        if self._bench.held(self._pr2) is part:
            self._pulls.append(_Pull(hand, first=sideways, then=_UP))
        else:
            self._pulls.append(_Pull(hand, first=_UP, then=sideways))

    def _put_back(self, intervention: Intervention) -> None:
        part = self._part(intervention)
        self._put(part, part.start, f"where '{part.name}' started")

    def _place(self, intervention: Intervention) -> None:
        part = self._part(intervention)
        if intervention.place is None:
            raise _Impossible(f"it does not say at which place to put '{part.name}'")
        place = self._bench.scene.places.get(intervention.place)
        if place is None:
            raise _Impossible(f"the scene has no place '{intervention.place}'")
        pose = PartPose.at(place.pose, self._bench.scene.table.height)
        self._put(part, pose, f"at '{intervention.place}'")

    def _move(self, intervention: Intervention) -> None:
        part, to = self._part(intervention), intervention.to
        assert to is not None  # required by the act itself
        if not self._bench.is_on_table(to.x, to.y):
            raise _Impossible(f"({to.x}, {to.y}) is not on the table")
        pose = PartPose.at(to, self._bench.scene.table.height)
        self._put(part, pose, f"at ({to.x}, {to.y})")

    def _hand_over(self, intervention: Intervention) -> None:
        part = self._part(intervention)
        if self._bench.held(self._pr2) is part:
            raise _Impossible(f"the robot holds '{part.name}' already")
        if self.hand_over is not None and self.hand_over.part is not part:
            raise _Impossible(f"somebody is handing over '{self.hand_over.part.name}' already")
        self._take(part)
        self.hold_out(part, self._body.time_s() + HAND_OVER_S)

    def _block(self, _: Intervention) -> None:
        if self.obstacle.center is not None:
            raise _Impossible("somebody stands in the way already")
        bodies = [self._pr2.body_id, *(part.body_id for part in self._bench.parts.values())]
        for center in (
            *centers_ahead(self._pr2.tool, self._body.ways_ahead()),
            self._between_starts_and_places(),
        ):
            self.obstacle.stand_at(center)
            if self.obstacle.is_clear_of(bodies):
                return
        self.obstacle.withdraw()
        raise _Impossible("there is no room to stand in the arm's way")

    def _release(self, _: Intervention) -> None:
        if self.obstacle.center is None:
            raise _Impossible("nobody stands in the way")
        self.obstacle.withdraw()

    # --- How ----------------------------------------------------------------------------------

    def _part(self, intervention: Intervention) -> Part:
        part = self._bench.parts.get(intervention.object or "")
        if part is None:
            raise _Impossible(f"the scene has no object '{intervention.object}'")
        return part

    def _is_waiting_to_hand_over(self, part: Part) -> bool:
        hand_over = self.hand_over
        return hand_over is not None and hand_over.part is part and hand_over.hand is None

    def _take(self, part: Part) -> None:
        """Let go of a part with whichever hand holds it."""
        for pull in [pull for pull in self._pulls if pull.hand.part is part]:
            pull.hand.let_go()
            self._pulls.remove(pull)
        if self.hand_over is not None and self.hand_over.part is part:
            self._end_hand_over(self.hand_over)

    def _put(self, part: Part, pose: PartPose, where: str) -> None:
        """Put a part down, out of the robot's fingers if need be, unless something is there."""
        before, was_stolen = part.pose(), part.stolen
        x, y, z = pose.position
        part.put(PartPose((x, y, z + _DROP_M), pose.quaternion))
        problem = self._conflict(part)
        if problem is None:
            self._take(part)
            return
        part.put(before)
        part.stolen = was_stolen
        raise _Impossible(f"{problem} is {where}, so '{part.name}' cannot be put there")

    def _conflict(self, part: Part) -> str | None:
        other = next(self._bench.intersecting(part), None)
        if other is not None:
            return f"'{other.name}'"
        if self._client.getClosestPoints(part.body_id, self._pr2.body_id, 0.0):
            return "the robot's arm"
        return None

    def _way_out(self, part: Part) -> Direction:
        """Level, along the fingers' sides, away from the other parts."""
        tool = self._pr2.tool.pose(self._pr2.arm_joints())
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
        pull.go_on(PULL_M_S * PERIOD_S)
        if pull.pulled_m >= PULLED_OUT_M:
            self._pulls.remove(pull)
            pull.hand.let_go()
            pull.hand.part.take_away()

    def _go_on_handing_over(self, hand_over: HandOver) -> None:
        if self._body.time_s() >= hand_over.until_s:
            self._end_hand_over(hand_over)
            hand_over.part.put(hand_over.part.last_rest)
        elif hand_over.hand is None:
            if self._body.ready_to_take:
                hand_over.part.put(self._pose_between_fingers(hand_over.part))
                hand_over.hand = Hand.take_hold(self._client, hand_over.part, HOLD_FORCE_N)
        elif self._body.moving and not self._body.gripper_closing:
            # The robot turned away: try again when it is back.
            hand_over.hand.let_go()
            hand_over.hand = None
            hand_over.part.hide()
        else:
            self._feel_grip(hand_over)

    def _feel_grip(self, hand_over: HandOver) -> None:
        gripped = all(self._pr2.touched_by(hand_over.part.body_id))
        hand_over.gripped_cycles = hand_over.gripped_cycles + 1 if gripped else 0
        if hand_over.gripped_cycles >= _GRIPPED_CYCLES:
            self._end_hand_over(hand_over)

    def _end_hand_over(self, hand_over: HandOver) -> None:
        if hand_over.hand is not None:
            hand_over.hand.let_go()
        self.hand_over = None

    def _pose_between_fingers(self, part: Part) -> PartPose:
        """Upright, with its thin sides to the fingers, grasped where the robot would."""
        definition = part.definition
        grasp = grasp_of(CataloguePart(part.name, definition.size, definition.knob))
        tool = self._pr2.tool.pose(self._pr2.arm_joints())
        x, y, z = (float(value) for value in tool[:3, 3])
        yaw = math.atan2(tool[1, 1], tool[0, 1]) - grasp.yaw
        return PartPose.upright(x, y, z - grasp.height_m, yaw)
