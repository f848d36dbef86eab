"""A conversation that goes on: its ear, its pauses and its end, tied to one helper."""

import asyncio
import logging
from collections.abc import Awaitable, Callable, Coroutine
from typing import Any

from mend.server.speech.commands import Command
from mend.server.speech.conversation import Act, EndReason, SpokenConversation, State
from mend.server.speech.ear import Ear, EarLostError, EarReport, Ears, TooManyConversationsError
from mend.server.speech.vocabulary import Vocabulary

log = logging.getLogger(__name__)

Perform = Callable[[Act], Awaitable[None]]


class Talk:
    """One spoken conversation, from `begin` to its one `End`.

    `perform` is awaited for each act, in order, one at a time. `over` is awaited for the reason
    why the question waits for no answer any more. A command that it `takes` not is not understood.
    """

    def __init__(
        self,
        conversation: SpokenConversation,
        ears: Ears,
        perform: Perform,
        over: Coroutine[Any, Any, EndReason],
        vocabulary: Vocabulary = Vocabulary.ANSWER,
        takes: Callable[[Command], bool] = lambda _: True,
    ) -> None:
        self._takes = takes
        self._vocabulary = vocabulary
        self._conversation = conversation
        self._ears = ears
        self._perform = perform
        self._over = over
        self._ear: Ear | None = None
        self._ear_ready = asyncio.Event()
        self._interruptions = 0
        self._turn = asyncio.Lock()
        self._tasks: list[asyncio.Task[None]] = []

    async def begin(self) -> None:
        """Ask the question, and get an ear meanwhile."""
        self._start(self._follow_ear())
        self._start(self._follow_question())
        await self._do(self._conversation.open)

    async def spoken(self) -> None:
        """What was said has been played. Raises `IllegalTransitionError` if nothing was."""
        await self._do(self._conversation.spoken)
        self._start(self._pause())

    def hear(self, pcm: bytes) -> None:
        """Take sound from the microphone, empty where some is missing.

        Dropped unless it is listened to.
        """
        if self._ear is None or not self._conversation.listens:
            return
        if pcm:
            self._ear.hear(pcm)
        else:
            self._ear.skip()

    async def end(self, reason: EndReason) -> None:
        """End it, unless it has ended."""
        await self._end(reason)
        await self.close()

    async def close(self) -> None:
        """Let go of everything; nobody is told."""
        current = asyncio.current_task()
        tasks = [task for task in self._tasks if task is not current]
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        self._over.close()
        ear, self._ear = self._ear, None
        if ear is not None:
            await ear.close()

    def _start(self, work: Coroutine[Any, Any, None]) -> None:
        self._tasks = [task for task in self._tasks if not task.done()]
        self._tasks.append(asyncio.create_task(work))

    async def _do(self, call: Callable[[], list[Act]]) -> None:
        """Make one transition and perform what follows, before the next one is made."""
        async with self._turn:
            listened = self._conversation.listens
            acts = call()
            if listened and not self._conversation.listens and self._ear is not None:
                self._ear.interrupt()
                self._interruptions += 1
            for act in acts:
                await self._perform(act)

    async def _end(self, reason: EndReason) -> None:
        def end() -> list[Act]:
            ended = self._conversation.state is State.ENDED
            return [] if ended else self._conversation.end(reason)

        await self._do(end)

    async def _pause(self) -> None:
        await self._ear_ready.wait()
        while (left_s := self._conversation.pause_left_s) is not None:
            await asyncio.sleep(left_s)
            if self._conversation.state is State.PAUSING:
                await self._do(self._conversation.pause_over)

    async def _follow_question(self) -> None:
        await self._end(await self._over)

    async def _follow_ear(self) -> None:
        try:
            self._ear = await self._ears.open(self._vocabulary)
            self._ear_ready.set()
            while self._conversation.state is not State.ENDED:
                await self._take(await self._ear.report())
        except (EarLostError, TooManyConversationsError) as error:
            log.warning("a spoken conversation was lost: %s", error)
            await self._end(EndReason.LOST)

    async def _take(self, report: EarReport) -> None:
        """Take a report, unless it is about sound from before the robot spoke."""
        if report.interruptions != self._interruptions:
            return
        state = self._conversation.state
        if report.kind == "began" and state is State.LISTENING:
            await self._do(self._conversation.speech_began)
        elif report.kind == "utterance" and state is State.HEARING:
            if report.words:
                taken = report.command is not None and self._takes(report.command)
                command, phrase = (report.command, report.phrase) if taken else (None, None)
                await self._do(
                    lambda: self._conversation.utterance(command, phrase, report.latency_s)
                )
            else:
                await self._do(self._conversation.nothing_said)
