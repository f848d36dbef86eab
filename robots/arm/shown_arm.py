"""What an arm shows of itself to people, for display only: its joints, its tool, what is where."""

from collections.abc import Mapping, Sequence
from typing import Protocol, runtime_checkable

import numpy as np
from scipy.spatial.transform import Rotation

from mend.robots.arm.body import ArmBody
from mend.robots.arm.grasp import part_in_tool
from mend.robots.arm.perception import Perception
from mend.robots.body import Matrix4
from mend.robots.catalogue import Catalogue, Part
from mend.robots.link.messages import (
    PoseLayout,
    Poses,
    PoseValues,
    ShownObject,
    ShownPose,
    Sighting,
)


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


class ShownArm:
    """What is shown of one arm: its joints and tool, and the parts where it located them."""

    def __init__(self, body: ArmBody, catalogue: Catalogue, perception: Perception) -> None:
        self._body = body
        self._jointed = body if isinstance(body, JointedBody) else None
        self._catalogue = catalogue
        self._perception = perception
        self.located: Mapping[str, Sighting] = {}

    def layout(self, layout: PoseLayout) -> PoseLayout:
        """Add the body's joints, and every part of the catalogue."""
        objects = [
            ShownObject(name=part.name, size=part.size, knob=part.knob)
            for part in self._catalogue.parts.values()
        ]
        jointed = self._jointed
        return layout.model_copy(
            update={
                "model": jointed.model if jointed else layout.model,
                "joints": [*layout.joints, *(jointed.joint_names if jointed else ())],
                "objects": [*layout.objects, *objects],
            }
        )

    def poses(self, poses: Poses) -> Poses:
        """Add the joints and the tool now, and every part where it was located last."""
        joints = self._jointed.joint_positions() if self._jointed else ()
        objects = [self._shown(part) for part in self._catalogue.parts.values()]
        return poses.model_copy(
            update={
                "joints": [*poses.joints, *(float(each) for each in joints)],
                "tool": pose_values(self._body.tool_pose()),
                "opening_m": float(self._body.gripper_opening_m()),
                "objects": [*poses.objects, *objects],
            }
        )

    def _shown(self, part: Part) -> ShownPose:
        if self._perception.hand.grip is not None and self._perception.hand.holds(part.name):
            held = self._body.tool_pose() @ part_in_tool(self._perception.hand.grip.grasp)
            return ShownPose(pose=pose_values(held), held=True)
        located = self.located.get(part.name)
        if located is None:
            return ShownPose(pose=(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0), hidden=True)
        return ShownPose(pose=sighted_values(located))


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
