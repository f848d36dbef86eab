"""Which of three hypotheses the scans speak for, decided as soon as they speak clearly.

The multihypothesis sequential probability ratio test (Baum and Veeravalli 1994): the first whose
posterior passes a threshold is accepted.
"""

from dataclasses import dataclass, field
from enum import IntEnum
from typing import Self

import numpy as np
from numpy.typing import NDArray

Weights = NDArray[np.float64]


class Hypothesis(IntEnum):
    """Where the robot is."""

    OURS = 0
    THEIRS = 1
    NEITHER = 2
    """Somewhere else on the map, or nowhere on it."""


ERROR_PROBABILITY = 1e-3
"""How often an accepted hypothesis may be the wrong one, were the model exact."""
MOST_PER_SCAN = 2.0
"""Nats by which one scan may speak against a hypothesis, so that no single one ever decides."""
_AGREED_BEHIND = float(np.log(1.0 / ERROR_PROBABILITY))
"""Nats by which "neither" begins behind where the tracks agree: two are seldom wrong alike."""
_MOST_BEHIND = 2.0 * float(np.log(1.0 / ERROR_PROBABILITY))
"""Nats by which a hypothesis may fall behind, so that it is not ruled out for good."""


@dataclass(slots=True)
class Contest:
    """Log-weights of the hypotheses, the best at 0."""

    weights: Weights = field(default_factory=lambda: np.zeros(len(Hypothesis)))

    @classmethod
    def of_agreement(cls) -> Self:
        """A contest while both tracks are together."""
        return cls(np.array([0.0, 0.0, -_AGREED_BEHIND]))

    def weigh(self, log_likelihoods: Weights) -> None:
        """Take what one scan says of each hypothesis."""
        behind = np.maximum(log_likelihoods - log_likelihoods.max(), -MOST_PER_SCAN)
        weights = self.weights + behind
        self.weights = np.maximum(weights - weights.max(), -_MOST_BEHIND)

    def winner(self) -> Hypothesis | None:
        """The hypothesis that is accepted by now, if any."""
        posterior = np.exp(self.weights) / np.exp(self.weights).sum()
        best = int(posterior.argmax())
        return Hypothesis(best) if posterior[best] >= 1.0 - ERROR_PROBABILITY else None
