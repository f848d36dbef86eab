"""What pydantic found wrong with what a client sent, as sentences."""

from collections.abc import Mapping, Sequence
from typing import Any

from mend.documents.plain_mistakes import what_it_must_be
from mend.documents.unit import unit_of_name
from mend.documents.validation import what_is_right

MOST_TOLD = 100
"""So many values that are wrong are told; whoever mends them hears of the next ones."""

KEY_CHARS = 100
"""Of a longer key only the beginning is told."""


def validation_sentences(errors: Sequence[Any], body: object = None) -> list[str]:
    """One sentence per value that pydantic found wrong: where it is, and what would be right.

    `body` is what was sent, where that is known. After the first 100 only that there are more.
    """
    wrong: dict[tuple[int | str, ...], list[Any]] = {}
    for each in errors:
        where = _where(each, body)
        if where not in wrong and len(wrong) == MOST_TOLD:
            return [*_sentences(wrong), "there are more mistakes"]
        wrong.setdefault(where, []).append(each)
    return _sentences(wrong)


def _sentences(wrong: Mapping[tuple[int | str, ...], Sequence[Any]]) -> list[str]:
    return [
        f"{'.'.join(str(each)[:KEY_CHARS] for each in where) or 'body'}: "
        f"{_what_is_wrong(where, mistakes)}"
        for where, mistakes in wrong.items()
    ]


def _where(mistake: Any, body: Any) -> tuple[int | str, ...]:
    """The keys to a value; a value that may be of several types has one mistake for each."""
    loc: tuple[int | str, ...] = mistake["loc"]
    if mistake["type"] == "json_invalid":
        return loc[:1]
    if loc[:1] != ("body",) or mistake["type"] == "missing":
        return loc
    where = list(loc[:1])
    for step in loc[1:]:
        try:
            body = body[step]
        except (KeyError, IndexError, TypeError):
            continue  # It names the type that was tried, and no key.
        where.append(step)
    return tuple(where)


def _what_is_wrong(where: Sequence[int | str], mistakes: Sequence[Any]) -> str:
    first = mistakes[0]
    match first["type"]:
        case "missing" | "extra_forbidden" | "value_error" | "json_invalid":
            return what_it_must_be(first)
        case "model_attributes_type" if isinstance(first["input"], bytes):
            return "must be JSON that is sent with 'Content-Type: application/json'"
    return what_is_right(mistakes, unit_of_name(where))
