"""An issue among others, as clients are told."""

from datetime import datetime
from uuid import UUID

from pydantic import BaseModel, ConfigDict

from mend.dialogue.script import CloseReason


class IssueSummary(BaseModel):
    """One line about an issue.

    `seq` is that of the event that raised it, `time` on its run's clock. `outcome` says how its
    dialogue ended, null while that goes on, or where none was opened.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    seq: int
    run: UUID
    tree: str
    world: str
    issue: str
    object: str | None
    place: str | None
    robot: str
    name: str
    node: str
    step: int
    time: float
    raised: datetime
    picture: UUID | None
    dialogue: UUID | None
    outcome: CloseReason | None
