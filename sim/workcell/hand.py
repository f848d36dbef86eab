"""A person's hand: holds a part with limited force, still or while it moves."""

from dataclasses import dataclass

import numpy as np

from mend.sim.workcell.parts import PartPose, RigidPart
from mend.sim.workcell.physics import Client, Point

HOLD_FORCE_N = 30.0
PULL_FORCE_N = 60.0


@dataclass(slots=True)
class Hand:
    """Holds one part; whoever takes hold also lets go."""

    client: Client
    part: RigidPart
    force_n: float
    _pose: PartPose
    _constraint: int

    @classmethod
    def take_hold(cls, client: Client, part: RigidPart, force_n: float) -> "Hand":
        """Hold a part where it is."""
        pose = part.pose()
        position, quaternion = part.body_pose(pose)
        constraint = client.createConstraint(
            part.body_id,
            -1,
            -1,
            -1,
            client.JOINT_FIXED,
            [0.0] * 3,
            [0.0] * 3,
            position,
            [0.0, 0.0, 0.0, 1.0],
            quaternion,
        )
        part.stay_awake(True)
        hand = cls(client, part, force_n, pose, constraint)
        hand.move_by((0.0, 0.0, 0.0))
        return hand

    def move_by(self, offset: Point) -> None:
        """Want the part this far from where the hand took hold of it."""
        position, quaternion = self.part.body_pose(self._pose)
        self.client.changeConstraint(
            self._constraint,
            jointChildPivot=(np.array(position) + offset).tolist(),
            jointChildFrameOrientation=quaternion,
            maxForce=self.force_n,
        )

    def let_go(self) -> None:
        self.client.removeConstraint(self._constraint)
        self.part.stay_awake(False)
