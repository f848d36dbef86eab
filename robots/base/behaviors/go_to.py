"""`go_to`: drive to a place."""

from collections.abc import Sequence
from typing import ClassVar

from mend.documents.strict_model import StrictModel
from mend.robots.base.behaviors.behavior import BaseBehavior, BaseSituation, Drive
from mend.robots.execution.command_error import CommandError
from mend.tasks.scene import Name


class GoToParameters(StrictModel):
    """`place`: where to go, and where to face there."""

    place: Name


class GoTo(BaseBehavior):
    """Drives to a place, round what stands in the way; waits where there is no way round."""

    name: ClassVar[str] = "go_to"
    parameters: ClassVar[type[StrictModel]] = GoToParameters
    step_count: ClassVar[int | None] = 1

    def drives(self, parameters: StrictModel, situation: BaseSituation) -> Sequence[Drive]:
        assert isinstance(parameters, GoToParameters), "commands are checked before"
        if situation.target is None:
            raise CommandError("go_to needs a place to go to")
        return [Drive(f"go to {parameters.place}", situation.target)]
