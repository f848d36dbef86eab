"""Taking another way where one is barred, before people are asked."""

from collections.abc import Callable

from mend.robots.base.base import Base
from mend.robots.base.behaviors.behavior import Drive
from mend.robots.base.behaviors.progress import BaseProgress
from mend.robots.execution.command_error import CommandError
from mend.robots.link.messages import Detection, ReportBody, WayFound

ASKS_BEYOND_S = 60.0
"""A way round that takes longer than this is not taken at once: people may be quicker."""


class GoingRound:
    """Takes the way round of the drive under way; what it has found is reported."""

    def __init__(
        self, base: Base, progress: BaseProgress, report: Callable[[ReportBody], None]
    ) -> None:
        self._base, self._progress, self._report = base, progress, report
        self.times = 0
        """How often another way was taken."""

    def copes_with(self, issue: str, detection: Detection) -> bool:
        """Whether another way is taken, so that nobody need be asked about an issue."""
        drive = self._progress.taken
        if len(detection.between) != 2 or not isinstance(drive, Drive):
            return False
        origin, beyond = detection.between
        self._base.bar((origin, beyond))
        try:
            if self._base.round_takes_s(drive.to) > ASKS_BEYOND_S:
                return False
            self._base.start(drive.to, drive.speed)
        except CommandError:
            return False
        self.times += 1
        self._progress.blocked_since_s, self._progress.stalled_s = None, 0.0
        self._report(WayFound(finding=issue, between=[origin, beyond]))
        return True

    def patience_s(self) -> float:
        """How much longer a way round may take now: as long as it has stood, at least."""
        since_s = self._progress.blocked_since_s
        waited_s = 0.0 if since_s is None else self._base.body.time_s() - since_s
        return max(ASKS_BEYOND_S, waited_s)
