"""How much of what is drawn or repeated a test does: a sample, or everything."""

import os
from typing import TypeVar

EVERYTHING = "TEST_EVERYTHING"
"""The environment variable with which `benchmarks/whole_samples.py` asks for everything."""

T = TypeVar("T")


def sample(few: T, everything: T) -> T:
    """What a test is to do: in the suite `few`, of which `everything` is done in the benchmarks."""
    return everything if os.environ.get(EVERYTHING) == "1" else few
