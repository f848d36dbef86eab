"""A console at which somebody speaks: opening its microphone, and what the service made of it."""

import asyncio
import json
from collections.abc import Iterator
from typing import Any

from fake_microphone import Person
from playwright.async_api import Page, WebSocket

PATIENCE_S = 60.0
UTTERANCE_S = 12.0
"""Long after the words must have been heard: said again, they would answer the next question."""
TRIES = 8
HARMLESS = (None, "help", "repeat")


class SpokenConsole:
    """A page in a person's browser, made before the page goes anywhere."""

    def __init__(self, page: Page, person: Person) -> None:
        self.page = page
        self.person = person
        self._messages: asyncio.Queue[dict[str, Any]] = asyncio.Queue()
        page.on("websocket", self._listen)

    async def speak(self, words: str, meant: str) -> None:
        """Open the microphone, into which the words are said, until they are understood.

        What was not understood, or taken for a wish that changes nothing, is said again, as a
        person would: on a busy machine the beginning of the words may be lost.
        """
        self.person.will_say(words)
        microphone = self.page.get_by_role("button", name="Listen and speak")
        for _ in range(TRIES):
            if await microphone.get_attribute("aria-pressed") == "true":
                await microphone.click()
            list(self._waiting())
            await microphone.click()
            await self.message("listening")
            try:
                heard = await self.message("heard", UTTERANCE_S)
            except TimeoutError:
                # They were said before the service listened.
                continue
            if heard["command"] == meant:
                return
            assert heard["command"] in HARMLESS, f"{meant} was taken for {heard['command']}"
        raise AssertionError(f"{meant} was not understood in {TRIES} tries")

    async def message(self, kind: str, timeout_s: float = PATIENCE_S) -> dict[str, Any]:
        """The next message of a kind from the service's speech socket. Raises `TimeoutError`."""
        async with asyncio.timeout(timeout_s):
            while (message := await self._messages.get())["type"] != kind:
                pass
        return message

    def _listen(self, socket: WebSocket) -> None:
        if "/ws/speech" in socket.url:
            socket.on("framereceived", self._take)

    def _take(self, frame: str | bytes) -> None:
        if isinstance(frame, str):
            self._messages.put_nowait(json.loads(frame))

    def _waiting(self) -> Iterator[dict[str, Any]]:
        while not self._messages.empty():
            yield self._messages.get_nowait()
