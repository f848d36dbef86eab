"""Cutting short: active leaves are put back because something else has changed under them."""

from collections.abc import Iterable, Mapping

from server.journal import events as ev
from server.runtime.context import RunContext
from server.runtime.dialogue_driver import DialogueDriver
from server.runtime.report_events import ReportEvents
from server.runtime.robot_side import Doing, RobotSide


class CuttingShort:
    """Puts active leaves of one run back: first the events, then the robots that held them."""

    def __init__(
        self,
        context: RunContext,
        sides: Mapping[str, RobotSide],
        dialogues: DialogueDriver,
        reports: ReportEvents,
    ) -> None:
        self._context = context
        self._sides = sides
        self._dialogues = dialogues
        self._reports = reports

    async def commit(self, leaves: Iterable[int], reason: str, after: Iterable[ev.Event]) -> None:
        """Put leaves back, then commit what comes `after` that, then let their robots retreat."""
        state = self._context.state
        events: list[ev.Event] = []
        owners: list[str] = []
        for leaf in leaves:
            owner = state.tree.owner(leaf) or ""
            if dialogue := state.dialogue_of(leaf):
                events.append(self._dialogues.abort(dialogue))
            events.append(self._reports.reset(leaf, owner, reason, failed=False))
            owners.append(owner)
        await self._context.commit([*events, *after])
        for owner in owners:
            if self._sides[owner].doing is not Doing.ABSENT:
                self._sides[owner].retreat()
