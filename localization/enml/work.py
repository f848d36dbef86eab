"""Work that is done a little at a time, so that nothing has to wait for all of it."""

from collections.abc import Generator, Iterator
from typing import TypeVar

Result = TypeVar("Result")

Work = Generator[None, None, Result]
"""Yields after each piece of some milliseconds, and returns what came out at last."""


def pieces(count: int, most: int) -> Iterator[slice]:
    """So many things, at most `most` (at least one) at a time."""
    size = max(most, 1)
    for start in range(0, count, size):
        yield slice(start, min(start + size, count))


def done(work: Work[Result]) -> Result:
    """What comes out of work that is done at once."""
    while True:
        try:
            next(work)
        except StopIteration as ended:
            result: Result = ended.value
            return result
