"""States of runs at events of the past: folded once for all who ask for one at about one time."""

import asyncio
from collections import OrderedDict
from uuid import UUID

from server.runtime.history import History
from server.runtime.run_state import RunState

MOST_KEPT = 8


class PastStates:
    """The few past states that were asked for last. Whoever lost one service comes back at once."""

    def __init__(self, history: History) -> None:
        self._history = history
        self._kept: OrderedDict[tuple[UUID, int], asyncio.Task[RunState | None]] = OrderedDict()

    async def at(self, run: UUID, seq: int, now: RunState | None) -> RunState | None:
        """The state of a run after event `seq`, None if it had not begun; `now`: a later one.

        Raises `UnreadableError`.
        """
        key = run, seq
        task = self._kept.get(key)
        if task is None:
            task = self._kept[key] = asyncio.create_task(self._history.at(run, seq, now))
            while len(self._kept) > MOST_KEPT:
                self._kept.popitem(last=False)
        self._kept.move_to_end(key)
        try:
            # Who goes away takes it from nobody else.
            return await asyncio.shield(task)
        except Exception:
            self._kept.pop(key, None)
            raise
