"""What the console can say in each of its languages, as it looks for it (`said.ts`)."""

import json
import re
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import pytest

TEXTS = Path(__file__).parents[2] / "web" / "texts"
LANGUAGES = sorted(each.name for each in TEXTS.iterdir())


def untold(sentences: Sequence[str], files: Iterable[str] = ("clauses",)) -> list[str]:
    """Those for which one of the `files` of a language has no text, once for each language."""
    missing = []
    for language in LANGUAGES:
        patterns = [
            re.compile(pattern_of(key), re.IGNORECASE)
            for file in files
            for key in json.loads((TEXTS / language / f"{file}.json").read_text())
        ]
        missing += [each for each in sentences if not any(p.fullmatch(each) for p in patterns)]
    return missing


def half_told(reasons: Sequence[str], typed: str = "") -> list[str]:
    """Those of which something, however deep in them, has no text in one of the languages.

    `typed`: what a person has said in words of their own.
    """
    found = []
    for language in LANGUAGES:
        keys = json.loads((TEXTS / language / "reasons.json").read_text())
        patterns = [
            re.compile(each, re.IGNORECASE)
            for each in [re.escape(typed), *(pattern_of(key, named=True) for key in keys)]
        ]
        found += [each for each in reasons if not _is_told(each, patterns)]
    return found


def _is_told(text: str, patterns: Sequence[re.Pattern[str]]) -> bool:
    fits = next((m for each in patterns if (m := each.fullmatch(text))), None)
    if fits is None:
        clauses = text.split("; ")
        return len(clauses) > 1 and all(_is_told(each, patterns) for each in clauses)
    within = fits.groupdict()
    clauses = [within[name] for name in ("rest", "deed") if name in within]
    clauses += within.get("list", "").split(", ") if "list" in within else []
    return all(_is_told(each, patterns) for each in clauses)


def pattern_of(key: str, *, named: bool = False) -> str:
    """`named`: its groups are called as its fields are."""
    pieces = re.split(r"\{(\w+)\}", key)
    any_clause = {"rest": ".+", "deed": ".+?", "list": "[^;:?!]+"}
    fields = [any_clause.get(name, "[^,;:?!]{1,80}?") for name in pieces[1::2]]
    if named:
        fields = [f"(?P<{n}>{each})" for n, each in zip(pieces[1::2], fields, strict=True)]
    escaped = map(re.escape, pieces[::2])
    return next(escaped) + "".join(
        field + text for field, text in zip(fields, escaped, strict=True)
    )


@contextmanager
def refused_in_every_language(
    kind: type[Exception], why: str
) -> Iterator[pytest.ExceptionInfo[Exception]]:
    """Like `pytest.raises`, of what any page but that of the questions tells."""
    with pytest.raises(kind, match=why) as caught:
        yield caught
    assert untold([str(caught.value)], ["clauses", "refusals"]) == []
