"""Words of any script in names, which have Latin letters only, and back again.

A word of another script stands there in Punycode (RFC 3492), as in the names of hosts; what begins
with a digit has a beginning that nobody says.
"""

import re
import unicodedata
from collections.abc import Iterator

from mend.tasks.plain_letters import plain_letters

_MARK = "xn--"
_BEFORE_DIGIT = "q0--"
_IN_NAME = re.compile(rf"(?<![A-Za-z0-9]){_MARK}([a-z0-9]+)([_-](?=[A-Za-z0-9]))?")
_BEGINNING = re.compile(rf"(?<![\w-]){_BEFORE_DIGIT}(?=[0-9])")
_NO_WORD = re.compile(r"[^A-Za-z0-9]+")


def in_name(text: str, most: int) -> str:
    """As many words of a text as fit into so many characters of a name, joined by `_`."""
    name = ""
    for word in _words(text):
        longer = f"{name}_{word}" if name else _BEFORE_DIGIT + word if word[0].isdigit() else word
        if len(longer) > most and (name or word.startswith(_MARK)):
            # A part of a word that is written otherwise would be another one.
            return name if _MARK in longer else longer[:most].rstrip("_")
        name = longer
    return name[:most].rstrip("_")


def as_written(text: str) -> str:
    """A text with such names as they were written before."""
    return _IN_NAME.sub(_written, _BEGINNING.sub("", text))


def _written(found: re.Match[str]) -> str:
    try:
        word = found[1].encode("ascii").decode("punycode")
        return f"{word} " if found[2] else word
    except UnicodeError:
        return found[0]


def _words(text: str) -> Iterator[str]:
    """Each word, or what of it is of one script, as it stands in names."""
    latin = other = ""
    for each in [*unicodedata.normalize("NFC", text), " "]:
        if _is_other(each, bool(other)):
            yield from _latin(latin)
            latin, other = "", other + each
        else:
            if other:
                yield _MARK + other.encode("punycode").decode("ascii")
            latin, other = latin + each, ""
    yield from _latin(latin)


def _is_other(each: str, after_other: bool) -> bool:
    kind = unicodedata.category(each)[0]
    return (kind == "L" and not plain_letters(each).isascii()) or (kind == "M" and after_other)


def _latin(text: str) -> list[str]:
    return [each for each in _NO_WORD.split(plain_letters(text)) if each]
