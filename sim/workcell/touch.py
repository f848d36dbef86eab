"""What the arm feels: the external force at the tool point, from its joints' efforts."""

import numpy as np
from numpy.typing import NDArray

from mend.robots.arm.motion.momentum_observer import ArmDynamics, MomentumObserver, force_at_tool
from mend.sim.workcell.effort_sensors import ARM_NOISE_NM, EffortSensors

Vector = NDArray[np.float64]

_OBSERVER_HZ = 6.0
"""Fast enough for a contact to be felt within some 50 ms, slow enough to take the noise down."""


class Touch:
    """Feels, cycle by cycle, what presses against the arm."""

    def __init__(
        self,
        dynamics: ArmDynamics,
        damping_nm_s: float,
        period_s: float,
        rng: np.random.Generator,
    ) -> None:
        """`damping_nm_s` is the joints' viscous friction, which is known."""
        self._dynamics = dynamics
        self._observer = MomentumObserver(dynamics, _OBSERVER_HZ)
        self._sensors = EffortSensors(rng, period_s)
        self._damping_nm_s = damping_nm_s
        self._period_s = period_s
        self._angles: Vector = np.zeros(len(ARM_NOISE_NM))
        self._force: Vector | None = None

    def feel(self, angles: Vector, velocities: Vector, torques_nm: Vector) -> None:
        """Take one cycle's joint angles, velocities and motor torques into account."""
        measured = self._sensors.read(torques_nm) - self._damping_nm_s * velocities
        self._observer.update(angles, velocities, measured, self._period_s)
        self._angles = angles
        self._force = None

    def reset(self) -> None:
        """The arm is somewhere else at once."""
        self._observer.reset()
        self._force = None

    @property
    def force(self) -> Vector:
        """The external force (3, N, base frame) at the tool point."""
        if self._force is None:
            self._force = self._measured_force()
        return self._force

    def _measured_force(self) -> Vector:
        residual = self._observer.residual
        if not residual.size:
            return np.zeros(3)
        return force_at_tool(self._dynamics.tool_jacobian(self._angles), residual, ARM_NOISE_NM)
