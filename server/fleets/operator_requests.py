"""What operators tell a fleet, checked at the edge."""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from mend.documents.spellings import SEEN_CHARACTERS
from mend.fleet.requests import Moment, PlaceName


class OutOfService(BaseModel):
    """Why a robot is to do nothing more for now."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    reason: Annotated[str, Field(min_length=1, max_length=300, pattern=SEEN_CHARACTERS)]


class GoThere(BaseModel):
    """Where a robot that carries out no leg is to go."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    place: PlaceName


class WayFound(BaseModel):
    """What somebody has found of the way between two neighbouring places.

    `until_s`: until when it may last (the site's clock); without, it is forgotten after a while.
    """

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    finding: Literal["blocked", "door_closed", "open"]
    between: Annotated[list[PlaceName], Field(min_length=2, max_length=2)]
    until_s: Moment | None = None
