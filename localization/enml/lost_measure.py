"""How probable it is that a robot is no longer where it is followed: a change, soon noticed.

Shiryaev (1963), "On optimum methods in quickest detection problems": the odds of having been
carried are those of before, and the prior's for the way driven since, times how much likelier what
is seen now is for a robot that may be anywhere than for one that was followed rightly.
"""

from math import exp

from mend.localization.enml.parameters import EnmlParameters

_MOST_ODDS = 1e6


class LostMeasure:
    """The probability that the robot has been carried, scan by scan."""

    def __init__(self, parameters: EnmlParameters) -> None:
        self._parameters = parameters
        self._odds = 0.0

    @property
    def probability(self) -> float:
        """From 0 (where it is followed) to 1 (elsewhere)."""
        return self._odds / (1.0 + self._odds)

    def begin(self, probability: float = 0.0) -> None:
        """Anew, with a probability below 1 that the place is not the right one."""
        self._odds = probability / (1.0 - probability)

    def weigh(self, driven_m: float, against: float) -> None:
        """One more scan, after driving so far: `against` is the log-likelihood ratio.

        Scans from hardly different places say nearly the same again, and count by how far apart
        they are; none counts for more than the parameters say.
        """
        its = self._parameters
        told = min(max(against, -its.scan_tells_at_most), its.scan_tells_at_most)
        told *= min(driven_m / its.news_after_m, 1.0)
        self._odds = min((self._odds + its.carried_per_m * driven_m) * exp(told), _MOST_ODDS)
