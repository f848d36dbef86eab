"""What robots call the things that they bring, and what requests are called that nobody names."""

import re
from typing import TYPE_CHECKING
from zlib import crc32

from mend.dialogue.other_scripts import in_name
from mend.dialogue.spoken import NAMELESS
from mend.fleet.requests import Transport
from mend.tasks.plain_letters import plain_letters

if TYPE_CHECKING:
    from mend.fleet.dispatch.booking import AnyRequest

_ARTICLE = re.compile(r"^(the|a|an)\s+", re.IGNORECASE)
_NO_WORD = re.compile(r"[^A-Za-z0-9]+")
_MOST_OF_WHAT = 31
_MOST_OF_PLACE = 32
_POINTED_AT = frozenset(("this", "that", "it", "these", "those", "them"))
"""What only whoever stands before it knows."""
_MADE = re.compile(r"--[0-9a-f]{8}(/[0-9]+)?$")
"""Ends the name of a request that Mend or its console has made up: nobody knows it by that."""


def item_of(what: str, booking: str, origin: str = "") -> str:
    """What robots call a thing: as a person does, as far as names go, and each its own.

    What somebody has only pointed at is told from others by its `origin`, where it is fetched.
    """
    asked, mark = _plain(booking), f"{crc32(booking.encode()):08x}"
    if _is_pointed_at(what):
        place = in_name(origin, _MOST_OF_PLACE)
        return f"{NAMELESS}-{place}--{mark}" if place else f"{NAMELESS}--{mark}"
    words = _words(what) or "item"
    if words == asked == booking:
        return words
    if _MADE.search(booking) or f"_{asked}_" in f"_{words}_":
        # "The cup of tea tea" nobody would say: such a mark is not spoken.
        return f"{words}--{mark}"
    if asked != booking or len(asked) > _MOST_OF_WHAT:
        # Others may be called alike but for what names have not.
        return f"{words}-{asked[: _MOST_OF_WHAT - 10]}--{mark}"
    return f"{words}-{asked}"


def made_name(request: "AnyRequest", mark: str) -> str:
    """A name for what somebody asks for without one; `mark`: 8 digits that no other has."""
    words = ""
    if isinstance(request, Transport) and not _is_pointed_at(request.what):
        words = _words(request.what)
    return f"{words or request.kind}--{mark}"


def _is_pointed_at(what: str) -> bool:
    words = _plain(what).strip("_").casefold().split("_")
    return words[0] in _POINTED_AT and words[1:] in ([], ["one"], ["ones"], ["thing"], ["things"])


def _words(what: str) -> str:
    return in_name(_ARTICLE.sub("", what.strip()), _MOST_OF_WHAT)


def _plain(text: str) -> str:
    return _NO_WORD.sub("_", plain_letters(text))
