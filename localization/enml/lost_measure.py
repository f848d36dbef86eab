"""How probable it is that a robot is no longer where it is followed: a change, soon noticed.

Shiryaev (1963), "On optimum methods in quickest detection problems": the odds of having been
carried are those of before, and the prior's for the way driven since, times how much likelier what
is seen now is for a robot that may be anywhere than for one that was followed rightly.
"""

from math import exp

from mend.localization.enml.change import Comparison
from mend.localization.enml.parameters import EnmlParameters

_MOST_ODDS = 1e6
LOST_ABOVE = 0.5
"""A robot says that it is lost where that is more probable than not."""


class LostMeasure:
    """The probability that the robot has been carried, or drifted off, scan by scan.

    That a scan looks familiar speaks against having been carried since the one that it is compared
    with, and says nothing of before: who was carried earlier sees the same things again, too.
    """

    def __init__(self, parameters: EnmlParameters) -> None:
        self._parameters = parameters
        self.begin()

    @property
    def probability(self) -> float:
        """From 0 (where it is followed) to 1 (elsewhere)."""
        odds = self._before + self._since
        return odds / (1.0 + odds)

    @property
    def is_by_map(self) -> bool:
        """Whether most of what speaks against here is the map, and not that scans were strange."""
        return 2.0 * self._by_map > self._before + self._since

    def begin(self, probability: float = 0.0) -> None:
        """Anew, with a probability below 1 that the place is not the right one."""
        self._before = self._by_map = probability / (1.0 - probability)
        self._since = 0.0

    def weigh(self, driven_m: float, beside: Comparison, elsewhere: float) -> None:
        """One more scan, after driving so far: log-likelihood ratios of what speaks against here.

        `beside`: what it shows beside an earlier scan; `elsewhere`: what the map shows. Scans from
        hardly different places say nearly the same again, and count by how far apart they are; none
        counts for more than the parameters say, of both together.
        """
        its = self._parameters
        news, most = min(driven_m / its.min_translation_m, 1.0), its.tells_at_most
        elsewhere = max(min(elsewhere, most), -its.fitting_tells_at_most)
        together = max(min(beside.strange + elsewhere, most), -most)
        if not beside.is_with_familiar:
            self._close()
        self._since += its.carried_per_m * driven_m
        self._by_map += its.carried_per_m * driven_m
        fits = exp(news * elsewhere)
        self._before = min(self._before * fits, _MOST_ODDS)
        self._by_map = min(self._by_map * fits, _MOST_ODDS)
        self._since = min(self._since * exp(news * together), _MOST_ODDS)
        if beside.strange <= 0.0:
            self._close()

    def _close(self) -> None:
        """What comes next says nothing of whether the robot was carried until now."""
        self._before, self._since = self._before + self._since, 0.0
