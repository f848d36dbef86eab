"""Parts that have come to rest cost nothing, and move again as soon as anything moves them."""

from collections.abc import Iterator

import numpy as np
import pytest
from workcell_hands import TABLE_M

from mend.sim.workcell.bench import Bench
from mend.sim.workcell.hand import HOLD_FORCE_N, PULL_FORCE_N, Hand
from mend.sim.workcell.parts import PartPose, RigidPart
from mend.sim.workcell.physics import CONTROL_HZ, Client, connect
from mend.tasks.scene import Pose, Scene, SceneObject

LONG_ASLEEP_S = 4.0
LOW_M = 0.03


@pytest.fixture
def client() -> Iterator[Client]:
    client = connect()
    client.setPhysicsEngineParameter(fixedTimeStep=1 / CONTROL_HZ)
    client.setGravity(0.0, 0.0, -9.81)
    yield client
    client.disconnect()


def box(z_m: float) -> SceneObject:
    pose = Pose(x=0.5, y=0.0, z=TABLE_M + z_m)
    return SceneObject(color=(0.1, 0.5, 0.1), size=(0.05, 0.05, LOW_M), pose=pose, mass_kg=0.1)


@pytest.fixture
def stack(client: Client) -> tuple[RigidPart, RigidPart]:
    """A lower and an upper part that have lain for long."""
    scene = Scene(name="stack", objects={"lower": box(0.0), "upper": box(LOW_M)}, places={})
    bench = Bench(client, scene)
    bench.lay_out(np.random.default_rng(1))
    lower, upper = bench.parts.values()
    upper.put(PartPose.upright(0.5, 0.0, TABLE_M + LOW_M + 0.001, 0.0))
    pass_time(client, LONG_ASLEEP_S)
    assert height_m(upper) == pytest.approx(LOW_M, abs=0.001)
    return lower, upper


def pass_time(client: Client, duration_s: float) -> None:
    for _ in range(round(duration_s * CONTROL_HZ)):
        client.stepSimulation()


def height_m(part: RigidPart) -> float:
    """Of its bottom above the table."""
    return part.pose().position[2] - TABLE_M


def test_what_rested_on_a_part_that_is_taken_away_falls(client: Client, stack) -> None:
    lower, upper = stack
    lower.take_away()
    pass_time(client, 0.5)
    assert height_m(upper) == pytest.approx(0.0, abs=0.002)


def test_what_rested_on_a_part_that_is_pulled_away_rides_along(client: Client, stack) -> None:
    lower, upper = stack
    hand = Hand.take_hold(client, lower, PULL_FORCE_N)
    for cycle in range(CONTROL_HZ):
        hand.move_by((0.3 * cycle / CONTROL_HZ, 0.0, 0.0))
        client.stepSimulation()
    assert lower.pose().position[0] > 0.7
    assert upper.pose().position[0] > 0.7


def test_a_hand_that_held_a_part_still_for_long_moves_it_all_the_same(
    client: Client, stack
) -> None:
    _, upper = stack
    hand = Hand.take_hold(client, upper, HOLD_FORCE_N)
    pass_time(client, LONG_ASLEEP_S)
    hand.move_by((0.0, 0.0, 0.05))
    pass_time(client, 0.5)
    assert height_m(upper) == pytest.approx(LOW_M + 0.05, abs=0.002)
    hand.let_go()
    pass_time(client, 0.5)
    assert height_m(upper) == pytest.approx(LOW_M, abs=0.002)


def test_a_part_that_is_hit_moves_on_what_hits_it(client: Client, stack) -> None:
    lower, upper = stack
    lower.take_away()
    upper.put(PartPose.upright(0.5, 0.0, TABLE_M + 0.001, 0.0))
    pass_time(client, LONG_ASLEEP_S)
    lower.put(PartPose.upright(0.5, 0.0, TABLE_M + 0.25, 0.6))
    client.resetBaseVelocity(lower.body_id, [0.0, 0.0, -2.0])
    before = upper.pose()
    pass_time(client, 1.0)
    assert upper.pose() != before


def test_what_lies_still_is_asleep(client: Client, stack) -> None:
    """Whatever pushes no harder than rounding does would otherwise creep."""
    _, upper = stack
    before = upper.pose()
    pass_time(client, LONG_ASLEEP_S)
    assert upper.pose() == before
