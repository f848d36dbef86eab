"""Giving up: which leaves cannot be done, and what becomes of them."""

from collections.abc import Mapping

import numpy as np

from mend.server.journal import events as ev
from mend.server.runtime.choosing import suitabilities
from mend.server.runtime.context import RunContext
from mend.server.runtime.cutting_short import CuttingShort
from mend.server.runtime.failure import fail_run
from mend.server.runtime.report_events import ReportEvents
from mend.server.runtime.robot_proxy import RobotProxy


class GivingUp:
    """Abandons the alternatives of one run that cannot be done, or fails it."""

    def __init__(
        self,
        context: RunContext,
        proxies: Mapping[str, RobotProxy],
        reports: ReportEvents,
        cutting_short: CuttingShort,
    ) -> None:
        self._context = context
        self._proxies = proxies
        self._reports = reports
        self._cutting_short = cutting_short

    async def give_up_what_cannot_be_done(self) -> bool:
        """Give up one leaf that cannot be done; True if there was one."""
        for leaf, reason in (*self._failed_too_often(), *self._gone_too_often()):
            await self._give_up(leaf, reason)
            return True
        for leaf in self._for_nobody():
            await self._give_up(leaf, f"no robot can do it{self._who_is_in_the_way(leaf)}")
            return True
        return False

    def _failed_too_often(self) -> list[tuple[int, str]]:
        state = self._context.state
        most = state.request.max_attempts
        reason = "it failed once" if most == 1 else f"it failed {most} times"
        return [(leaf, reason) for leaf in sorted(state.exhausted) if state.tree.eligible(leaf)]

    def _gone_too_often(self) -> list[tuple[int, str]]:
        """What somebody takes away each time is not placed for ever."""
        state, most = self._context.state, self._context.settings.max_times_gone
        reason = f"it was gone again after it had been done {most + 1} times"
        return [
            (leaf, reason)
            for leaf, times in sorted(state.times_gone.items())
            if times > most and state.tree.eligible(leaf)
        ]

    def _for_nobody(self) -> list[int]:
        """The first leaf that none of the robots can do, once all of them are known."""
        state, proxies = self._context.state, self._proxies.values()
        if not all(proxy.hello is not None or proxy.gone_for_good for proxy in proxies):
            return []
        if any(proxy.gone_for_good and proxy.owes_a_report for proxy in proxies):
            # Once its arm rests it is in nobody's way.
            return []
        leaves = state.tree.eligible_leaves()
        anybody = np.zeros(leaves.size, dtype=np.bool_)
        for proxy in proxies:
            anybody |= suitabilities(state, proxy, leaves) > 0
        return [int(leaf) for leaf in leaves[~anybody][:1]]

    def _who_is_in_the_way(self, leaf: int) -> str:
        team = next(iter(self._proxies.values())).team
        definition = self._context.state.tree.leaf_definition(leaf)
        stopped = [] if team is None else team.given_up_in_the_way(definition)
        names = ", ".join(f"'{each}'" for each in stopped)
        return f": the arm of {names} may be in the way, which was given up there" if names else ""

    async def _give_up(self, leaf: int, reason: str) -> None:
        """Abandon the nearest alternative that holds a leaf, or fail the run."""
        state = self._context.state
        given_up = state.tree.give_up(leaf)
        if given_up is None:
            name = state.tree.name_of(leaf)
            reason = f"'{name}' could not be done: {reason}"
            await fail_run(self._context, reason, state.tree.path_of(leaf))
            return
        put_back = self._cutting_short.put_back(given_up.put_back, "its alternative was abandoned")
        abandoned = ev.NodeAbandoned(
            **self._context.stamp(),
            **self._reports.node(given_up.alternative),
            leaf=state.tree.path_of(leaf),
            reason=reason,
        )
        await self._cutting_short.commit(given_up.put_back, [*put_back, abandoned])
