"""The path check: unknown things in the way are seen; table, parts and the arm are not."""

import numpy as np
import pytest
from drawn_scene import TABLE_Z, DrawnScene, Resting
from scripted_body import view_of

from mend.robots.arm.body import ToolPose
from mend.robots.vision.obstruction import Clearance, Obstruction, corridor, find_obstruction

WAY = corridor([ToolPose(0.5, -0.4, TABLE_Z + 0.16, 0.0), ToolPose(0.5, 0.1, TABLE_Z + 0.16, 0.0)])
BOX = ((0.5, -0.15, TABLE_Z), (0.1, 0.1, 0.2))


def check(scene: DrawnScene, way=WAY) -> Obstruction | None:
    return find_obstruction(view_of(scene.picture()), way, Clearance())


def test_a_grey_box_in_the_way_is_seen_where_it_is() -> None:
    found = check(DrawnScene(grey_boxes=[BOX]))
    assert found is not None
    assert np.allclose(found.position[:2], BOX[0][:2], atol=0.08)


@pytest.mark.parametrize(
    "scene",
    [
        DrawnScene(),
        DrawnScene({"green_leg": Resting(0.5, -0.15, TABLE_Z + 0.1)}),
        DrawnScene({"purple_top": Resting(0.5, -0.15, TABLE_Z + 0.1)}, noise=4.0),
        DrawnScene(grey_boxes=[((0.5, -0.15, TABLE_Z), (0.1, 0.1, 0.015))]),
        DrawnScene(grey_boxes=[((0.75, -0.15, TABLE_Z), (0.1, 0.1, 0.2))]),
    ],
    ids=["nothing", "a part", "a part in noise", "something flat", "something beside"],
)
def test_what_is_not_in_the_way_is_let_be(scene: DrawnScene) -> None:
    assert check(scene) is None


def test_no_way_is_never_blocked() -> None:
    assert check(DrawnScene(grey_boxes=[BOX]), way=[]) is None


@pytest.mark.parametrize("taking", ["green_leg", None])
def test_what_carries_a_part_is_not_in_the_way_of_taking_it(taking: str | None) -> None:
    on_top = Resting(0.5, -0.15, TABLE_Z + 0.10)
    pile = [((0.5, -0.15, TABLE_Z), (0.11, 0.11, 0.10))]
    view = view_of(DrawnScene({"green_leg": on_top}, grey_boxes=pile).picture())
    over = ToolPose(0.5, -0.15, TABLE_Z + 0.30, 0.0)
    down = ToolPose(0.5, -0.15, TABLE_Z + 0.13, 0.0)
    found = find_obstruction(view, corridor([over, down]), Clearance(), taking)
    assert (found is None) is (taking is not None)


@pytest.mark.parametrize(("wider_m", "known"), [(0.008, True), (0.06, False)])
def test_the_side_of_what_carries_another_part_is_nothing_unknown(
    wider_m: float, known: bool
) -> None:
    on_top = Resting(0.5, -0.15, TABLE_Z + 0.10)
    carrier = [((0.5, -0.15, TABLE_Z), (0.03 + wider_m, 0.20 + wider_m, 0.10))]
    view = view_of(DrawnScene({"green_leg": on_top}, grey_boxes=carrier).picture())
    beside = corridor(
        [ToolPose(0.44, -0.15, TABLE_Z + 0.3, 0.0), ToolPose(0.44, -0.15, TABLE_Z + 0.05, 0.0)]
    )
    assert (find_obstruction(view, beside, Clearance()) is None) is known


def test_something_beside_a_part_is_in_the_way_of_taking_it() -> None:
    wall = [((0.5, -0.10, TABLE_Z), (0.12, 0.02, 0.15))]
    parts = {"green_leg": Resting(0.5, -0.15, TABLE_Z)}
    view = view_of(DrawnScene(parts, grey_boxes=wall).picture())
    over = ToolPose(0.5, -0.15, TABLE_Z + 0.30, 0.0)
    down = ToolPose(0.5, -0.15, TABLE_Z + 0.05, 0.0)
    assert find_obstruction(view, corridor([over, down]), Clearance(), "green_leg") is not None
