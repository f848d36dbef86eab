"""Work that many ask for at about one time: done once for all of them."""

import asyncio
from collections.abc import Callable, Coroutine
from functools import partial
from typing import Any, Generic, TypeVar

Key = TypeVar("Key")
Made = TypeVar("Made")


class SharedWork(Generic[Key, Made]):
    """What comes of work, by key; known while that goes on, and from then on if it is to `keep` it.

    Work that fails is done anew for whoever asks next.
    """

    def __init__(self, *, keep: bool = False) -> None:
        self._keep = keep
        self._tasks: dict[Key, asyncio.Task[Made]] = {}

    async def of(self, key: Key, work: Callable[[], Coroutine[Any, Any, Made]]) -> Made:
        """What comes of the work of this key. Raises what that raises."""
        task = self._tasks.get(key)
        if task is None:
            task = self._tasks[key] = asyncio.create_task(work())
            task.add_done_callback(partial(self._ended, key))
        # Who goes away takes it from nobody else.
        return await asyncio.shield(task)

    def _ended(self, key: Key, task: asyncio.Task[Made]) -> None:
        if not self._keep or task.cancelled() or task.exception() is not None:
            del self._tasks[key]
