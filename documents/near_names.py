"""What names there are, told to whoever has written one that there is not."""

from collections.abc import Iterable
from difflib import get_close_matches

from mend.documents.problem import list_names

_MOST_NEAR = 3
_MOST_COMPARED = 5000
"""Comparing takes time with each name."""
_LONGEST = 100


def names_near(wrong: str, names: Iterable[str]) -> str:
    """Up to three names that are near in spelling, quoted for a sentence; else those there are."""
    known = sorted(names)
    plain: dict[str, list[str]] = {}
    for each in known[:_MOST_COMPARED]:
        plain.setdefault(each.casefold(), []).append(each)
    near = get_close_matches(wrong[:_LONGEST].casefold(), plain, n=_MOST_NEAR)
    found = [name for each in near for name in plain[each]][:_MOST_NEAR]
    return ", ".join(f"'{each}'" for each in found) if found else list_names(known)
