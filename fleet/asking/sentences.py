"""What somebody has said, as words: a quotation is one, and what is only polite is none."""

import re
from collections.abc import Sequence

from mend.documents.quotation_marks import plain_marks, single_marks

_BEFORE = (
    "please", "hello", "hey", "robot", "could you", "can you", "would you", "will you",
    "i want you to", "i need you to", "i would like you to", "you are to", "i am to",
)  # fmt: skip
_AFTER = ("please", "thanks", "thank you", "is that right")
_LONGEST_PHRASE = 5


def words_of(text: str) -> list[str]:
    """The words of a sentence. What stands between quotation marks is one word, with its marks."""
    plain = plain_marks("".join(each if each.isprintable() else " " for each in text))
    words = re.findall(r'"[^"]*"|[^\s"]+', plain)
    return _without_courtesies(words)


def _without_courtesies(words: list[str]) -> list[str]:
    shorter = _without_end(words)
    for length in range(1, _LONGEST_PHRASE + 1):
        if _plain(shorter[:length]) in _BEFORE:
            shorter = shorter[length:]
            break
    for length in range(1, _LONGEST_PHRASE):
        if _plain(shorter[-length:]) in _AFTER:
            shorter = shorter[:-length]
            break
    return shorter if shorter == words else _without_courtesies(shorter)


def _without_end(words: Sequence[str]) -> list[str]:
    """Without what ends a sentence."""
    if not words or words[-1].startswith('"') or words[-1].casefold() in ("a.m.", "p.m."):
        return list(words)
    last = words[-1].rstrip(".!?,;")
    return [*words[:-1], last] if last else list(words[:-1])


def _plain(words: Sequence[str]) -> str:
    return " ".join(each.casefold().strip(".,!?:;") for each in words)


def is_quoted(word: str) -> bool:
    """Whether a word is what somebody has quoted."""
    return word.startswith('"')


def free_text(words: Sequence[str]) -> str:
    """What is said, as it is kept: without the marks of a quotation."""
    if len(words) == 1 and is_quoted(words[0]):
        return words[0].strip('"').strip()
    return single_marks(" ".join(words)).strip(" ,:")


def quoted(text: str) -> str:
    """A text as a quotation that is one word again."""
    return f'"{text}"'
