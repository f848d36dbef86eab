"""Helpers of a shift who do not answer at once, for as long as anything has them be silent."""

from collections.abc import Awaitable, Callable
from typing import Literal


class Silence:
    """Several spans may overlap: people answer at once again when the last of them is over."""

    def __init__(self, have_answered: Callable[[Literal["late", "yes"]], Awaitable[None]]) -> None:
        """`have_answered`: how the questions of legs that begin from now on are answered."""
        self._have_answered = have_answered
        self._spans = 0

    async def begin(self) -> None:
        """From now on, until it has ended as often as it has begun."""
        self._spans += 1
        await self._have_answered("late")

    async def end(self) -> None:
        """One span is over."""
        self._spans -= 1
        if not self._spans:
            await self._have_answered("yes")
