"""Cutting short: active leaves are put back because something else has changed under them."""

from collections.abc import Iterable, Mapping, Sequence

from mend.server.journal import events as ev
from mend.server.runtime.context import RunContext
from mend.server.runtime.dialogue_driver import DialogueDriver
from mend.server.runtime.report_events import ReportEvents
from mend.server.runtime.robot_proxy import RobotActivity, RobotProxy


class CuttingShort:
    """Puts active leaves of one run back, and lets the robots that held them retreat."""

    def __init__(
        self,
        context: RunContext,
        proxies: Mapping[str, RobotProxy],
        dialogues: DialogueDriver,
        reports: ReportEvents,
    ) -> None:
        self._context = context
        self._proxies = proxies
        self._dialogues = dialogues
        self._reports = reports

    def put_back(self, leaves: Iterable[int], reason: str, *, said: bool = False) -> list[ev.Event]:
        """The events that put active leaves back, and abort the dialogues about them.

        `said`: who was asked something hears the reason.
        """
        state = self._context.state
        events: list[ev.Event] = []
        for leaf in leaves:
            if dialogue := state.dialogue_of(leaf):
                events += [self._dialogues.remark(dialogue, reason)] if said else []
                events.append(self._dialogues.abort(dialogue))
            robot = None if leaf in state.people else state.tree.owner(leaf)
            events.append(self._reports.reset(leaf, robot, reason, failed=False))
        return events

    async def commit(self, leaves: Iterable[int], events: Sequence[ev.Event]) -> None:
        """Commit events that put leaves back; then let the robots that held them retreat."""
        state = self._context.state
        owners = [state.tree.owner(leaf) or "" for leaf in leaves if leaf not in state.people]
        await self._context.commit(events)
        for owner in owners:
            if self._proxies[owner].doing is not RobotActivity.ABSENT:
                self._proxies[owner].retreat()
