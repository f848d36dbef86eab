"""How often a process looks for garbage."""

import gc
from collections.abc import Iterator

import pytest

from mend.garbage import look_for_garbage_seldom


@pytest.fixture
def collections() -> Iterator[list[int]]:
    """The generations that are looked through from now on."""
    seen: list[int] = []
    before = gc.get_threshold()

    def note(phase: str, of: dict[str, int]) -> None:
        if phase == "start":
            seen.append(of["generation"])

    gc.callbacks.append(note)
    yield seen
    gc.callbacks.remove(note)
    gc.set_threshold(*before)


def test_what_is_loaded_and_stays_is_hardly_ever_looked_through(collections: list[int]) -> None:
    look_for_garbage_seldom()
    kept = [[each] for each in range(100_000)]
    assert len(kept) == 100_000
    assert 1 <= len(collections) <= 3


def test_what_is_garbage_is_still_found(collections: list[int]) -> None:
    look_for_garbage_seldom()
    for _ in range(60_000):
        ring: list[object] = []
        ring.append(ring)
    assert collections
