"""Curves in joint space: smooth, and passing through given joint angles."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import make_interp_spline

from mend.robots.arm.motion.kinematics import Joints

_SAME = 1e-6
"""Parameters nearer than this are one knot."""

_SAMPLES_PER_KNOT = 8


class JointCurve:
    """A curve through joint angles, by a parameter in [0, `length`].

    Two knots make a straight line, more a polynomial spline (cubic from four on).
    """

    def __init__(self, knots: Sequence[Joints], parameters: Sequence[float] | None = None) -> None:
        """`parameters` of the knots rise from 0; without them, the parameter is the way of the
        joint that moves furthest between knots, in radians.

        Raises `ValueError` without a knot, or with another number of parameters.
        """
        if not len(knots) or (parameters is not None and len(parameters) != len(knots)):
            raise ValueError("a joint curve needs knots, and a parameter for each or for none")
        angles = np.array(knots, dtype=np.float64)
        if parameters is None:
            steps = np.abs(np.diff(angles, axis=0)).max(axis=1, initial=0.0)
            at = np.concatenate([[0.0], np.cumsum(steps)])
        else:
            at = np.array(parameters, dtype=np.float64)
        apart = np.concatenate([[True], np.diff(at) > _SAME])
        self._knots: NDArray[np.float64] = angles[apart]
        self._parameters: NDArray[np.float64] = at[apart]
        self.length = float(self._parameters[-1])
        self._spline = self._fit()
        self._slope: Any = None

    @property
    def start(self) -> Joints:
        return np.asarray(self._knots[0])

    @property
    def end(self) -> Joints:
        return np.asarray(self._knots[-1])

    def at(self, parameter: float) -> Joints:
        """The joint angles at a parameter."""
        return np.asarray(self._spline(parameter))

    def along(self, parameters: Sequence[float] | NDArray[np.float64]) -> list[Joints]:
        """The joint angles at several parameters."""
        return list(np.asarray(self._spline(np.asarray(parameters))))

    def slope(self, parameter: float) -> Joints:
        """The derivative of the joint angles by the parameter."""
        if self._slope is None:
            # Of most curves that a plan tries nobody asks for it.
            self._slope = self._spline.derivative()
        return np.asarray(self._slope(parameter))

    def steepest(self, order: int) -> float:
        """The largest derivative of this order (1 to 3) of any joint, anywhere on the curve."""
        if order > self._spline.k:
            return 0.0
        derivative = self._spline.derivative(order)
        return float(np.abs(derivative(self._samples())).max())

    def joined_from(self, joints: Joints) -> "JointCurve":
        """What is left of the curve for an arm at `joints`, starting exactly there."""
        samples = self._samples()
        distances = np.abs(self._spline(samples) - joints).max(axis=1)
        nearest = samples[int(distances.argmin())]
        left = self._parameters > nearest + _SAME
        if not left.any():
            return JointCurve([joints, self.end])
        parameters = self._parameters[left] - nearest
        return JointCurve([joints, *self._knots[left]], [0.0, *parameters])

    def _fit(self) -> Any:
        if len(self._knots) == 1:
            return make_interp_spline([0.0, 1.0], np.repeat(self._knots, 2, axis=0), k=1)
        order = min(3, len(self._knots) - 1)
        return make_interp_spline(self._parameters, self._knots, k=order)

    def _samples(self) -> NDArray[np.float64]:
        return np.linspace(0.0, self.length, _SAMPLES_PER_KNOT * len(self._knots) + 1)
