"""Logs made worse on purpose: fewer scans, fewer beams, wheels of the wrong size."""

from dataclasses import dataclass, replace

import numpy as np

from mend.localization.logs.log import Log, LogStep
from mend.localization.pose import compose
from mend.localization.scan import Scan


@dataclass(frozen=True, slots=True)
class Harder:
    """Every so-manieth scan and beam, and odometry that tells so many times the motion.

    Raises `ValueError` where a number makes no sense.
    """

    every: int = 1
    beams_every: int = 1
    odometry: float = 1.0

    def __post_init__(self) -> None:
        if self.every < 1 or self.beams_every < 1 or not self.odometry > 0.0:
            raise ValueError(
                f"scans and beams are counted from 1 and odometry is told more than 0 times, not "
                f"{self.every}, {self.beams_every} and {self.odometry:g}"
            )

    def made_of(self, log: Log) -> Log:
        """The log with all of that done to it."""
        kept: list[LogStep] = []
        pending = np.zeros(3)
        for number, step in enumerate(log.steps):
            pending = compose(pending, self.odometry * step.odometry)
            if number % self.every == 0:
                kept.append(LogStep(pending, self._scan(step.scan), step.reference))
                pending = np.zeros(3)
        return replace(log, steps=tuple(kept))

    def _scan(self, scan: Scan) -> Scan:
        return replace(
            scan,
            ranges=scan.ranges[:: self.beams_every],
            angle_increment=scan.angle_increment * self.beams_every,
        )
