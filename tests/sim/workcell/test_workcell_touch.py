"""What the arm feels, against forces that are really applied to it."""

import numpy as np
import pytest
from workcell_hands import Hands

from mend.robots.arm.body import ToolPose

FREE_N = 5.0
"""Moving freely, with an empty gripper, it feels no more."""


def push(hands: Hands, force: np.ndarray, cycles: int) -> list[np.ndarray]:
    """What it feels while a force (N) pushes at the gripper."""
    client, pr2 = hands.world._client, hands.body.pr2
    felt = []
    for _ in range(cycles):
        at = hands.body.tool_pose()[:3, 3]
        link = pr2._arm[-1]
        client.applyExternalForce(
            pr2.body_id, link, force.tolist(), at.tolist(), client.WORLD_FRAME
        )
        hands.body.advance_cycle()
        felt.append(hands.body.contact_force())
    return felt


@pytest.mark.parametrize("direction", [(1, 0, 0), (0, 1, 0), (0, 0, 1), (-0.6, 0.0, -0.8)])
@pytest.mark.parametrize("strength_n", [15.0, 40.0])
def test_a_push_is_felt_as_strong_as_it_is(hands: Hands, direction, strength_n: float) -> None:
    hands.follow(hands.plan(ToolPose(0.55, -0.3, 0.95, 0.3)), 0, 1.0)
    force = strength_n * np.array(direction, float)
    felt = push(hands, force, 60)
    assert felt[-1] == pytest.approx(force, abs=0.15 * strength_n + 2.0)
    assert np.linalg.norm(felt[-1] - felt[0]) > 0.5 * strength_n


def test_nothing_is_felt_where_nothing_pushes_however_fast_it_moves(hands: Hands) -> None:
    forces: list[float] = []

    def feel() -> bool:
        forces.append(hands.body.contact_force_n())
        return False

    rng = np.random.default_rng(5)
    for _ in range(6):
        x, y, yaw = rng.uniform((0.45, -0.55, -1.4), (0.66, 0.1, 1.4))
        hands.follow(hands.plan(ToolPose(float(x), float(y), 0.95, float(yaw))), 0, 1.0, feel)
    assert max(forces) < FREE_N
