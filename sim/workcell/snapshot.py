"""What is kept of a workcell so that it can be rebuilt."""

from typing import Literal

from mend.documents.strict_model import StrictModel
from mend.sim.hand_over import HandOverSnapshot
from mend.sim.workcell.parts import PartPose
from mend.tasks.scene import Name

Triple = tuple[float, float, float]


class PoseSnapshot(StrictModel):
    """A pose of a bottom centre in the base frame; the quaternion is (x, y, z, w)."""

    position: Triple
    quaternion: tuple[float, float, float, float]

    @classmethod
    def of(cls, pose: PartPose) -> "PoseSnapshot":
        return cls(position=pose.position, quaternion=pose.quaternion)

    def to_pose(self) -> PartPose:
        return PartPose(self.position, self.quaternion)


class PartSnapshot(StrictModel):
    """Where a part is to lie in the rebuilt world, where it started, and whether it is stolen."""

    rest: PoseSnapshot
    start: PoseSnapshot
    stolen: bool


class WorkcellSnapshot(StrictModel):
    """The state of a workcell between two control cycles.

    `held` is for readers of the journal (`also_held` what other robots hold): a rebuilt robot holds
    nothing. `obstacle` is the middle of what somebody holds in the arm's way; `generator` the state
    of the first robot's random numbers (`other_generators` of the others', in the scene's order),
    as JSON text because its integers are longer than 64 bits.
    """

    version: Literal[1] = 1
    cycle: int
    parts: dict[Name, PartSnapshot]
    held: Name | None
    also_held: list[Name] = []
    obstacle: Triple | None
    hand_over: HandOverSnapshot | None
    generator: str
    other_generators: list[str] = []
    head_covered: bool = False
