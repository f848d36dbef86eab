"""What operators tell a fleet, checked at the edge."""

from typing import Annotated, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

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


class WayReport(BaseModel):
    """What somebody has found of the way `between` two neighbouring places, or of an `elevator`.

    `until_s`: until when it may last (the site's clock); without, it is forgotten after a while.
    """

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    finding: Literal["blocked", "door_closed", "elevator_dead", "open"]
    between: Annotated[list[PlaceName], Field(min_length=2, max_length=2)] | None = None
    elevator: PlaceName | None = None
    until_s: Moment | None = None

    @model_validator(mode="after")
    def _require_one(self) -> Self:
        if (self.between is None) == (self.elevator is None):
            raise ValueError("expected either the two places of 'between', or an 'elevator'")
        if self.between is not None and self.between[0] == self.between[1]:
            raise ValueError(f"a way is between two places, not '{self.between[0]}' twice")
        if self.finding in ("blocked", "door_closed") and self.between is None:
            raise ValueError("an elevator is 'elevator_dead' or 'open'")
        return self
