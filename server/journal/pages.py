"""Pages of events, bounded by how long their JSON is as well as by how many they are."""

from collections.abc import Iterable
from typing import Any

PAGE_CHARS = 4 * 1024**2


def page_of(rows: Iterable[Any], body: int) -> list[Any]:
    """The first of the rows, at least one, with `PAGE_CHARS` characters in all at most.

    `body` is the column that has an event's JSON. No more rows are fetched than that takes.
    """
    page: list[Any] = []
    chars = 0
    for row in rows:
        # Where the file is damaged it may be no text.
        chars += len(str(row[body]))
        if page and chars > PAGE_CHARS:
            break
        page.append(row)
    return page
