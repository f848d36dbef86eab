"""The belief that the fingers hold what they are to hold, as log odds.

A binary Bayes filter (Thrun, Burgard & Fox, Probabilistic Robotics, 2005, ch. 4.2) over a state
that can change one way: what is held may get lost, what is lost does not come back by itself.
"""

import math

_LOST_PER_S = 0.02
"""How often something held gets lost, as the filter expects it."""

_MOST_LOG_ODDS = 7.0
"""Readings of one grasp are not independent: however many agree, they prove no more than this."""


class Belief:
    """Starts at even odds; `probability` is that of holding."""

    def __init__(self) -> None:
        self._log_odds = 0.0

    @property
    def probability(self) -> float:
        return 1.0 / (1.0 + math.exp(-self._log_odds))

    def predict(self, elapsed_s: float) -> None:
        """Time has passed in which it may have been lost."""
        kept = math.exp(-_LOST_PER_S * elapsed_s) * self.probability
        self._log_odds = math.log(kept / (1.0 - kept))

    def update(self, log_ratio: float) -> None:
        """Take a reading into account: log p(reading | held) - log p(reading | not held)."""
        log_odds = self._log_odds + log_ratio
        self._log_odds = min(max(log_odds, -_MOST_LOG_ODDS), _MOST_LOG_ODDS)
