"""A recorded drive: motions, scans, and reference poses where somebody knows them."""

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from mend.localization.pose import Poses, compose
from mend.localization.scan import Scan


@dataclass(frozen=True, slots=True, eq=False)
class LogStep:
    """One scan, the motion since the last (robot's frame), and the reference pose (map's frame)."""

    odometry: Poses
    scan: Scan
    reference: Poses | None = None


class RecordedDrive(Protocol):
    """What can be followed step by step, whether it is in memory or read as it is walked."""

    @property
    def name(self) -> str: ...

    @property
    def steps(self) -> Iterable[LogStep]:
        """The steps in their order. Raises `WrongInputError` where they cannot be read."""
        ...

    @property
    def skipped(self) -> int:
        """How many scans could not be used."""
        ...

    @property
    def start(self) -> Poses | None:
        """The first reference pose."""
        ...

    @property
    def references(self) -> Poses:
        """The reference pose of each step, NaN where there is none."""
        ...

    def __len__(self) -> int: ...

    def path_m(self) -> float:
        """How far the robot drove."""
        ...


@dataclass(frozen=True, slots=True, eq=False)
class Log:
    """The steps of a drive in their order; `skipped` lines of its file could not be used."""

    name: str
    steps: tuple[LogStep, ...]
    skipped: int = 0

    def __len__(self) -> int:
        return len(self.steps)

    @property
    def start(self) -> Poses | None:
        """The first reference pose."""
        return self.steps[0].reference if self.steps else None

    @property
    def references(self) -> Poses:
        """The reference pose of each step, NaN where there is none."""
        unknown = np.full(3, np.nan)
        return np.array(
            [unknown if each.reference is None else each.reference for each in self.steps]
        )

    def path_m(self) -> float:
        """How far the robot drove: along the references where all are known, else by odometry."""
        references = self.references
        if len(self.steps) and np.isfinite(references).all():
            return float(np.hypot(*np.diff(references[:, :2], axis=0).T).sum())
        return float(sum(np.hypot(each.odometry[0], each.odometry[1]) for each in self.steps))


def with_equal_beams(steps: Sequence[LogStep]) -> tuple[LogStep, ...]:
    """Leave out scans that have not as many beams as most, and keep their motions."""
    usual = Counter(len(each.scan.ranges) for each in steps).most_common(1)[0][0]
    kept: list[LogStep] = []
    pending = np.zeros(3)
    for step in steps:
        pending = compose(pending, step.odometry)
        if len(step.scan.ranges) == usual:
            kept.append(LogStep(pending, step.scan, step.reference))
            pending = np.zeros(3)
    return tuple(kept)
