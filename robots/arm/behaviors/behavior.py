"""A behavior of an arm: the list of its steps, and what it may know when it lays them out."""

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal

from mend.documents.strict_model import StrictModel
from mend.robots.arm.body import ToolPose
from mend.robots.arm.grasp import Grasp
from mend.robots.arm.gripper import GripperModel
from mend.robots.catalogue import Part
from mend.robots.execution.behavior import Behavior
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import Location


@dataclass(frozen=True, slots=True)
class Move:
    """Move the tool point to a pose (base frame); `speed` in (0, 1] of the arm's best.

    `opening_m`: an empty gripper has its fingers so far apart before it comes there.
    """

    to: ToolPose
    speed: float
    opening_m: float | None = None


@dataclass(frozen=True, slots=True)
class SetGripper:
    """Open or close the gripper; `opening_m` is how far it opens, None as far as it goes."""

    to: Literal["open", "closed"]
    opening_m: float | None = None


@dataclass(frozen=True, slots=True)
class Step:
    """One step of a behavior; `settle_s` passes between its end and the next step.

    `phase` says what it is for: monitors watch phases, and only a gripper that closes in a `GRASP`
    takes hold of the object.
    """

    name: str
    action: Move | SetGripper
    phase: Phase
    settle_s: float = 0.0


@dataclass(frozen=True, slots=True)
class Situation:
    """What a behavior may know when it lays out its steps (lengths in metres, base frame).

    `found` is where the object's bottom centre is and `target` where it is to be; None where the
    behavior has no object or no place. `table_z` is the height of the table. `grasp` is how the
    object is to be grasped, or is held; None where there is none. What the gripper moves sideways
    has to stay above `clear_z`, and the tool point is best raised by `lift_m` before that.
    """

    part: Part | None
    found: Location | None
    target: Location | None
    table_z: float
    gripper: GripperModel
    grasp: Grasp | None
    clear_z: float
    lift_m: float


class ArmBehavior(Behavior):
    """What an arm does, as a list of steps.

    A behavior whose parameters have an `object` is given that part, with a `place` that target.
    `carry_from` is the step (from 1) at which to go on with the object already in the gripper;
    None for the first that carries.
    """

    carry_from: ClassVar[int | None] = None

    @abstractmethod
    def steps(self, parameters: StrictModel, situation: Situation) -> Sequence[Step]:
        """Lay out all steps.

        Where `found` is None the steps before the first that carries are not walked and their
        poses may be anything.
        """

    def first_carrying(self, steps: Sequence[Step]) -> int | None:
        """The step at which to go on with the object in the gripper; None if there is none."""
        if self.carry_from is not None:
            return self.carry_from
        carrying = (n for n, step in enumerate(steps, start=1) if step.phase is Phase.CARRY)
        return next(carrying, None)
