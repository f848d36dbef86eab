"""A check of answers: what was wrong with a request is told in nobody's jargon."""

import re
from typing import Any

JARGON = re.compile(r"\b(Input|String|List|Value) should\b|Value error|Unable to|String pattern")


def told_plainly(_context: Any, response: Any, _case: Any) -> None:
    """Raises `AssertionError` for a sentence in the words of the library that checks requests."""
    if response.status_code != 422:
        return
    refusal = response.json()
    for sentence in [refusal["detail"], *refusal.get("errors", [])]:
        told = sentence.split(", but it is ")[0]
        assert not JARGON.search(told), sentence
