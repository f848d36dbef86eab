"""Poses of a robot between its base frame and the scene's, in which a world keeps them."""

from dataclasses import replace

import numpy as np

from mend.robots.arm.body import ToolPose
from mend.robots.body import Matrix4
from mend.tasks.frames import Frame


def tool_in_scene(frame: Frame, pose: ToolPose) -> ToolPose:
    """A pose of the base frame as the scene has it."""
    x, y = frame.to_scene(pose.x, pose.y)
    return replace(pose, x=x, y=y, yaw=pose.yaw + frame.yaw)


def tool_in_base(frame: Frame, pose: ToolPose) -> ToolPose:
    """A pose of the scene as the robot has it."""
    x, y = frame.to_robot(pose.x, pose.y)
    return replace(pose, x=x, y=y, yaw=pose.yaw - frame.yaw)


def base_in_scene(frame: Frame) -> Matrix4:
    """The base frame in the scene's (4, 4)."""
    base = np.eye(4)
    cos, sin = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)][frame.quarters]
    base[:2, :2] = [[cos, -sin], [sin, cos]]
    base[:2, 3] = frame.x, frame.y
    return base
