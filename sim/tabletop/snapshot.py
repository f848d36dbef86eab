"""What is kept of a tabletop world so that it can be rebuilt."""

from typing import Literal

from mend.documents.strict_model import StrictModel
from mend.sim.hand_over import HandOverSnapshot
from mend.sim.tabletop.part import UprightPose
from mend.tasks.scene import Metres, Name

_DECIMALS = 6
"""A micrometre is enough, and a snapshot is written at every step."""

RestPose = tuple[Metres, Metres, Metres, float]
"""Where the bottom centre of a part rests (x, y, z in the base frame), and its yaw."""


class TabletopSnapshot(StrictModel):
    """The state of a tabletop world between two control cycles.

    `moved`: where those parts last rested that are not where they started. `gone`: those that
    somebody took away. `held` is for readers of the journal (`also_held` what other robots hold): a
    rebuilt robot holds nothing.
    `blocker`: where somebody stands in the way, and up to what height (x, y, top).
    """

    version: Literal[2] = 2
    time_s: float
    moved: dict[Name, RestPose]
    gone: list[Name]
    held: Name | None
    also_held: list[Name] = []
    blocker: tuple[float, float, float] | None
    hand_over: HandOverSnapshot | None
    head_covered: bool = False


def to_rest_pose(pose: UprightPose) -> RestPose:
    """As it is kept."""
    return (
        round(pose.x, _DECIMALS),
        round(pose.y, _DECIMALS),
        round(pose.z, _DECIMALS),
        round(pose.yaw, _DECIMALS),
    )
