"""`go_to`: drive to a place, and ride to its floor."""

from collections.abc import Sequence
from typing import Annotated, ClassVar

from pydantic import Field

from mend.documents.strict_model import StrictModel
from mend.robots.base.behaviors.behavior import (
    BaseBehavior,
    BaseSituation,
    BaseStep,
    steps_to,
)
from mend.tasks.scene import Name


class GoToParameters(StrictModel):
    """`place`: where to go, and where to face there.

    `near_m`: so near is near enough where something keeps it from getting nearer.
    """

    place: Name
    near_m: Annotated[float, Field(ge=0.0, le=3.0)] = 0.0


class GoTo(BaseBehavior):
    """Drives to a place, round what stands in the way; waits where there is no way round.

    Where the place is on another floor it takes elevators.
    """

    name: ClassVar[str] = "go_to"
    parameters: ClassVar[type[StrictModel]] = GoToParameters

    def steps(self, parameters: StrictModel, situation: BaseSituation) -> Sequence[BaseStep]:
        assert isinstance(parameters, GoToParameters), "commands are checked before"
        return steps_to(parameters.place, situation, parameters.near_m)
