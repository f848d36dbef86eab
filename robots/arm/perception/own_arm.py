"""The robot's own arm in what its head camera sees."""

import numpy as np
from numpy.typing import NDArray

from mend.robots.arm.body import ArmBody
from mend.robots.arm.perception.hand import FOREARM, HandSense
from mend.robots.vision.obstruction import near
from mend.robots.vision.projection import Points

_ARM_LENGTH_M = 0.7
"""How far the arm reaches back from the tool point, for telling it from an obstacle."""
_ARM_RADIUS_M = 0.16
_GRIPPER_RADIUS_M = 0.09
_BELOW_TOOL_M = 0.03
"""So far the fingers, or what they hold, may reach below the tool point."""


class OwnArm:
    """Where the arm is, with what its hand is closed on."""

    def __init__(self, body: ArmBody, hand: HandSense) -> None:
        self._body = body
        self._hand = hand

    def includes(self, points: Points) -> NDArray[np.bool_]:
        """Which points are the arm: near the lines from the tool point back.

        One leads through its camera, one the way that the gripper came down.
        """
        pose, grip = self._body.tool_pose(), self._hand.grip
        tool = pose[:3, 3]
        along = self._body.cameras[FOREARM].pose()[:3, 3] - tool
        back = tool + along / max(float(np.linalg.norm(along)), 1e-6) * _ARM_LENGTH_M
        above = tool - pose[:3, 0] * _ARM_LENGTH_M
        low_z = tool[2] - (_BELOW_TOOL_M if grip is None else grip.part.height)
        own: NDArray[np.bool_] = near(points, [(tool, back)], _ARM_RADIUS_M)
        own |= near(points, [(tool, above)], _GRIPPER_RADIUS_M)
        own &= points[:, 2] > low_z
        return own
