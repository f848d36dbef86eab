"""The body of an arm: what behaviors, monitors and looks may ask of its hardware.

Poses are 4x4 matrices or `ToolPose`s in the robot's base frame (x forward, y left, z up).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from mend.robots.arm.gripper import GripperModel
from mend.robots.body import Matrix4, MovingBody
from mend.robots.vision.seen_box import SeenBox


@dataclass(frozen=True, slots=True)
class ToolPose:
    """The tool point with the gripper pointing straight down; `yaw` turns its opening direction.

    The fingers open along (cos yaw, sin yaw, 0).
    """

    x: float
    y: float
    z: float
    yaw: float


@dataclass(frozen=True, slots=True)
class Reach:
    """The graspable range: distances in metres from `origin` (base frame), in the plane."""

    origin: tuple[float, float]
    min_m: float
    max_m: float


@dataclass(frozen=True, slots=True)
class Swing:
    """An arm that turns about `pivot`; `tool` is where its tool point rests (base frame)."""

    pivot: tuple[float, float]
    tool: tuple[float, float]


@dataclass(frozen=True, slots=True)
class ArmRoom:
    """The room that an arm takes in the plane (base frame, metres).

    All of it is within `around_m` of the convex hull of `resting` (the corners of what it covers at
    rest) and of where its tool is to go; `hand_over`: where it takes what people hold out. With
    `swing` the hull is also that of the arcs about its pivot between any two places of the tool,
    each with the radius of the farther one. `torso`: the corners of what of the robot is always
    there beside its arm.
    """

    resting: Sequence[tuple[float, float]]
    hand_over: tuple[float, float]
    around_m: float
    swing: Swing | None = None
    torso: Sequence[tuple[float, float]] = ()


@dataclass(frozen=True, slots=True, eq=False)
class HeldBox:
    """A box that the gripper holds: its full extents, and its middle's pose in the tool frame."""

    size: tuple[float, float, float]
    in_tool: Matrix4


@dataclass(frozen=True, slots=True)
class Leg:
    """A part of a way: where it leads, how far the fingers are apart meanwhile, what they hold."""

    to: ToolPose
    opening_m: float
    held: Sequence[HeldBox] = ()


@dataclass(frozen=True, slots=True)
class NoWay:
    """Why there is no path, as the end of a sentence: "the arm does not ...".

    `touched` is what the first of the paths that were tried would touch.
    """

    reason: str
    touched: SeenBox | None = None


class ArmPath(Protocol):
    """A checked arm motion through the waypoints that it was planned for, in segments.

    Segment i leads to waypoint i (segment 0 from where the arm was).
    """

    @property
    def segments(self) -> int: ...


class ArmBody(MovingBody, Protocol):
    """An arm, a gripper and cameras: `head` (with depth) and `forearm` for `pick_and_place`.

    One motion is under way at a time; `stop` stops it within one control cycle.
    """

    def set_speed(self, speed: float) -> None:
        """Change the speed of the motion under way from the next cycle on."""
        ...

    @property
    def progress(self) -> float:
        """The fraction in [0, 1] of the motion under way that is done; 1 when none is."""
        ...

    @property
    def reach(self) -> Reach: ...

    @property
    def room(self) -> ArmRoom: ...

    def plan_path(self, waypoints: Sequence[ToolPose]) -> ArmPath | None:
        """Plan through all waypoints from where the arm is; None if any part cannot be reached.

        Waypoints that differ in z only are joined by a straight vertical line. Fingers are alike:
        a body may turn all waypoints together by half a turn, to yaw + pi.
        """
        ...

    def plan_back(self, waypoints: Sequence[ToolPose]) -> ArmPath | None:
        """Plan back through poses that the tool has just passed; None if that is not found.

        The arm stays in the posture in which it passed them: amid what it touches it turns nothing.
        """
        ...

    def plan_among(self, legs: Sequence[Leg], boxes: Sequence[SeenBox]) -> ArmPath | NoWay:
        """As `plan_path`, and so that neither arm nor what it holds touches any of `boxes`."""
        ...

    def plan_neutral(self) -> ArmPath:
        """Plan to the neutral pose, where the arm hides nothing from the head camera."""
        ...

    def plan_hand_over(self) -> ArmPath:
        """Plan to the pose in which the robot takes an object from a person."""
        ...

    def follow(self, path: ArmPath, segment: int, speed: float) -> None:
        """Start one segment; `speed` in (0, 1] scales it. Replaces what was under way."""
        ...

    @property
    def gripper(self) -> GripperModel:
        """What its gripper can take hold of, and the room that it needs."""
        ...

    def open_gripper(self, opening_m: float | None = None) -> None:
        """Move the fingers to be `opening_m` apart; None opens them as far as they go."""
        ...

    def close_gripper(self) -> None: ...

    def tool_pose(self) -> Matrix4:
        """The tool point's pose from the joint positions (forward kinematics).

        x: approach direction (down), y: opening direction of the fingers.
        """
        ...

    def gripper_opening_m(self) -> float:
        """The distance between the finger tips, from the joint positions."""
        ...

    def gripper_effort_n(self) -> float:
        """The force with which the fingers press together, from their effort sensors."""
        ...

    def finger_hulls(self) -> Sequence[NDArray[np.float64]]:
        """What of the gripper may hide a held part: convex pieces (n, 3), now, tool frame."""
        ...

    def contact_force(self) -> NDArray[np.float64]:
        """The external force (3, N, base frame) at the tool point, as the joints' efforts tell it.

        The weight of what is held is part of it.
        """
        ...

    def contact_force_n(self) -> float:
        """How strong that force is."""
        ...
