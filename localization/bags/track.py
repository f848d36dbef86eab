"""Poses over time, as messages give them: interpolated, or held until the next."""

from array import array
from dataclasses import dataclass, field
from enum import Enum
from typing import Self

import numpy as np
from numpy.typing import NDArray

from mend.localization.bags.rigid import Rigid

Stamps = NDArray[np.int64]
"""Nanoseconds, each as a header has it."""
_END_SLACK_NS = 200_000_000
"""So long before the first and after the last message its pose may still be taken."""


class Between(Enum):
    """Which pose counts between two messages, and before the first or after the last."""

    INTERPOLATED = "interpolated"
    """What moves; unknown outside."""
    HELD = "held"
    """As last told, until it is told anew; unknown before the first."""
    NEAREST = "nearest"
    """What hardly moves: interpolated, and outside as it was at the end."""


@dataclass(slots=True)
class TrackWriter:
    """Gathers a track's poses: 64 bytes each."""

    stamps: "array[int]" = field(default_factory=lambda: array("q"))
    values: "array[float]" = field(default_factory=lambda: array("d"))

    def add(self, stamp_ns: int, values: tuple[float, ...]) -> None:
        """One more pose, in any order."""
        self.stamps.append(stamp_ns)
        self.values.extend(values)


@dataclass(frozen=True, slots=True, eq=False)
class Track:
    """Transforms by ascending stamps."""

    stamps: Stamps
    transforms: Rigid

    @classmethod
    def of(cls, written: TrackWriter) -> Self:
        """What was gathered, put in order."""
        stamps = np.array(written.stamps, dtype=np.int64)
        order = np.argsort(stamps, kind="stable")
        return cls(stamps[order], np.array(written.values).reshape(-1, 7)[order])

    def __len__(self) -> int:
        return len(self.stamps)

    def at(self, stamps: Stamps, between: Between = Between.INTERPOLATED) -> Rigid:
        """The transforms (n, 7) at given stamps; NaN where unknown."""
        if not len(self):
            return np.full((len(stamps), 7), np.nan)
        if between is Between.HELD:
            return self._held_at(stamps)
        found = self._interpolated_at(stamps)
        if between is Between.INTERPOLATED:
            early = stamps < self.stamps[0] - _END_SLACK_NS
            late = stamps > self.stamps[-1] + _END_SLACK_NS
            found[early | late] = np.nan
        return found

    def _held_at(self, stamps: Stamps) -> Rigid:
        number = np.searchsorted(self.stamps, stamps, side="right") - 1
        found = np.full((len(stamps), 7), np.nan)
        known = number >= 0
        found[known] = self.transforms[number[known]]
        return found

    def _interpolated_at(self, stamps: Stamps) -> Rigid:
        after = np.clip(np.searchsorted(self.stamps, stamps), 0, len(self) - 1)
        before = np.where(self.stamps[after] > stamps, np.maximum(after - 1, 0), after)
        span = np.maximum(self.stamps[after] - self.stamps[before], 1)
        share = np.clip((stamps - self.stamps[before]) / span, 0.0, 1.0)[:, None]
        first, second = self.transforms[before], self.transforms[after].copy()
        # A quaternion and its opposite are the same rotation: take the shorter way.
        second[(first[:, 3:] * second[:, 3:]).sum(axis=1) < 0.0, 3:] *= -1.0
        between: Rigid = first * (1.0 - share) + second * share
        return between
