"""The PR2's right arm as a rigid-body model, in Pinocchio."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from mend.sim.workcell.gripper import FINGERS_OPEN_RAD
from mend.sim.workcell.robot_model import ARM_JOINTS, FINGER_JOINTS, TOOL_FRAME

Vector = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class LinkInertia:
    """One moving link: its mass, its centre of mass and inertia (3, 3) in the joint's frame."""

    mass_kg: float
    center_m: Vector
    inertia_kg_m2: NDArray[np.float64]


class Pr2ArmDynamics:
    """An `ArmDynamics` of the arm, the gripper's fingers half open."""

    def __init__(self, urdf: Path, inertias: Mapping[str, LinkInertia]) -> None:
        """`inertias` by joint, as they were identified on the robot."""
        whole = pin.buildModelFromUrdf(str(urdf))
        for name, each in inertias.items():
            whole.inertias[whole.getJointId(name)] = pin.Inertia(
                each.mass_kg, each.center_m, each.inertia_kg_m2
            )
        fixed = pin.neutral(whole)
        for name in FINGER_JOINTS:
            fixed[whole.joints[whole.getJointId(name)].idx_q] = FINGERS_OPEN_RAD / 2
        locked = [whole.getJointId(name) for name in FINGER_JOINTS]
        self._model = pin.buildReducedModel(whole, locked, fixed)
        self._data = self._model.createData()
        self._upper = np.triu(np.ones((self._model.nv, self._model.nv), bool))
        self._tool = self._model.getFrameId(TOOL_FRAME)
        joints = [self._model.joints[self._model.getJointId(name)] for name in ARM_JOINTS]
        self._places = np.array([each.idx_q for each in joints])
        self._round = np.array([each.nq == 2 for each in joints])

    def momentum_and_drift(self, angles: Vector, velocities: Vector) -> tuple[Vector, Vector]:
        q = self._configuration(angles)
        mass = pin.crba(self._model, self._data, q)
        # Only the upper triangle of the symmetric matrix is computed.
        momentum = np.where(self._upper, mass, mass.T) @ velocities
        coriolis = pin.computeCoriolisMatrix(self._model, self._data, q, velocities)
        drift = coriolis.T @ velocities - pin.computeGeneralizedGravity(self._model, self._data, q)
        return momentum, np.asarray(drift)

    def tool_jacobian(self, angles: Vector) -> NDArray[np.float64]:
        jacobian = pin.computeFrameJacobian(
            self._model,
            self._data,
            self._configuration(angles),
            self._tool,
            pin.ReferenceFrame.LOCAL_WORLD_ALIGNED,
        )
        return np.asarray(jacobian[:3])

    def _configuration(self, angles: Vector) -> Vector:
        """Pinocchio keeps the angle of a joint without limits as its cosine and sine."""
        q = np.empty(self._model.nq)
        q[self._places] = np.where(self._round, np.cos(angles), angles)
        q[self._places[self._round] + 1] = np.sin(angles[self._round])
        return q
