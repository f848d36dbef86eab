"""The limits that `docs/worlds.md` tells are those that the code goes by."""

import math
import re
from pathlib import Path

import pytest

from mend.robots.arm.clearance import ROOM_M
from mend.robots.arm.feasibility.stability import PLACED_WITHIN_M
from mend.robots.arm.feasibility.support import LEAST_STABILITY_RAD
from mend.robots.arm.grasp import OPEN_BESIDE_M, OPEN_LEAST_M, least_height_m
from mend.robots.arm.gripper import GripperModel
from mend.sim.tabletop.arm import GRIPPER
from mend.sim.tabletop.world import REACH_MAX_M, REACH_MIN_M
from mend.sim.workcell.gripper import PR2_GRIPPER
from mend.tasks.scene import RESTS_M

DOCUMENT = (Path(__file__).parents[4] / "docs" / "worlds.md").read_text()
ROWS = {
    cells[1]: cells[2:4]
    for line in DOCUMENT.splitlines()
    if len(cells := [each.strip() for each in line.split("|")]) > 3
}


def numbers(text: str) -> list[float]:
    return [float(each) for each in re.findall(r"\d+(?:\.\d+)?", text)]


@pytest.mark.parametrize(("column", "gripper"), [(0, PR2_GRIPPER), (1, GRIPPER)])
def test_the_table_tells_what_the_gripper_takes(column: int, gripper: GripperModel) -> None:
    def told(row: str) -> list[float]:
        return numbers(ROWS[row][column])

    assert told("width, at least one of both sides") == [
        pytest.approx(1e3 * gripper.min_width_m),
        pytest.approx(1e3 * gripper.max_width_m),
    ]
    (height_mm,) = told("height of a box or of a knob, at least")
    assert height_mm == pytest.approx(1e3 * least_height_m(gripper))
    assert told("length of the longer side, at most") == [pytest.approx(1e3 * gripper.max_length_m)]
    assert told("height with the knob, at most") == [pytest.approx(1e3 * gripper.max_height_m)]
    assert told("weight, at most") == [gripper.max_mass_kg]
    assert told("fingers open at most") == [round(1e3 * gripper.max_opening_m)]


def test_the_text_tells_the_other_limits() -> None:
    assert f"{REACH_MIN_M:.2f} to {REACH_MAX_M:.2f} m" in DOCUMENT
    text = " ".join(DOCUMENT.split())
    assert f"within {1e3 * RESTS_M:.0f} mm" in text
    assert f"leans by less than {math.degrees(LEAST_STABILITY_RAD):.0f} degrees" in text
    assert f"{1e3 * PLACED_WITHIN_M:.0f} mm beside where it is to stand" in text
    assert f"up to {1 / math.tan(LEAST_STABILITY_RAD):.0f} times as high as wide" in text
    assert f"with {1e3 * ROOM_M:.0f} mm to spare" in text
    assert f"opened {1e3 * OPEN_LEAST_M:.0f} to {1e3 * OPEN_BESIDE_M:.0f} mm beyond" in text
    tip, *_, high = PR2_GRIPPER.fingers
    assert f"takes {1e3 * tip.thickness_m:.0f} mm at its tip" in text
    assert f"up to {1e3 * high.thickness_m:.0f} mm higher up" in text
