"""External joint torques from measured joint torques: the generalized-momentum observer.

De Luca & Mattone, "Actuator failure detection and isolation using generalized momenta" (ICRA
2003); Haddadin, De Luca & Albu-Schaeffer, "Robot Collisions: A Survey on Detection, Isolation, and
Identification" (IEEE T-RO 33(6), 2017), Section IV-D. It needs no acceleration: the residual
r = K (p - integral of (tau + C^T v - g + r)) follows the external torque like a first-order
filter with the rate K.
"""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]

_USUAL_FORCE_N = 1000.0
"""Far more than an arm ever feels: it only matters in directions that no joint feels."""

_KNOWN_BEFORE = np.eye(3) / _USUAL_FORCE_N**2


class ArmDynamics(Protocol):
    """The rigid-body model of an arm with n joints, at angles (rad) and velocities (rad/s)."""

    def momentum_and_drift(self, angles: Vector, velocities: Vector) -> tuple[Vector, Vector]:
        """The generalized momentum M(q) v (n), and C(q, v)^T v - g(q) (n), N m.

        The second is what changes the momentum but the joints' torques.
        """
        ...

    def tool_jacobian(self, angles: Vector) -> NDArray[np.float64]:
        """The tool point's linear velocity by joint velocities (3, n), base frame."""
        ...


class MomentumObserver:
    """Estimates the external torque on each joint, cycle by cycle."""

    def __init__(self, dynamics: ArmDynamics, rate_hz: float) -> None:
        """`rate_hz`: how fast the estimate follows, as the corner of its low-pass filter."""
        self._dynamics = dynamics
        self._gain = 2.0 * np.pi * rate_hz
        self._started_with: Vector | None = None
        self._integral: Vector = np.zeros(0)
        self.residual: Vector = np.zeros(0)
        """The external torques, N m (n)."""

    def reset(self) -> None:
        """Forget all: the arm is somewhere else."""
        self._started_with = None

    def update(self, angles: Vector, velocities: Vector, torques: Vector, period_s: float) -> None:
        """Take the torques that acted during the last cycle into account."""
        momentum, drift = self._dynamics.momentum_and_drift(angles, velocities)
        if self._started_with is None:
            self._started_with = momentum
            self._integral = np.zeros_like(momentum)
            self.residual = np.zeros_like(momentum)
            return
        self._integral = self._integral + (torques + drift + self.residual) * period_s
        # Solved for the residual at the end of the cycle, which is stable at any gain.
        change = momentum - self._started_with - self._integral
        self.residual = self.residual + (
            (self._gain * change - self.residual) / (1.0 + self._gain * period_s)
        )


def force_at_tool(jacobian: NDArray[np.float64], torques: Vector, noise_nm: Vector) -> Vector:
    """The force (3, N, base frame) at the tool point that explains external torques best.

    Weighted by how exactly each joint's torque is known; `noise_nm` are standard deviations. What
    the joints cannot feel where the arm is stretched is taken to be 0.
    """
    weighted = jacobian / noise_nm
    information = weighted @ weighted.T + _KNOWN_BEFORE
    return np.asarray(np.linalg.solve(information, weighted @ (torques / noise_nm)), np.float64)
