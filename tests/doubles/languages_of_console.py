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


def pattern_of(key: str) -> str:
    pieces = re.split(r"\{(\w+)\}", key)
    any_clause = {"rest": ".+", "deed": ".+?"}
    fields = (any_clause.get(name, "[^,;:?!]{1,80}?") for name in pieces[1::2])
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
