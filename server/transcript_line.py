"""A line of a transcript, and which lines belong together."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import StrEnum


class Tone(StrEnum):
    """What kind of news a line brings; a terminal or a page gives each its own look."""

    RUN = "run"
    CHOICE = "choice"
    STEP = "step"
    FAULT = "fault"
    SAID = "said"
    ASKED = "asked"
    ANSWERED = "answered"
    WATCHED = "watched"
    DEED = "deed"
    RESOLVED = "resolved"
    DONE = "done"
    SETBACK = "setback"
    FINISHED = "finished"
    FAILED = "failed"


SPOKEN = frozenset({Tone.SAID, Tone.ASKED, Tone.ANSWERED, Tone.STEP})
"""The tones of lines that quote their speaker; a behavior speaks through its steps."""


@dataclass(frozen=True, slots=True)
class Line:
    """One line: when (seconds of the run's clock), who acts or speaks (if anybody), what.

    Lines that follow each other with the same `thread` may be joined to one; None is never joined.
    """

    time_s: float
    speaker: str
    text: str
    tone: Tone
    thread: str | None = None

    @property
    def opening(self) -> str:
        """What stands before the text: `robot: ` before what is said, `robot ` before deeds."""
        if not self.speaker:
            return ""
        return f"{self.speaker}: " if self.tone in SPOKEN else f"{self.speaker} "


def grouped(lines: Iterable[Line]) -> Iterator[list[Line]]:
    """The lines in the groups in which they may be joined, most of them of one line."""
    group: list[Line] = []
    for line in lines:
        if group and (line.thread is None or line.thread != group[-1].thread):
            yield group
            group = []
        group.append(line)
    if group:
        yield group
