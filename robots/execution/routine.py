"""Routines: what takes many control cycles."""

from collections.abc import Generator
from typing import TypeVar

T = TypeVar("T")

Routine = Generator[None, None, T]
"""Each `yield` lets one control cycle pass. Whoever drops one before its end stops the body."""
