"""What happens in a building besides what people ask of its robots, and when.

Times are seconds on the building's clock.
"""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from mend.documents.strict_model import StrictModel
from mend.fleet.requests import Moment, PlaceName, Text
from mend.tasks.scene import Name


class Lasting(StrictModel):
    """What begins at a moment, and is over at `until_s`, or never."""

    at_s: Moment
    until_s: Moment | None = None

    @model_validator(mode="after")
    def _require_order(self) -> Self:
        if self.until_s is not None and self.until_s <= self.at_s:
            raise ValueError(
                f"what happens at {self.at_s:g} s is over after that, not at {self.until_s:g} s"
            )
        return self


class WayBarred(Lasting):
    """Somebody locks the door between two neighbouring places, or puts things right across."""

    kind: Literal["way_barred"]
    between: Annotated[tuple[PlaceName, PlaceName], Field(strict=False)]


class RobotFails(Lasting):
    """A robot, as the scene calls it, is taken out of service, and put back in.

    Where none is named, it is the next one that brings something.
    """

    kind: Literal["robot_fails"]
    robot: Name | None = None
    reason: Text = "it does not work"


class NobodyAnswers(Lasting):
    """The first question of each leg that begins meanwhile is answered by nobody."""

    kind: Literal["nobody_answers"]


class Cancelled(StrictModel):
    """Somebody does not want any more what they asked for; of what recurs one, as `NAME/2`."""

    kind: Literal["cancelled"]
    at_s: Moment
    request: Annotated[str, Field(min_length=1, max_length=80)]


class WrongFloor(StrictModel):
    """Somebody presses another button: who rides next in an elevator is taken elsewhere first."""

    kind: Literal["wrong_floor"]
    at_s: Moment
    elevator: Annotated[str, Field(min_length=1, max_length=64)]


Happening = Annotated[
    WayBarred | RobotFails | NobodyAnswers | Cancelled | WrongFloor, Field(discriminator="kind")
]
