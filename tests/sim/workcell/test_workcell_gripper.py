"""The PR2's gripper model against its meshes: how fingers swing, the room that they take."""

import coal
import numpy as np
import pinocchio as pin
import pytest

from mend.robots.arm.gripper import ToolBox
from mend.sim.workcell.gripper import (
    FINGERS_OPEN_RAD,
    PR2_GRIPPER,
    finger_angle_rad,
    inner_side_m,
)
from mend.sim.workcell.robot_model import FINGER_JOINTS, TOOL_FRAME, robot_urdf

ANGLES = (0.02, 0.1, 0.2, 0.3, 0.4, FINGERS_OPEN_RAD)
CLOSE_M = 0.0006


def corners(angle_rad: float, links: str) -> np.ndarray:
    """The meshes' corners (n, 3) in the tool frame: down, along the opening direction, across."""
    urdf = robot_urdf()
    model = pin.buildModelFromUrdf(str(urdf))
    shapes = pin.buildGeomFromUrdf(
        model, str(urdf), pin.GeometryType.VISUAL, package_dirs=[str(urdf.parent)]
    )
    whole = pin.neutral(model)
    for name in FINGER_JOINTS:
        whole[model.joints[model.getJointId(name)].idx_q] = angle_rad
    data, placed = model.createData(), pin.GeometryData(shapes)
    pin.updateGeometryPlacements(model, data, shapes, placed, whole)
    pin.updateFramePlacements(model, data)
    tool = data.oMf[model.getFrameId(TOOL_FRAME)]
    points = [
        (tool.actInv(placed.oMg[index])).act(np.asarray(vertex))
        for index, each in enumerate(shapes.geometryObjects)
        if links in each.name and isinstance(each.geometry, coal.BVHModelBase)
        for vertex in each.geometry.vertices()
    ]
    return np.array(points)


@pytest.mark.parametrize("angle_rad", ANGLES)
def test_the_opening_and_the_reach_of_the_tips_are_those_of_the_meshes(angle_rad: float) -> None:
    tip = corners(angle_rad, "l_finger_tip")
    opening_m = 2 * inner_side_m(angle_rad)
    assert 2 * tip[:, 1].min() == pytest.approx(opening_m, abs=2e-4)
    assert tip[:, 0].max() == pytest.approx(PR2_GRIPPER.reach_below_m(opening_m), abs=5e-4)
    assert finger_angle_rad(opening_m) == pytest.approx(angle_rad, abs=1e-9)


@pytest.mark.parametrize("angle_rad", ANGLES)
def test_fingers_and_palm_are_within_the_room_that_is_kept_for_them(angle_rad: float) -> None:
    inner_m = inner_side_m(angle_rad)
    rooms = PR2_GRIPPER.boxes(2 * inner_m)
    for down_m, along_m, aside_m in corners(angle_rad, "gripper"):
        if abs(along_m) < inner_m:
            # Between the fingers is only what they grasp.
            continue
        assert any(_holds(room, -down_m, along_m, aside_m) for room in rooms), (
            f"{1e3 * along_m:.1f} mm along, {1e3 * aside_m:.1f} aside, {-1e3 * down_m:.1f} up"
        )


def test_fingers_that_close_stay_within_the_room_that_is_kept_for_that() -> None:
    closed_rad, open_rad = 0.1, 0.4
    closed_m, opening_m = 2 * inner_side_m(closed_rad), 2 * inner_side_m(open_rad)
    rooms = PR2_GRIPPER.swept_boxes(closed_m, opening_m)
    for angle_rad in np.linspace(closed_rad, open_rad, 7):
        inner_m = inner_side_m(angle_rad)
        outside = [each for each in corners(angle_rad, "gripper") if abs(each[1]) >= inner_m]
        assert all(any(_holds(room, -x, y, z) for room in rooms) for x, y, z in outside)


def test_the_room_of_fingers_that_stay_apart_is_that_of_the_opening() -> None:
    assert PR2_GRIPPER.swept_boxes(0.05, 0.05) == PR2_GRIPPER.boxes(0.05)


def test_a_gripper_never_opens_or_closes_further_than_it_goes() -> None:
    assert finger_angle_rad(1.0) == FINGERS_OPEN_RAD
    assert finger_angle_rad(-0.1) == 0.0
    assert PR2_GRIPPER.max_width_m < PR2_GRIPPER.max_opening_m


def _holds(room: ToolBox, up_m: float, along_m: float, aside_m: float) -> bool:
    return (
        up_m >= room.bottom_m - CLOSE_M
        and abs(along_m - room.along_m) <= room.length_m / 2 + CLOSE_M
        and abs(aside_m - room.aside_m) <= room.width_m / 2 + CLOSE_M
    )
