"""A helper at the terminal: whoever started the run answers the robot's questions."""

import asyncio
import getpass
import sys
from collections.abc import Awaitable, Callable
from typing import Literal
from uuid import UUID

from mend.errors import ConflictError
from mend.server.cli.output import EventOutput
from mend.server.journal import events as ev

WORDS: dict[str, Literal["yes", "no"]] = {"y": "yes", "yes": "yes", "n": "no", "no": "no"}


AnswerPrompt = Callable[[UUID, UUID, Literal["yes", "no"], str], Awaitable[object]]
"""Answers a dialogue's prompt by yes or no, for a helper; raises `ConflictError`: too late."""


class TerminalHelper:
    """Reads yes or no from the terminal while a question is open."""

    def __init__(self, answer: AnswerPrompt, output: EventOutput) -> None:
        self._answer_prompt = answer
        self._output = output
        self._name = getpass.getuser()
        self._open: ev.Prompt | None = None
        self._answering: set[asyncio.Task[None]] = set()

    def __enter__(self) -> "TerminalHelper":
        asyncio.get_running_loop().add_reader(sys.stdin.fileno(), self._read)
        return self

    def __exit__(self, *_: object) -> None:
        asyncio.get_running_loop().remove_reader(sys.stdin.fileno())
        for task in self._answering:
            task.cancel()

    def take(self, event: ev.Event) -> None:
        """Take note of what is asked, and of what no longer waits for an answer."""
        if isinstance(event, ev.Prompt) and event.kind == "ask":
            self._open = event
            effects = "; ".join(f"{each.value}: {each.effect}" for each in event.answers)
            self._output.note(f"          Your answer, yes or no? ({effects})")
        elif isinstance(event, ev.Answered | ev.DialogueClosed):
            self._open = None

    def _read(self) -> None:
        line = sys.stdin.readline()
        if not line:
            asyncio.get_running_loop().remove_reader(sys.stdin.fileno())
            return
        answer = WORDS.get(line.strip().lower())
        if self._open is None:
            self._output.note("          Nobody asks anything at the moment.")
        elif answer is None:
            self._output.note("          Please answer yes or no.")
        else:
            task = asyncio.create_task(self._answer(self._open, answer))
            self._answering.add(task)
            task.add_done_callback(self._answering.discard)

    async def _answer(self, prompt: ev.Prompt, answer: Literal["yes", "no"]) -> None:
        try:
            await self._answer_prompt(prompt.dialogue, prompt.prompt, answer, self._name)
        except ConflictError as error:
            self._output.note(f"          Too late: {error}.")
