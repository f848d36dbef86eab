"""What a person can say to a question that has several ways of help. English only.

It is heard with a vocabulary of its own: what is said to a plain yes/no question is recognized as
before.
"""

from collections.abc import Mapping

from mend.server.speech.commands import AMBIGUOUS, PHRASES, Command

_NOT_NOW = (
    "not now", "no not now", "not right now", "no not right now", "not today", "no not today",
    "not at the moment", "no not at the moment",
)  # fmt: skip
"""To a plain question each of them is a no."""
_LEAVE_IT = ("leave it", "no leave it", "no leave it alone")
"""Nobody can tell by ear whether `out` follows."""

WAY_PHRASES: Mapping[Command, tuple[str, ...]] = {
    **PHRASES,
    Command.NO: tuple(
        each for each in PHRASES[Command.NO] if each not in (*_NOT_NOW, *_LEAVE_IT)
    ),
    Command.PLACE: (
        "i'll place it myself", "i will place it myself", "i'd place it myself",
        "i'll place it", "i will place it", "let me place it", "i'll put it there myself",
        "i will put it there myself", "no i'll place it myself", "no i will place it myself",
    ),
    Command.LEAVE_OUT: (
        "leave it out", "leave that out", "please leave it out", "just leave it out",
        "leave it out please", "no leave it out", "skip it", "please skip it", "just skip it",
        "go on without it", "do without it",
    ),
    Command.NOT_NOW: (*_NOT_NOW, "maybe later", "ask me later", "please ask me later"),
}  # fmt: skip

WAY_AMBIGUOUS: tuple[str, ...] = (*AMBIGUOUS, *_LEAVE_IT)
