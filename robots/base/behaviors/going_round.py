"""Taking another way where one is barred, or letting another robot go, before people are asked."""

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
        self._told: dict[tuple[str, str], float] = {}
        """Since when others know of what bars the way for which people are to be asked."""

    def copes_with(self, issue: str, detection: Detection) -> bool:
        """Whether another way is taken, or another robot may still go instead, so that nobody need
        be asked about an issue yet."""
        drive = self._progress.taken
        if len(detection.between) != 2 or not isinstance(drive, Drive):
            return False
        origin, beyond = detection.between
        self._base.bar((origin, beyond))
        if not self._goes_round(drive):
            return self._others_may_go(issue, (origin, beyond))
        self.times += 1
        self._progress.blocked_since_s, self._progress.stalled_s = None, 0.0
        self._report(WayFound(finding=issue, between=[origin, beyond]))
        return True

    def _goes_round(self, drive: Drive) -> bool:
        try:
            if self._base.round_takes_s(drive.to) > ASKS_BEYOND_S:
                return False
            self._base.start(drive.to, drive.speed)
        except CommandError:
            return False
        return True

    def _others_may_go(self, issue: str, between: tuple[str, str]) -> bool:
        """Whether others have not known for long enough yet that its way is barred here."""
        if self._base.asks_after_s <= 0.0:
            return False
        now_s = self._base.body.time_s()
        if between not in self._told:
            self._told[between] = now_s
            self._report(WayFound(finding=issue, between=[*between]))
        return now_s < self._told[between] + self._base.asks_after_s

    def patience_s(self) -> float:
        """How much longer a way round may take now: as long as it has stood, at least."""
        since_s = self._progress.blocked_since_s
        waited_s = 0.0 if since_s is None else self._base.body.time_s() - since_s
        return max(ASKS_BEYOND_S, waited_s)
