"""Interventions that were asked for: journaled first, then told to the world until it did them."""

import logging
from uuid import uuid4

from mend.errors import ConflictError
from mend.server.journal import events as ev
from mend.server.runtime.clock import rate_while_asked
from mend.server.runtime.context import RunContext
from mend.server.runtime.robot_proxy import RobotProxy
from mend.tasks.intervention import Intervention

MOST_WAITING = 100
"""So many may have been accepted and not be done yet."""
FALLS_BEHIND_S = 2.0
"""A world is taken to be behind by no more than this: the service may have been gone, or the run
have been paused."""

log = logging.getLogger(__name__)


class Interventions:
    """What people were asked to do in the simulated world of one run."""

    def __init__(self, context: RunContext) -> None:
        self._context = context

    async def accept(
        self, deed: Intervention, by: str, proxy: RobotProxy, author: ev.Author | None = None
    ) -> None:
        """Have a person do something in the world that `proxy` is in.

        Raises `ConflictError` while too many others are still to be done.
        """
        if len(self._context.state.accepted) >= MOST_WAITING:
            raise ConflictError(
                f"{MOST_WAITING} interventions of this run are still to be done: wait for one of "
                "them",
                limit="waiting_interventions",
            )
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
        if proxy.hello is not None:
            _tell(accepted, proxy, self._not_before(accepted))

    def _not_before(self, accepted: ev.InterventionAccepted) -> float | None:
        """The moment (robot's clock) before which nobody can do it who has just promised help.

        A world on a busy machine falls behind: people do not reach into it sooner after what they
        were told than they really did. One that stood meanwhile has not fallen behind.
        """
        state, clock = self._context.state, self._context.clock
        promised = [each.awaiting for each in state.open_dialogues if each.awaiting is not None]
        if not promised:
            return None
        last = max(promised, key=lambda each: each.wall_time)
        since_s = (accepted.wall_time - last.wall_time).total_seconds()
        done_s = last.time + since_s * rate_while_asked(state.started.speed)
        return clock.to_robot(min(done_s, clock.now() + FALLS_BEHIND_S))

    def tell_again(self, proxy: RobotProxy) -> None:
        """A world was built (again) as the journal has it: what it has not yet done is to come.

        What it did without having reported it is undone by that, so nothing is done twice.
        """
        for accepted in self._context.state.accepted.values():
            _tell(accepted, proxy, None)


def _tell(accepted: ev.InterventionAccepted, proxy: RobotProxy, at: float | None) -> None:
    try:
        proxy.intervene(accepted.command, accepted.intervention, accepted.by, at)
    except ConflictError as error:
        # It is journaled, and so to be done, whatever else waits for the robot: it is told again
        # once it has started anew.
        log.warning("an intervention waits: %s", error)
