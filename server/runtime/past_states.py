"""States of runs at events of the past: folded once for all who ask for one at about one time."""

import asyncio
from collections import OrderedDict
from collections.abc import Callable
from functools import partial
from uuid import UUID

from mend.server.runtime.history import History
from mend.server.runtime.run_state import RunState
from mend.server.runtime.shared_work import SharedWork

KEPT_S = 60.0
MOST_KEPT = 8
"""So many moments are kept, each with the states of all its runs."""

Later = Callable[[float, Callable[[], None]], object]
"""Has something done after so many seconds."""


def in_this_loop(delay_s: float, what: Callable[[], None]) -> object:
    """Have something done later by the running event loop."""
    return asyncio.get_running_loop().call_later(delay_s, what)


class PastStates:
    """The past states that were asked for lately. Whoever lost one service comes back at once."""

    def __init__(self, history: History, later: Later = in_this_loop) -> None:
        self._history = history
        self._later = later
        self._moments: OrderedDict[int, SharedWork[UUID, RunState | None]] = OrderedDict()

    async def at(self, run: UUID, seq: int, now: RunState | None) -> RunState | None:
        """The state of a run after event `seq`, None if it had not begun; `now`: a later one.

        Raises `UnreadableError`.
        """
        return await self._moment(seq).of(run, lambda: self._history.at(run, seq, now))

    def _moment(self, seq: int) -> SharedWork[UUID, RunState | None]:
        moment = self._moments.get(seq)
        if moment is None:
            moment = self._moments[seq] = SharedWork(keep=True)
            self._later(KEPT_S, partial(self._forget, seq))
            while len(self._moments) > MOST_KEPT:
                self._moments.popitem(last=False)
        self._moments.move_to_end(seq)
        return moment

    def _forget(self, seq: int) -> None:
        # One that had to make room and has come back since only goes early.
        self._moments.pop(seq, None)
