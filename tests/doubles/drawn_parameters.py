"""Of what a test is told to do one by one, the suite draws some anew each time."""

import random
from collections.abc import Sequence

import pytest
from sampled import sample

MARKER = "drawn"


def left_out(items: Sequence[pytest.Item], seed: int) -> set[pytest.Item]:
    """What is not drawn with this seed of the tests that are marked; in the benchmarks nothing."""
    marked: dict[str, list[pytest.Item]] = {}
    for item in items:
        if item.get_closest_marker(MARKER) is not None:
            marked.setdefault(item.nodeid.partition("[")[0], []).append(item)
    return {each for name, alike in marked.items() for each in _left_out(name, alike, seed)}


def _left_out(name: str, alike: list[pytest.Item], seed: int) -> list[pytest.Item]:
    marker = alike[0].get_closest_marker(MARKER)
    assert marker is not None, "they were found by it"
    few = sample(int(marker.args[0]), len(alike))
    # Every process is to draw the same, in whichever order it has them.
    alike = sorted(alike, key=lambda each: each.nodeid)
    return random.Random(f"{seed} {name}").sample(alike, max(0, len(alike) - few))
