"""The physics engine's connection, and conversions between its poses and matrices."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mend.robots.body import Matrix4
from mend.sim.workcell.quiet import silenced

Client = Any
"""A `pybullet_utils.bullet_client.BulletClient`; PyBullet has no types."""

Quaternion = tuple[float, float, float, float]
Point = tuple[float, float, float]

LEAST_DISTANCE_M = 1e-6
"""To ask for bodies within this: within 0 the engine overlooks some that intersect."""

CONTROL_HZ = 240
"""Control cycles, and physics steps, per simulated second."""


def connect() -> Client:
    """A new, empty engine in this process."""
    with silenced():
        import pybullet
        from pybullet_utils.bullet_client import BulletClient

        class Engine(BulletClient):  # type: ignore[misc]
            """A client that binds each function only once: some are called every cycle."""

            def __getattr__(self, name: str) -> Any:
                bound = super().__getattr__(name)
                setattr(self, name, bound)
                return bound

        return Engine(pybullet.DIRECT)


def arrangement(client: Client) -> NDArray[np.float64]:
    """Where every body and joint is (metres, radians): two that are equal look the same."""
    values: list[float] = []
    for number in range(client.getNumBodies()):
        body = client.getBodyUniqueId(number)
        for coordinates in client.getBasePositionAndOrientation(body):
            values.extend(coordinates)
        if joints := client.getNumJoints(body):
            values.extend(each[0] for each in client.getJointStates(body, range(joints)))
    return np.array(values)


def wake(client: Client, body_id: int) -> None:
    """Have the engine move a body again that may sleep."""
    client.changeDynamics(body_id, -1, activationState=client.ACTIVATION_STATE_WAKE_UP)


def to_matrix(position: Point, quaternion: Quaternion) -> Matrix4:
    """A pose of the engine as a homogeneous transform."""
    x, y, z, w = quaternion
    matrix = np.eye(4)
    matrix[0, 0] = 1 - 2 * (y * y + z * z)
    matrix[0, 1] = 2 * (x * y - z * w)
    matrix[0, 2] = 2 * (x * z + y * w)
    matrix[1, 0] = 2 * (x * y + z * w)
    matrix[1, 1] = 1 - 2 * (x * x + z * z)
    matrix[1, 2] = 2 * (y * z - x * w)
    matrix[2, 0] = 2 * (x * z - y * w)
    matrix[2, 1] = 2 * (y * z + x * w)
    matrix[2, 2] = 1 - 2 * (x * x + y * y)
    matrix[:3, 3] = position
    return matrix


def yaw_quaternion(yaw: float) -> Quaternion:
    """A turn about the vertical."""
    return 0.0, 0.0, float(np.sin(yaw / 2)), float(np.cos(yaw / 2))
