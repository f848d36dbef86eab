"""The PR2's gripper: how its fingers swing, and the room that they take (from its meshes)."""

import math

from mend.robots.arm.gripper import GripperModel, Slab

_LINK_M = 0.09137
_LINK_OFFSET_M = 0.00495
"""From a finger's joint to its tip's joint, along and across the closed finger."""

_PAD_M = -0.00087
"""How far a pad is from the middle when the finger's angle is 0: the tips press together."""

_RADIUS_M = math.hypot(_LINK_M, _LINK_OFFSET_M)
_CLOSED_RAD = math.atan2(_LINK_OFFSET_M, _LINK_M)

FINGERS_OPEN_RAD = 0.54
"""The angle of each finger of the open gripper; the joint ends at 0.548."""


def inner_side_m(angle_rad: float) -> float:
    """How far the inner side of a finger's tip is from the middle of the gripper."""
    return _RADIUS_M * math.sin(_CLOSED_RAD + angle_rad) - _LINK_OFFSET_M + _PAD_M


def finger_angle_rad(opening_m: float) -> float:
    """The angle of each finger when the tips are so far apart, as far as they go."""
    aside_m = opening_m / 2 + _LINK_OFFSET_M - _PAD_M
    angle_rad = math.asin(min(1.0, aside_m / _RADIUS_M)) - _CLOSED_RAD
    return min(max(angle_rad, 0.0), FINGERS_OPEN_RAD)


PR2_GRIPPER = GripperModel(
    min_width_m=0.012,
    max_width_m=0.078,
    min_height_m=0.020,
    max_length_m=0.40,
    max_height_m=0.25,
    max_opening_m=2 * inner_side_m(FINGERS_OPEN_RAD),
    max_mass_kg=0.5,
    grip_force_n=33.0,
    tip_reach_m=0.0193,
    pad_above_tip_m=0.002,
    overlap_m=0.007,
    deepest_m=0.025,
    link_m=_LINK_M,
    link_offset_m=_LINK_OFFSET_M - _PAD_M,
    # The tips are wedges under the links; each slice is as thick as the wedge at its upper end.
    fingers=(
        Slab(0.000, 0.0150, 0.0225),
        Slab(0.007, 0.0205, 0.0225),
        Slab(0.014, 0.0265, 0.0225),
        Slab(0.022, 0.0330, 0.0260),
        Slab(0.030, 0.0400, 0.0290),
        Slab(0.039, 0.0480, 0.0370),
        Slab(0.053, 0.0480, 0.0455),
        Slab(0.064, 0.0480, 0.0550),
    ),
    palm=(Slab(0.0735, 0.1120, 0.0550),),
)
"""Its links lean inward above the pads: what is higher there than `deepest_m` would touch them."""
