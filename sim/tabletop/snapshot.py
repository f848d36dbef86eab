"""What is kept of a tabletop world so that it can be rebuilt."""

from typing import Literal

from tasks.scene import Metres, Name, StrictModel


class RestSnapshot(StrictModel):
    """Where a part last rested: its bottom centre in the base frame; or that it is gone."""

    x: Metres
    y: Metres
    z: Metres
    yaw: float
    gone: bool


class HandOverSnapshot(StrictModel):
    """Somebody holds a part out until the clock reads `until_s`."""

    object: Name
    until_s: float


class TabletopSnapshot(StrictModel):
    """The state of a tabletop world between two control cycles.

    `held` is for readers of the journal: a rebuilt robot holds nothing. `blocker_at`: where
    somebody stands in the way, in the plane.
    """

    version: Literal[1] = 1
    time_s: float
    parts: dict[Name, RestSnapshot]
    held: Name | None
    blocker_at: tuple[float, float] | None
    hand_over: HandOverSnapshot | None
