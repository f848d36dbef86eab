"""What a robot shows of itself to people, for display only: its joints, its tool, what is where."""

from collections.abc import Sequence
from typing import Protocol, runtime_checkable

import numpy as np
from scipy.spatial.transform import Rotation

from robots.body import Matrix4
from robots.link.messages import PoseLayout, Poses, PoseValues, Sighting


@runtime_checkable
class ShowsPoses(Protocol):
    """An agent core that can say where everything is."""

    def pose_layout(self) -> PoseLayout:
        """What its poses hold; the same all the time."""
        ...

    def poses(self) -> Poses:
        """Where everything is now."""
        ...


@runtime_checkable
class JointedBody(Protocol):
    """A body that a model can be drawn of, from its joint positions."""

    @property
    def model(self) -> str | None:
        """The name of its model files, if there are any."""
        ...

    @property
    def joint_names(self) -> Sequence[str]:
        """As the model names them."""
        ...

    def joint_positions(self) -> Sequence[float]:
        """In the order of `joint_names`, radians."""
        ...


def pose_values(pose: Matrix4) -> PoseValues:
    """A homogeneous transform as a message has it."""
    x, y, z = (float(each) for each in pose[:3, 3])
    qx, qy, qz, qw = (float(each) for each in Rotation.from_matrix(pose[:3, :3]).as_quat())
    return x, y, z, qx, qy, qz, qw


def sighted_values(sighting: Sighting) -> PoseValues:
    """Where something upright was seen."""
    half = sighting.yaw / 2
    return (
        sighting.x,
        sighting.y,
        sighting.z,
        0.0,
        0.0,
        float(np.sin(half)),
        float(np.cos(half)),
    )
