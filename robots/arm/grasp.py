"""How a part is grasped from above: where the tool point goes, and where the part then is."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mend.errors import MendError
from mend.robots.arm.body import ToolPose
from mend.robots.arm.gripper import GripperModel
from mend.robots.body import Matrix4
from mend.robots.catalogue import Part

RELEASE_CLEARANCE_M = 0.002
"""A part is let go this far above where it is to rest, so that it is never pressed down."""

TIP_CLEARANCE_M = 0.003
"""The closing tips stay this far above what the part stands on, and above a knob's plate."""

OPEN_BESIDE_M = 0.012
"""Fingers open so much wider than the part on each side where there is room."""
OPEN_LEAST_M = 0.006
"""The least on each side: the camera's error and the turn that it may be off by."""

_SHALLOW_M = 0.012
"""Amid other things a part is held by so much of its height only, with the fingers above them."""

_MM = 1e3


class UngraspableError(MendError):
    """A gripper cannot take hold of a part at all; the message says why, and what it can."""


@dataclass(frozen=True, slots=True)
class Grasp:
    """Relative to the part: the tool point's height above its bottom, the opening direction.

    `yaw` turns the part's x axis into the direction in which the fingers open; what is then
    between them is `width_m` wide, and `across_m` the other way. They are `opening_m` apart before
    they close and after they let go.
    """

    height_m: float
    yaw: float
    width_m: float
    across_m: float
    opening_m: float

    @property
    def diagonal_m(self) -> float:
        """Of what is between the fingers, seen from above."""
        return math.hypot(self.width_m, self.across_m)

    def tool_pose(self, x: float, y: float, bottom_z: float, part_yaw: float) -> ToolPose:
        """The tool pose for a part whose bottom centre is at (x, y, bottom_z)."""
        return ToolPose(x, y, bottom_z + self.height_m, half_turn(part_yaw + self.yaw))


def grasp_of(part: Part, gripper: GripperModel) -> Grasp:
    """The grasp of a part that stands alone. Raises `UngraspableError`."""
    return grasps_of(part, gripper)[0]


def can_grasp(part: Part, gripper: GripperModel) -> bool:
    """Whether there is any grasp of a part."""
    try:
        return bool(grasps_of(part, gripper))
    except UngraspableError:
        return False


def grasps_of(part: Part, gripper: GripperModel) -> list[Grasp]:
    """All grasps of a part, by its knob if it has one, the best first.

    Across the thinner side before the other one; with much room before little; deep before
    shallow. Raises `UngraspableError` where there is none.
    """
    low_m, held = part.boxes[-1]
    length_m, width_m, high_m = held
    widths = sorted([(length_m, width_m, 0.0), (width_m, length_m, math.pi / 2)])
    fitting = [each for each in widths if gripper.min_width_m <= each[0] <= gripper.max_width_m]
    if not fitting:
        raise UngraspableError(_misfit(part, widths[0][0], gripper))
    grasps = [
        Grasp(height_m, yaw, wide_m, across_m, min(wide_m + 2 * beside_m, gripper.max_opening_m))
        for wide_m, across_m, yaw in fitting
        for height_m in _heights(low_m, high_m, wide_m, gripper)
        for beside_m in (OPEN_BESIDE_M, OPEN_LEAST_M)
    ]
    if not grasps or high_m < least_height_m(gripper) - 1e-9:
        raise UngraspableError(
            f"{_held(part)} is {round(high_m * _MM, 1):g} mm high; for fingers of this gripper to "
            f"hold it without touching what is below, it has to be at least "
            f"{least_height_m(gripper) * _MM:.0f} mm high"
        )
    return grasps


def least_height_m(gripper: GripperModel) -> float:
    """How high a part, or a knob, has to be at least."""
    fitting_m = gripper.overlap_m + gripper.pad_above_tip_m + TIP_CLEARANCE_M
    return max(gripper.min_height_m, fitting_m)


def _heights(
    low_m: float, high_m: float, width_m: float, gripper: GripperModel
) -> tuple[float, ...]:
    """The tool point above the part's bottom: as deep as the gripper goes but above the middle.

    And, if that is higher, with only a little of the part between the fingers. What is held
    reaches from `low_m` over the bottom `high_m` further up.
    """
    reach_m = gripper.reach_below_m(width_m)
    least_m = low_m + reach_m + TIP_CLEARANCE_M
    top_m = low_m + high_m + reach_m - gripper.pad_above_tip_m
    most_m = top_m - gripper.overlap_m
    if least_m > most_m + 1e-9:
        return ()
    wanted_m = low_m + max(high_m - gripper.deepest_m, high_m / 2)
    deep_m = min(max(wanted_m, least_m), most_m)
    shallow_m = top_m - _SHALLOW_M
    return (deep_m, shallow_m) if shallow_m > deep_m else (deep_m,)


def _misfit(part: Part, width_m: float, gripper: GripperModel) -> str:
    extent = "is" if width_m > gripper.max_width_m else "is only"
    return (
        f"{_held(part)} {extent} {width_m * _MM:.3g} mm wide at its narrower side; this gripper "
        f"takes {gripper.min_width_m * _MM:.0f} to {gripper.max_width_m * _MM:.0f} mm"
    )


def _held(part: Part) -> str:
    return part.name if part.knob is None else f"the knob of {part.name}"


def half_turn(yaw: float) -> float:
    """The equal of `yaw` in [-pi/2, pi/2) for what looks the same after half a turn."""
    return (yaw + math.pi / 2) % math.pi - math.pi / 2


def corners_in_tool(part: Part, grasp: Grasp) -> list[NDArray[np.float64]]:
    """The corners (8, 3) of each of the part's boxes in the tool frame while it is grasped.

    Tool frame: x is the approach direction (down), y the opening direction of the fingers.
    """
    axes = _part_axes(grasp)
    return [_corners(bottom_m - grasp.height_m, size) @ axes for bottom_m, size in part.boxes]


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
