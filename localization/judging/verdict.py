"""What is said of another localizer's track."""

from dataclasses import dataclass
from enum import StrEnum

from mend.localization.pose import Poses


class Standing(StrEnum):
    """How another localizer's pose stands at one step."""

    UNKNOWN = "unknown"
    """It has told no pose yet."""
    HOLDS = "holds"
    """It agrees with our track, or the scans speak for it."""
    OPEN = "open"
    """It disagrees with our track, and the scans do not yet say who is right."""
    LOST = "lost"
    """It disagrees with our track, and the scans speak clearly for ours."""
    NEITHER = "neither"
    """The scans speak for neither its pose nor ours."""


@dataclass(frozen=True, slots=True, eq=False)
class Moment:
    """One step of a judged drive; poses in the map's frame, metres by odometry from the start."""

    step: int
    time_s: float
    along_m: float
    ours: Poses
    theirs: Poses


@dataclass(frozen=True, slots=True, eq=False)
class Stretch:
    """A part of the way on which the other localizer was lost, or nobody can tell.

    `said` is where there was evidence enough, `until` is None where the drive ended first.
    `furthest_m` is how far apart the tracks were at most, `ours_matched` and `theirs_matched` which
    share of the returns the map foretold from either track.
    """

    standing: Standing
    since: Moment
    said: Moment
    until: Moment | None
    furthest_m: float
    ours_matched: float
    theirs_matched: float


@dataclass(frozen=True, slots=True, eq=False)
class Judgement:
    """A judged drive.

    `standings` has one for each step that was judged; `ours_corrected` are the steps at which the
    scans spoke for the other localizer against our track, which was then set to it.
    """

    stretches: tuple[Stretch, ...]
    standings: tuple[Standing, ...]
    ours: Poses
    theirs: Poses
    along_m: tuple[float, ...]
    times_s: tuple[float, ...]
    ours_corrected: tuple[int, ...]
    first_step: int = 0
    """Steps before it, at which the other had told no pose yet, are not judged."""

    @property
    def lost(self) -> tuple[Stretch, ...]:
        """Where the other localizer was lost."""
        return tuple(each for each in self.stretches if each.standing is Standing.LOST)

    @property
    def begins_s(self) -> float:
        """The time of the first step that was judged."""
        return self.times_s[0]

    def counts(self, standing: Standing) -> int:
        """At how many steps it stood like that."""
        return self.standings.count(standing)

    def metres_of(self, standing: Standing) -> float:
        """On how much of the way it stood like that, from each step to the next."""
        steps = zip(self.standings, self.along_m, self.along_m[1:], strict=False)
        return sum(now - before for stood, before, now in steps if stood is standing)
