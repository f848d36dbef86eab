"""How far odometry can be trusted."""

import numpy as np
from numpy.typing import NDArray

from mend.localization.enml.parameters import EnmlParameters
from mend.localization.pose import Poses, compose


class Travel:
    """The motion measured since some pose, in that pose's frame, and how uncertain it is."""

    __slots__ = ("_whitening", "motion", "path_m", "turned_rad")

    def __init__(self) -> None:
        self.motion: Poses = np.zeros(3)
        self.path_m = 0.0
        self.turned_rad = 0.0
        self._whitening: NDArray[np.float64] | None = None

    def add(self, step: Poses) -> None:
        """Append a motion, in the frame of where the last one led."""
        self.motion = compose(self.motion, step)
        self.path_m += float(np.hypot(step[0], step[1]))
        self.turned_rad += abs(float(step[2]))
        self._whitening = None

    def deviations(self, parameters: EnmlParameters) -> Poses:
        """Standard deviations along and across the motion (metres) and of the heading (radians)."""
        its = parameters
        # However short, it is trusted no more than if it were a step of the episode longer.
        path_m = self.path_m + its.min_translation_m
        turned_rad = self.turned_rad + its.min_rotation_rad
        aside_m = its.odometry_rate * path_m
        turned_off = its.odometry_angular_rate * turned_rad + its.odometry_drift_rad_per_m * path_m
        return np.array([aside_m, aside_m, turned_off])

    def whitening(self, parameters: EnmlParameters) -> NDArray[np.float64]:
        """The matrix (3, 3) that turns the motion's error into independent unit variances."""
        if self._whitening is None:
            along = np.arctan2(self.motion[1], self.motion[0])
            c, s = np.cos(along), np.sin(along)
            to_motion = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
            self._whitening = np.asarray(to_motion / self.deviations(parameters)[:, None])
        return self._whitening
