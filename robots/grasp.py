"""How a part is grasped from above: where the tool point goes, and where the part then is."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robots.body import Matrix4, ToolPose
from robots.catalogue import Part

_DEEPEST_M = 0.025
"""How far below the top of a box the tool point goes at most."""

RELEASE_CLEARANCE_M = 0.002
"""A part is let go this far above where it is to rest, so that it is never pressed down."""


@dataclass(frozen=True, slots=True)
class Grasp:
    """Relative to the part: the tool point's height above its bottom, the opening direction.

    `yaw` turns the part's x axis into the direction in which the fingers open; `width_m` is what
    is then between them.
    """

    height_m: float
    yaw: float
    width_m: float

    def tool_pose(self, x: float, y: float, bottom_z: float, part_yaw: float) -> ToolPose:
        """The tool pose for a part whose bottom centre is at (x, y, bottom_z)."""
        return ToolPose(x, y, bottom_z + self.height_m, half_turn(part_yaw + self.yaw))


def grasp_of(part: Part) -> Grasp:
    """Grasp a part by its knob if it has one, across the thinner horizontal extent."""
    if part.knob is not None:
        return Grasp(part.size[2] + part.knob[2] / 2, *_across(part.knob[0], part.knob[1]))
    height_m = max(part.size[2] - _DEEPEST_M, part.size[2] / 2)
    return Grasp(height_m, *_across(part.size[0], part.size[1]))


def _across(x_m: float, y_m: float) -> tuple[float, float]:
    return (0.0, x_m) if x_m <= y_m else (math.pi / 2, y_m)


def half_turn(yaw: float) -> float:
    """The equal of `yaw` in [-pi/2, pi/2) for what looks the same after half a turn."""
    return (yaw + math.pi / 2) % math.pi - math.pi / 2


def corners_in_tool(part: Part, grasp: Grasp) -> list[NDArray[np.float64]]:
    """The corners (8, 3) of each of the part's boxes in the tool frame while it is grasped.

    Tool frame: x is the approach direction (down), y the opening direction of the fingers.
    """
    axes = _part_axes(grasp)
    boxes = [(0.0, part.size)]
    if part.knob is not None:
        boxes.append((part.size[2], part.knob))
    return [_corners(bottom_m - grasp.height_m, size) @ axes for bottom_m, size in boxes]


def part_in_tool(grasp: Grasp) -> Matrix4:
    """The pose of a grasped part, its bottom centre, in the tool frame of `corners_in_tool`."""
    pose = np.eye(4)
    pose[:3, :3] = _part_axes(grasp).T
    pose[:3, 3] = np.array([0.0, 0.0, -grasp.height_m]) @ _part_axes(grasp)
    return pose


def _part_axes(grasp: Grasp) -> NDArray[np.float64]:
    """The part's axes as rows, in the tool frame."""
    cos, sin = math.cos(grasp.yaw), math.sin(grasp.yaw)
    return np.array([[0.0, cos, sin], [0.0, sin, -cos], [-1.0, 0.0, 0.0]])


def _corners(bottom_m: float, size: tuple[float, float, float]) -> NDArray[np.float64]:
    signs = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (0.0, 1.0)])
    corners: NDArray[np.float64] = signs * np.array(size) + np.array([0.0, 0.0, bottom_m])
    return corners
