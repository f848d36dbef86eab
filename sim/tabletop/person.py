"""The person beside the table: carries out interventions, some over several cycles."""

import math
from dataclasses import dataclass, replace

from mend.sim.acts import PULL_M_PER_S, Acts
from mend.sim.tabletop.part import TablePart, UprightPose, Whereabouts
from mend.sim.tabletop.state import CONTROL_PERIOD_S, TabletopState
from mend.tasks.footprint import Footprint
from mend.tasks.scene import Pose

_PULLED_OUT_M = 0.30
"""So far from where it was, a pulled part is out of sight."""

_STRETCHED_OUT_M = 0.01
"""So near to its hand-over pose an arm is stretched out to somebody."""


@dataclass(slots=True)
class Pull:
    """A part on its way out of somebody's reach; `pulled_m` so far."""

    part: TablePart
    direction: float
    pulled_m: float = 0.0


@dataclass(slots=True)
class TabletopHandOver:
    """A part that somebody holds out until the clock reads `until_s`."""

    part: TablePart
    until_s: float


class TabletopPerson(Acts[TablePart, UprightPose]):
    """Everybody who is not the robot."""

    def __init__(self, state: TabletopState) -> None:
        super().__init__(state.scene, state.parts)
        self._state = state
        self._pulls: list[Pull] = []
        self.hand_over: TabletopHandOver | None = None

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
        self.hand_over = TabletopHandOver(part, until_s)
        self._state.settle()

    # --- What a tabletop adds -----------------------------------------------------------------

    def _now_s(self) -> float:
        return self._state.time_s

    def _is_gone(self, part: TablePart) -> bool:
        return part.whereabouts is Whereabouts.GONE or self.is_pulling(part)

    def _is_held(self, part: TablePart) -> bool:
        return self._state.holder_of(part) is not None

    def _offered(self) -> TablePart | None:
        return None if self.hand_over is None else self.hand_over.part

    def _stands_in_the_way(self) -> bool:
        return self._state.blocker is not None

    def _stand_in_the_way(self) -> None:
        self._state.block_way()

    def _step_aside(self) -> None:
        self._state.step_aside()

    def _take_away(self, part: TablePart, *, by_force: bool) -> None:
        pulled_from = self._state.holder_of(part) or self._state.manipulators[0]
        self._take(part)
        if by_force:
            part.give_to(Whereabouts.WITH_PERSON)
            self._pulls.append(Pull(part, pulled_from.arm.pose.yaw - math.pi / 2))
        else:
            part.give_to(Whereabouts.GONE)
        self._state.settle()

    def _take(self, part: TablePart) -> None:
        """Take a part into the hand, out of the robot's fingers if need be."""
        self._take_from_robot(part)
        self._pulls = [pull for pull in self._pulls if pull.part is not part]
        if self.hand_over is not None and self.hand_over.part is part:
            self.hand_over = None

    def _take_from_robot(self, part: TablePart) -> bool:
        """Take a part from whoever holds it; False if nobody does."""
        holder = self._state.holder_of(part)
        if holder is not None:
            holder.lose_held()
        return holder is not None

    def _start_of(self, part: TablePart) -> UprightPose:
        return part.start

    def _pose_at(self, pose: Pose) -> UprightPose:
        z = self._state.scene.table.height if pose.z is None else pose.z
        return UprightPose(pose.x, pose.y, z, pose.yaw)

    def _footprint(self, part: TablePart) -> Footprint | None:
        return part.footprint if part.whereabouts is Whereabouts.RESTING else None

    def _top_z(self, part: TablePart) -> float:
        return part.pose.z + part.height

    def _put(self, part: TablePart, at: UprightPose, where: str) -> None:  # noqa: ARG002
        """Put a part down, on top of what lies there already."""
        self._take(part)
        # Above all others, so that it comes to rest on them instead of inside them.
        highest = max(
            (
                other.pose.z + other.height
                for other in self._state.parts.values()
                if other is not part and other.whereabouts is Whereabouts.RESTING
            ),
            default=at.z,
        )
        part.rest_at(replace(at, z=max(at.z, highest)))
        self._state.settle()

    def _go_on_pulling(self, pull: Pull) -> None:
        if self._take_from_robot(pull.part):
            # The fingers closed on it only after the hand had.
            pull.part.give_to(Whereabouts.WITH_PERSON)
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

    def _go_on_handing_over(self, hand_over: TabletopHandOver) -> None:
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
        """Hold a part between fingers that are open (or just closing) on an arm at rest.

        Of several arms, that of the robot which stretches it out to take something.
        """
        arms = self._state.manipulators
        if len(arms) > 1:
            arms = [each for each in arms if each.off_hand_over_m() < _STRETCHED_OUT_M]
        found = (each.held_out_to_it(part) for each in arms)
        pose = next((each for each in found if each is not None), None)
        part.give_to(Whereabouts.WITH_PERSON, shown=pose is not None)
        if pose is not None:
            part.pose = pose
