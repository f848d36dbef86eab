"""What a command prints of a run: each event as a JSON line, or a transcript to follow live."""

import sys
from typing import Protocol, TextIO

from rich.console import Console
from rich.text import Text

from mend.server.journal.events import Event
from mend.server.plain_text import plain
from mend.server.transcript import Transcript
from mend.server.transcript_line import Line, Tone

STYLES: dict[Tone, str] = {
    Tone.RUN: "bold",
    Tone.CHOICE: "bold",
    Tone.STEP: "dim",
    Tone.FAULT: "bold red",
    Tone.SAID: "cyan",
    Tone.ASKED: "bold cyan",
    Tone.ANSWERED: "bold magenta",
    Tone.WATCHED: "dim",
    Tone.DEED: "magenta",
    Tone.RESOLVED: "green",
    Tone.DONE: "green",
    Tone.SETBACK: "yellow",
    Tone.FINISHED: "bold green",
    Tone.FAILED: "bold red",
}
TIME_WIDTH = 8
INDENT = TIME_WIDTH + 2


class EventOutput(Protocol):
    """Takes the events of one run, in order."""

    def show(self, event: Event) -> None: ...

    def note(self, text: str) -> None:
        """Say something that is not of the run itself."""
        ...

    def close(self) -> None:
        """Nothing more comes."""
        ...


class JsonLines:
    """Every event as one JSON line on stdout, and nothing else there."""

    def __init__(self, stdout: TextIO | None = None, stderr: TextIO | None = None) -> None:
        self._stdout = stdout or sys.stdout
        self._stderr = stderr or sys.stderr

    def show(self, event: Event) -> None:
        self._stdout.write(event.model_dump_json() + "\n")
        self._stdout.flush()

    def note(self, text: str) -> None:
        self._stderr.write(text + "\n")

    def close(self) -> None:
        """Nothing is left unfinished."""


class LiveTranscript:
    """The transcript as it comes: steps follow each other on one line; colours in a terminal."""

    def __init__(self, console: Console | None = None) -> None:
        self._console = console or Console(highlight=False, soft_wrap=True)
        self._transcript = Transcript()
        self._thread: str | None = None
        self._column = 0

    def show(self, event: Event) -> None:
        for line in self._transcript.lines(event):
            if self._thread is not None and line.thread == self._thread:
                self._join(line)
            else:
                self.close()
                self._begin(line)

    def _begin(self, line: Line) -> None:
        style = STYLES[line.tone]
        text = Text.assemble(
            (f"{line.time_s:{TIME_WIDTH}.1f}  ", "dim"),
            (plain(line.opening), style),
            (plain(line.text), style),
        )
        self._thread = line.thread
        self._column = len(text)
        self._print(text, end="" if line.thread else "\n")

    def _join(self, line: Line) -> None:
        text = f" · {plain(line.text)}"
        if self._console.is_terminal and self._column + len(text) >= self._console.width:
            text = f"\n{' ' * INDENT}{plain(line.text)}"
            self._column = 0
        self._column += len(text)
        self._print(Text(text, STYLES[line.tone]), end="")

    def note(self, text: str) -> None:
        self.close()
        self._print(Text(text), end="\n")

    def close(self) -> None:
        """End the line under way."""
        if self._thread is not None:
            self._print(Text(), end="\n")
            self._thread = None

    def _print(self, text: Text, end: str) -> None:
        self._console.print(text, end=end)
        self._console.file.flush()
