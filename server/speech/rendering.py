"""Spoken texts: each rendered once, off the event loop, and kept while there is room."""

import asyncio
import logging
from collections import OrderedDict
from collections.abc import Iterable

from mend.server.journal.events import Prompt, any_event
from mend.server.journal.journal import Journal, JournalClosedError
from mend.server.journal.subscriptions import PrunedEventsError, SubscriptionOverflowError
from mend.server.speech.phrases import FIXED, help_text
from mend.server.speech.voice import Voice, VoiceError

log = logging.getLogger(__name__)

MAX_KEPT_BYTES = 32 * 1024 * 1024
"""About ten minutes of speech."""

AT_ONCE = 2
MAX_WAITING = 32
LATER_S = 0.05
"""A prompt is rendered so long after it was published: making a process keeps the loop busy for
milliseconds, in which the robot is to hear what was decided."""


class SpokenTexts:
    """The sound of texts in one voice."""

    def __init__(self, voice: Voice, max_kept_bytes: int = MAX_KEPT_BYTES) -> None:
        self._voice = voice
        self._max_kept_bytes = max_kept_bytes
        self._kept: OrderedDict[str, bytes] = OrderedDict()
        self._kept_bytes = 0
        self._rendering: dict[str, asyncio.Task[bytes]] = {}
        self._room = asyncio.Semaphore(AT_ONCE)

    @property
    def engine(self) -> str:
        return self._voice.engine

    async def wav(self, text: str) -> bytes:
        """The WAV file of a text. Raises `VoiceError`."""
        if text in self._kept:
            self._kept.move_to_end(text)
            return self._kept[text]
        task = self._rendering.get(text)
        if task is None:
            if len(self._rendering) >= MAX_WAITING:
                raise VoiceError("too many texts are being rendered; try again")
            task = asyncio.create_task(self._render(text))
            self._rendering[text] = task
            task.add_done_callback(lambda done: self._rendered(text, done))
        # Whoever asked may go away; the others, and the cache, still want it.
        return await asyncio.shield(task)

    async def close(self) -> None:
        """Stop rendering."""
        tasks = list(self._rendering.values())
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    async def _render(self, text: str) -> bytes:
        async with self._room:
            return await self._voice.render(text)

    def _rendered(self, text: str, task: asyncio.Task[bytes]) -> None:
        del self._rendering[text]
        if task.cancelled() or task.exception() is not None:
            return
        self._kept[text] = task.result()
        self._kept_bytes += len(task.result())
        while self._kept_bytes > self._max_kept_bytes:
            _, dropped = self._kept.popitem(last=False)
            self._kept_bytes -= len(dropped)


async def render_prompts(texts: SpokenTexts, journal: Journal) -> None:
    """Render every prompt when it is published, until the journal closes."""
    while True:
        with journal.subscribe(journal.head) as subscription:
            try:
                await _render_all(texts, FIXED.values())
                async for record in subscription:
                    if '"type":"prompt"' in record.text:
                        await asyncio.sleep(LATER_S)
                        await _render_prompt(texts, record.text)
            except (SubscriptionOverflowError, PrunedEventsError):
                # Only a head start is lost: what is asked for is rendered then.
                continue
            except JournalClosedError:
                return
            return


async def _render_prompt(texts: SpokenTexts, text: str) -> None:
    event = any_event.validate_json(text)
    if isinstance(event, Prompt):
        more = [help_text(event.answers, event.ways)] if event.answers else []
        await _render_all(texts, [event.text, *more])


async def _render_all(texts: SpokenTexts, wanted: Iterable[str]) -> None:
    for text in wanted:
        try:
            await texts.wav(text)
        except VoiceError as error:
            log.warning("a text was not rendered before it was asked for: %s", error)
