"""The person beside the table: carries out interventions, some over several cycles."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from sim.tabletop.arm import MAX_OPENING_M
from sim.tabletop.part import PartPose, TablePart, Whereabouts
from sim.tabletop.resting import is_on_table
from sim.tabletop.state import CONTROL_PERIOD_S, TabletopState
from tasks.intervention import Act, Intervention

PULL_M_PER_S = 0.4
_PULLED_OUT_M = 0.30
"""So far from where it was, a pulled part is out of sight."""

HAND_OVER_S = 15.0
"""How long somebody holds a part out to the robot."""

BLOCK_DISTANCE_M = 0.22
"""How far ahead of the tool somebody stands who is in its way."""


class _Impossible(Exception):  # noqa: N818 - an answer to the one who asked, not a failure
    """An intervention cannot be carried out; the message says why."""


@dataclass(slots=True)
class Pull:
    """A part on its way out of somebody's reach; `pulled_m` so far."""

    part: TablePart
    direction: float
    pulled_m: float = 0.0


@dataclass(slots=True)
class HandOver:
    """A part that somebody holds out until the clock reads `until_s`."""

    part: TablePart
    until_s: float


class Person:
    """Everybody who is not the robot."""

    def __init__(self, state: TabletopState) -> None:
        self._state = state
        self._pulls: list[Pull] = []
        self.hand_over: HandOver | None = None
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

    def withdraw(self) -> None:
        """Stop everything that is under way (a rebuilt world)."""
        self._pulls.clear()
        self.hand_over = None

    def is_pulling(self, part: TablePart) -> bool:
        """Whether somebody is just taking a part away."""
        return any(pull.part is part for pull in self._pulls)

    def hold_out(self, part: TablePart, until_s: float) -> None:
        """Hold a part between the robot's fingers whenever they are open and at rest."""
        part.give_to(Whereabouts.WITH_PERSON, shown=False)
        self.hand_over = HandOver(part, until_s)

    def _steal(self, intervention: Intervention) -> None:
        part = self._part(intervention)
        if part.whereabouts is Whereabouts.GONE or self.is_pulling(part):
            raise _Impossible(f"'{part.name}' is gone already")
        if intervention.manner == "pull":
            self._take(part)
            part.give_to(Whereabouts.WITH_PERSON)
            self._pulls.append(Pull(part, self._state.arm.pose.yaw - math.pi / 2))
        else:
            self._take(part)
            part.give_to(Whereabouts.GONE)
        self._state.settle()

    def _put_back(self, intervention: Intervention) -> None:
        part = self._part(intervention)
        self._put(part, part.start)

    def _place(self, intervention: Intervention) -> None:
        part = self._part(intervention)
        if intervention.place is None:
            raise _Impossible(f"it does not say at which place to put '{part.name}'")
        place = self._state.scene.places.get(intervention.place)
        if place is None:
            raise _Impossible(f"the scene has no place '{intervention.place}'")
        pose = place.pose
        height = self._state.scene.table.height if pose.z is None else pose.z
        self._put(part, PartPose(pose.x, pose.y, height, pose.yaw))

    def _move(self, intervention: Intervention) -> None:
        part, to = self._part(intervention), intervention.to
        assert to is not None  # required by the act itself
        table = self._state.scene.table
        if not is_on_table(table, to.x, to.y):
            raise _Impossible(f"({to.x}, {to.y}) is not on the table")
        self._put(part, PartPose(to.x, to.y, table.height if to.z is None else to.z, to.yaw))

    def _hand_over(self, intervention: Intervention) -> None:
        part = self._part(intervention)
        if self._state.held is part:
            raise _Impossible(f"the robot holds '{part.name}' already")
        if self.hand_over is not None and self.hand_over.part is not part:
            raise _Impossible(f"somebody is handing over '{self.hand_over.part.name}' already")
        self._take(part)
        self.hold_out(part, self._state.time_s + HAND_OVER_S)
        self._state.settle()

    def _block(self, _: Intervention) -> None:
        if self._state.blocker_at is not None:
            raise _Impossible("somebody stands in the way already")
        self._state.blocker_at = self._state.ahead_of_arm(BLOCK_DISTANCE_M)

    def _release(self, _: Intervention) -> None:
        if self._state.blocker_at is None:
            raise _Impossible("nobody stands in the way")
        self._state.blocker_at = None
        self._state.touching = False

    def _part(self, intervention: Intervention) -> TablePart:
        part = self._state.parts.get(intervention.object or "")
        if part is None:
            raise _Impossible(f"the scene has no object '{intervention.object}'")
        return part

    def _take(self, part: TablePart) -> None:
        """Take a part into the hand, out of the robot's fingers if need be."""
        if self._state.held is part:
            self._state.take_from_robot()
        self._pulls = [pull for pull in self._pulls if pull.part is not part]
        if self.hand_over is not None and self.hand_over.part is part:
            self.hand_over = None

    def _put(self, part: TablePart, pose: PartPose) -> None:
        """Put a part down, on top of what lies there already."""
        self._take(part)
        # Above all others, so that it comes to rest on them instead of inside them.
        highest = max(
            (
                other.pose.z + other.height
                for other in self._state.parts.values()
                if other is not part and other.whereabouts is Whereabouts.RESTING
            ),
            default=pose.z,
        )
        part.rest_at(replace(pose, z=max(pose.z, highest)))
        self._state.settle()

    def _go_on_pulling(self, pull: Pull) -> None:
        step_m = PULL_M_PER_S * CONTROL_PERIOD_S
        pull.pulled_m += step_m
        pose = pull.part.pose
        pull.part.pose = replace(
            pose,
            x=pose.x + step_m * math.cos(pull.direction),
            y=pose.y + step_m * math.sin(pull.direction),
        )
        if pull.pulled_m >= _PULLED_OUT_M:
            self._pulls.remove(pull)
            pull.part.give_to(Whereabouts.GONE)

    def _go_on_handing_over(self, hand_over: HandOver) -> None:
        part, state = hand_over.part, self._state
        if part.whereabouts is Whereabouts.HELD:
            self.hand_over = None
        elif state.time_s >= hand_over.until_s:
            self.hand_over = None
            part.rest_at(part.last_rest)
            state.settle()
        else:
            self._follow_fingers(part)

    def _follow_fingers(self, part: TablePart) -> None:
        """Hold a part between fingers that are open (or just closing) on an arm at rest."""
        state = self._state
        at = state.centred_in_fingers(part)
        width = 2 * part.grasp_box.half_width(-at.yaw)
        held_out = (
            not state.arm.moving
            and state.held is None
            and width <= state.gripper.opening_m <= MAX_OPENING_M
        )
        part.give_to(Whereabouts.WITH_PERSON, shown=held_out)
        if held_out:
            part.pose = state.pose_in_fingers(at)
