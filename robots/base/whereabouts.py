"""What a base knows of where it is, beyond its pose: whether it is lost, and where it may be."""

from collections.abc import Sequence
from typing import Protocol


class Whereabouts(Protocol):
    """How far a base may believe its pose."""

    @property
    def is_lost(self) -> bool:
        """Whether it does not know where it is."""
        ...

    @property
    def lost_s(self) -> float:
        """How long it has been lost; 0 while it is not."""
        ...

    def covariance(self) -> Sequence[float] | None:
        """How sure it is of its place along the axes of its map: xx, xy, yy (m2); None where that
        is not known.
        """
        ...

    def guesses(self) -> Sequence[str]:
        """Where it may be by what it sees, likeliest first: `at F1-101`, `near F1-101`."""
        ...

    def believe(self, guess: str) -> bool:
        """Somebody says that it is there: take it, if what it sees agrees; whether it does."""
        ...


class AlwaysKnown:
    """The whereabouts of a base that is never lost."""

    is_lost = False
    lost_s = 0.0

    def covariance(self) -> None:
        """None: it knows its place as exactly as it is told."""

    def guesses(self) -> Sequence[str]:
        """None: it knows."""
        return ()

    def believe(self, guess: str) -> bool:  # noqa: ARG002
        """It knows better."""
        return False
