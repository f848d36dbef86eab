"""The port for what turns the sound of an utterance into words, and what it tells of them."""

from dataclasses import dataclass
from typing import Protocol

from mend.server.speech.commands import Command


@dataclass(frozen=True, slots=True)
class Hypothesis:
    """What an utterance probably was.

    `words` is empty where there were none. `command` is set where they are nothing but one
    command, and `margin` then says by how much (in PocketSphinx's scaled logarithms) it is ahead
    of whatever else they may have been; infinite where a decoder tells one reading alone.
    """

    words: str
    command: Command | None = None
    phrase: str | None = None
    margin: float = 0.0


class Decoder(Protocol):
    """What turns the sound of one utterance after the other into words."""

    def begin(self) -> None:
        """A new utterance; one that was not ended is forgotten."""
        ...

    def take(self, sound: bytes) -> None:
        """Take the next piece of the utterance."""
        ...

    def end(self) -> Hypothesis:
        """The utterance is over: what was it?"""
        ...
