"""How much changes from scan to scan where nobody is carried: learned on the way."""

from math import exp, lgamma, log, log1p, pi

from mend.localization.enml.parameters import EnmlParameters

_LEAST_SPREAD = 0.05
"""Where nothing ever changes a little does, and who was carried recognizes a little more than has
changed: points are few."""
_SURPRISES, _SURPRISE_SPREAD = 0.017, 0.5
"""So often more changes than usual, half-normal with this scale: somebody steps by, or a chair is
moved (ours: among fhw's crowd 1.4 % of scans by more than 0.5 and 0.2 % by more than 0.7; in 14
other drives at most 0.3 % by more than either)."""
_HALF_NORMAL = (2.0 / pi) ** 0.5
_FIRST_SCANS = 8.0
"""What the parameters say of it counts for so many scans."""
_MOST_DEVIATIONS = 2.5
"""What is farther from the mean is learned as if it were so far, as one scan proves little."""


class UsualChange:
    """Shares that change, less what is recognized, as normal of unknown mean and variance.

    How likely the next one is follows a t distribution (Gelman et al., "Bayesian Data Analysis",
    section 3.2), of all before it, the latest more, but for a few surprises. So a change is judged
    by what is usual around the robot: crowds and bushes are other than walls (Lorden and Pollak
    2005, "Nonanticipating estimation applied to sequential analysis and changepoint detection").
    Outliers are learned in part (Huber 1964, "Robust estimation of a location parameter").
    """

    def __init__(self, parameters: EnmlParameters) -> None:
        self._parameters = its = parameters
        self._mean = -its.recognized_share
        self._variance = its.recognized_spread**2
        self._scans = _FIRST_SCANS

    def learn(self, change: float, weight: float) -> None:
        """Take in one more change, as `weight` (0 to 1) scans of which it is known."""
        if weight <= 0.0:
            return
        self._scans = self._scans * (1.0 - weight / self._parameters.max_episode_length) + weight
        part = weight / self._scans
        most = _MOST_DEVIATIONS * self._variance**0.5
        off = min(max(change - self._mean, -most), most)
        variance = (1.0 - part) * (self._variance + part * off**2)
        self._variance = max(variance, _LEAST_SPREAD**2)
        self._mean += part * off

    def log_density(self, change: float) -> float:
        """Of a change, for who is not carried."""
        degrees = self._scans
        scale = self._variance * (1.0 + 1.0 / self._scans)
        norm = lgamma((degrees + 1.0) / 2.0) - lgamma(degrees / 2.0)
        off = change - self._mean
        told = norm - 0.5 * log(degrees * pi * scale)
        told -= 0.5 * (degrees + 1.0) * log1p(off**2 / (degrees * scale))
        more = max(off, 0.0) / _SURPRISE_SPREAD
        surprise = _HALF_NORMAL / _SURPRISE_SPREAD * exp(-0.5 * more**2)
        return log((1.0 - _SURPRISES) * exp(told) + _SURPRISES * surprise)


def log_density_of_carried(change: float) -> float:
    """Of a change, for who was carried: all of it, or less, is as likely as any other."""
    return min(change / _LEAST_SPREAD, 0.0)
