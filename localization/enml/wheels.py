"""Wheels of another size than they are taken for: how much longer or shorter the true ways are.

The scales of translation and of rotation are states beside the poses, and learned on the way
(Martinelli, Tomatis and Siegwart 2007, "Simultaneous localization and odometry self calibration
for mobile robot"), here from what a step was corrected by.
"""

from typing import NamedTuple

import numpy as np

from mend.localization.enml.motion_model import Travel
from mend.localization.enml.parameters import EnmlParameters
from mend.localization.enml.problem import Floats
from mend.localization.pose import Poses, relative, wrap_angle

_LEAST, _MOST = 0.7, 1.4
"""Wheels that are farther off than this are broken, not worn."""
_REMEMBERED_M = 100.0
"""What was learned that long ago counts for a third: loads come and go, and tyres wear."""


class Step(NamedTuple):
    """The way from one pose to the next, as odometry tells it, and where both were found."""

    travel: Travel
    before: Poses
    after: Poses
    covariance: Floats
    """Of both poses together (6, 6)."""


class Wheels:
    """The scales of one robot's odometry: what it tells, times these, is how it moved."""

    def __init__(self, parameters: EnmlParameters) -> None:
        self._parameters = parameters
        rates = np.array([parameters.odometry_rate, parameters.odometry_angular_rate])
        self._prior = np.diag(rates**-2)
        self._information = self._prior
        self._scales = np.ones(2)

    @property
    def scales(self) -> Floats:
        """Of ways and of turns."""
        return self._scales.copy()

    def corrected(self, motion: Poses) -> Poses:
        """A motion as it was, by one that odometry tells."""
        return np.asarray(motion * self._scales[[0, 0, 1]])

    def learn(self, step: Step) -> None:
        """Take in one step, of a motion that has been corrected.

        Where it led was found by odometry, too: only what that does not explain is news, the Schur
        complement of the scales among all that was estimated.
        """
        motion = step.travel.motion
        found = relative(step.before, step.after)
        off = found - motion
        off[2] = wrap_angle(off[2])
        trust = _trust(step.travel, off, self._parameters)
        slope = _slope_of_relative(step.before, found)
        told = trust - trust @ slope @ step.covariance @ slope.T @ trust
        by_scale = np.zeros((3, 2))
        by_scale[:2, 0] = motion[:2] / self._scales[0]
        by_scale[2, 1] = motion[2] / self._scales[1]
        fresh = min(step.travel.path_m / _REMEMBERED_M, 1.0)
        known = (1.0 - fresh) * self._information + fresh * self._prior
        self._information = known + by_scale.T @ (told + told.T) @ by_scale / 2.0
        change = np.linalg.solve(self._information, by_scale.T @ trust @ off)
        self._scales = np.clip(self._scales + change, _LEAST, _MOST)


def _trust(travel: Travel, off: Poses, parameters: EnmlParameters) -> Floats:
    """The information (3, 3) in a motion that is off by so much: less where the wheels slip."""
    whitening = travel.whitening(parameters)
    excess = float(np.sum((whitening @ off) ** 2)) / parameters.odometry_robust_width**2
    return np.asarray(whitening.T @ whitening / (1.0 + excess))


def _slope_of_relative(base: Poses, seen: Poses) -> Floats:
    """The derivative (3, 6) of a pose as `seen` from another by both."""
    c, s = np.cos(base[2]), np.sin(base[2])
    return np.array(
        [
            [-c, -s, seen[1], c, s, 0.0],
            [s, -c, -seen[0], -s, c, 0.0],
            [0.0, 0.0, -1.0, 0.0, 0.0, 1.0],
        ]
    )
