"""`patrol`: go round some places, and wait at each."""

from collections.abc import Sequence
from typing import Annotated, ClassVar

from pydantic import Field

from mend.documents.strict_model import StrictModel
from mend.robots.base.behaviors import BaseBehavior, BaseSituation, BaseStep, Drive
from mend.robots.execution.command_error import CommandError
from mend.tasks.scene import Name


class PatrolParameters(StrictModel):
    """`stops`: the places, in their order; `wait_s`: how long it waits at each, in seconds."""

    stops: Annotated[list[Name], Field(min_length=1)]
    wait_s: Annotated[float, Field(ge=0.0, le=600.0)] = 1.0


class Patrol(BaseBehavior):
    """Drives from place to place."""

    name: ClassVar[str] = "patrol"
    parameters: ClassVar[type[StrictModel]] = PatrolParameters

    def steps(self, parameters: StrictModel, situation: BaseSituation) -> Sequence[BaseStep]:
        assert isinstance(parameters, PatrolParameters), "commands are checked before"
        unknown = [each for each in parameters.stops if each not in situation.places]
        if unknown:
            raise CommandError(f"the place '{unknown[0]}' is unknown")
        return [
            Drive(f"go to {each}", situation.places[each], wait_s=parameters.wait_s)
            for each in parameters.stops
        ]
