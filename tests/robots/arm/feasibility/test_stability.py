"""How far parts may lean before they tip over, alone and in stacks."""

import math

import pytest

from mend.robots.arm.feasibility.stability import PLACED_WITHIN_M, stability_rad
from mend.robots.arm.feasibility.standing import Standing, beneath
from mend.robots.catalogue import Part
from mend.tasks.scene import Pose

WEIGHTS = {"low": 0.2, "high": 0.1, "third": 0.1, "top": 0.3, "left": 0.1, "right": 0.1}


def block(
    name: str,
    size: tuple[float, float, float],
    x: float = 0.5,
    z: float = 0.70,
    knob: tuple[float, float, float] | None = None,
) -> Standing:
    return Standing(Part(name, size, knob), Pose(x=x, y=0.0, z=z), z, ("objects", name, "pose"))


def stability_deg(standing: Standing, *others: Standing) -> float:
    lean = stability_rad(standing, beneath(standing, others), others, WEIGHTS)
    return math.degrees(lean)


def test_on_the_table_it_is_the_narrower_side_to_the_height() -> None:
    assert stability_deg(block("low", (0.02, 0.10, 0.08))) == pytest.approx(
        math.degrees(math.atan(0.01 / 0.04))
    )


def test_a_part_on_another_counts_from_the_edge_of_what_both_share() -> None:
    low, high = block("low", (0.04, 0.04, 0.05)), block("high", (0.04, 0.04, 0.06), x=0.51, z=0.75)
    assert stability_deg(high, low) == pytest.approx(
        math.degrees(math.atan((0.01 - PLACED_WITHIN_M) / 0.03))
    )


def test_what_is_beyond_the_edge_tips_at_once() -> None:
    low, high = block("low", (0.04, 0.04, 0.05)), block("high", (0.06, 0.04, 0.06), x=0.525, z=0.75)
    assert stability_deg(high, low) < 0.0


def test_the_foot_of_a_tower_bears_all_that_stands_on_it() -> None:
    low = block("low", (0.02, 0.10, 0.05))
    high = block("high", (0.02, 0.10, 0.05), z=0.75)
    third = block("third", (0.02, 0.10, 0.05), z=0.80)
    middle_m = (0.2 * 0.025 + 0.1 * 0.075 + 0.1 * 0.125) / 0.4
    assert stability_deg(low, high, third) == pytest.approx(
        math.degrees(math.atan(0.01 / middle_m))
    )


def test_what_several_carry_burdens_none_of_them_alone() -> None:
    left = block("left", (0.03, 0.03, 0.05), x=0.45)
    right = block("right", (0.03, 0.03, 0.05), x=0.55)
    top = block("top", (0.14, 0.05, 0.02), z=0.75)
    alone = stability_deg(left)
    assert stability_deg(left, right, top) == alone
    assert stability_deg(top, left, right) > 45.0


def test_a_knob_raises_the_middle() -> None:
    plain = stability_deg(block("low", (0.05, 0.05, 0.02)))
    with_knob = stability_deg(block("low", (0.05, 0.05, 0.02), knob=(0.04, 0.04, 0.05)))
    assert with_knob < plain
