"""Work that would hold the event loop up: little of it in a thread, much in a process of its own.

A thread does not help where one call into C holds the interpreter's lock for long, as reading or
writing many megabytes of JSON does.
"""

import asyncio
import ctypes
import multiprocessing
import os
import signal
import sys
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from functools import partial
from typing import ParamSpec, TypeVar

from mend.server.errors import BusyError
from mend.server.limits import Limits
from mend.server.one_by_one import OneByOne

P = ParamSpec("P")
T = TypeVar("T")

MUCH_CHARS = 128 * 1024
"""From so many characters of text on, work is done in the process."""

PR_SET_PDEATHSIG = 1
NICE = 5
"""So much less urgent than robots is what nobody's safety depends on."""


class OffLoop:
    """Does one piece of long work after the other in a process, which the first one starts.

    Those on whose behalf it is done take turns (`server.asking`).
    `longest_s` is how long one may take.
    """

    def __init__(self, limits: Limits | None = None) -> None:
        limits = limits or Limits()
        self.longest_s = limits.check_s
        self._turns = OneByOne(limits.waiting_chars)
        self._pool: ProcessPoolExecutor | None = None
        self._closed = False

    async def run(self, chars: int, work: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
        """Do what there is to do with so many characters of text.

        `work` and what it is given have to be picklable, and so has what it returns or raises.
        Raises what it raises, and `BusyError` where too much waits, where it takes too long, where
        its process has died, and once this is closed.
        """
        if chars < MUCH_CHARS:
            return await asyncio.to_thread(work, *args, **kwargs)
        async with self._turns.turn(chars):
            return await self._run(partial(work, *args, **kwargs))

    async def _run(self, work: Callable[[], T]) -> T:
        if self._closed:
            raise _shutting_down()
        pool = self._pool or self._start()
        limit = asyncio.timeout(self.longest_s)
        try:
            async with limit:
                return await asyncio.wrap_future(pool.submit(work))
        except BrokenProcessPool:
            if self._closed:
                raise _shutting_down() from None
            self._end()
            raise BusyError(
                "the process that does large pieces of work has died, as where there is too little "
                "memory: try it again"
            ) from None
        except TimeoutError:
            if not limit.expired():
                raise
            self._end()
            raise BusyError(
                f"reading and checking this takes longer than {self.longest_s:g} s",
                limit="check_s",
            ) from None
        except asyncio.CancelledError:
            if self._closed and not _is_cancelled():
                # What had not begun yet was taken out of the process's hands.
                raise _shutting_down() from None
            # Else whoever is next would wait for what nobody wants any more.
            self._end()
            raise

    def _start(self) -> ProcessPoolExecutor:
        context = multiprocessing.get_context("spawn")
        self._pool = ProcessPoolExecutor(1, mp_context=context, initializer=_prepare)
        return self._pool

    def close(self) -> None:
        """End the process, whatever is under way in it, and do no more in one."""
        self._closed = True
        self._end()

    def _end(self) -> None:
        """End the process; what is under way in it is of no use any more. The next starts anew."""
        pool, self._pool = self._pool, None
        if pool is None:
            return
        processes = list((pool._processes or {}).values())
        pool.shutdown(wait=False, cancel_futures=True)
        for process in processes:
            process.kill()


def _is_cancelled() -> bool:
    """Whether it is the current task that is to end, and not only what it waits for."""
    task = asyncio.current_task()
    return task is not None and task.cancelling() > 0


def _shutting_down() -> BusyError:
    return BusyError("the service is shutting down")


def _prepare() -> None:
    """In the process: leave Ctrl-C to the service, and end with it however that ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    os.nice(NICE)
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
