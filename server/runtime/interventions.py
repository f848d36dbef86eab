"""Interventions that were asked for: journaled first, then told to the world until it did them."""

from uuid import uuid4

from server.journal import events as ev
from server.runtime.context import RunContext
from server.runtime.robot_side import RobotSide
from tasks.intervention import Intervention


class Interventions:
    """What people were asked to do in the simulated world of one run."""

    def __init__(self, context: RunContext) -> None:
        self._context = context

    async def accept(
        self, deed: Intervention, by: str, side: RobotSide, author: ev.Author | None = None
    ) -> None:
        """Have a person do something in the world that `side` is in."""
        accepted = ev.InterventionAccepted(
            **self._context.stamp(),
            act=str(deed.act),
            object=deed.object,
            intervention=deed,
            by=by,
            command=str(uuid4()),
            author=author,
        )
        await self._context.commit([accepted])
        if side.hello is not None:
            _tell(accepted, side)

    def tell_again(self, side: RobotSide) -> None:
        """A world was built (again) as the journal has it: what it has not yet done is to come.

        What it did without having reported it is undone by that, so nothing is done twice.
        """
        for accepted in self._context.state.accepted.values():
            _tell(accepted, side)


def _tell(accepted: ev.InterventionAccepted, side: RobotSide) -> None:
    side.intervene(accepted.command, accepted.intervention, accepted.by, None)
