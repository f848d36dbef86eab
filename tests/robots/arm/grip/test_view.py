"""What the colours in a region say of a part, and what stands before the camera hides of it."""

import math

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scripted_body import forearm_pose, tool_matrix

from mend.robots.arm.body import ToolPose
from mend.robots.arm.grip.composition import Composition, likeliest
from mend.robots.arm.grip.view import composition, in_front, outline
from mend.robots.body import CameraImage
from mend.robots.vision.color_model import ColorModel, Sample
from mend.robots.vision.projection import NEAR_M, project
from mend.robots.vision.seen_box import SeenBox

DARK, BRIGHT = (13.0, 18.0, 33.0), (80.0, 140.0, 240.0)
"""BGR of one hue; the first is hardly bright enough to have one."""

GREEN = (80.0, 240.0, 80.0)


def sample(bgr: tuple[float, float, float]) -> Sample:
    return Sample(np.full((40, 40, 3), bgr, np.uint8), np.full((40, 40), 1, np.uint8))


def picture(bgr: tuple[float, float, float]) -> np.ndarray:
    noise = np.random.default_rng(4).normal(0.0, 3.0, (40, 40, 3))
    return np.clip(bgr + noise, 0, 255).astype(np.uint8)


@pytest.mark.parametrize(("own", "other"), [(DARK, BRIGHT), (DARK[::-1], BRIGHT[::-1])])
def test_a_part_that_hardly_has_a_hue_is_not_taken_for_one_that_has(
    own: tuple[float, float, float], other: tuple[float, float, float]
) -> None:
    model = ColorModel.train(
        {"own": [sample(own)], "other": [sample(other)], "green": [sample(GREEN)]}
    )
    assert not model.has_hue("own")
    region = np.full((40, 40), 1, np.uint8)
    assert composition(region, model.segment(picture(own)), model, "own") is None
    swapped = composition(region, model.segment(picture(GREEN)), model, "own")
    assert swapped is not None
    assert swapped.other > 0.5
    assert swapped.most_other == "green"


OLIVE, NAVY = (18.0, 38.0, 46.0), (60.0, 18.0, 14.0)
"""BGR of two dark parts, which have a hue as long as there is light enough."""


def seen_in(light: float, bgr: tuple[float, float, float]) -> Composition | None:
    """What a picture full of one colour says of the olive part."""
    model = ColorModel.train({"olive": [sample(OLIVE)], "navy": [sample(NAVY)]})
    assert model.has_hue("olive")
    dimmed = tuple(light * each for each in bgr)
    region = np.full((40, 40), 1, np.uint8)
    return composition(region, model.segment(picture(dimmed)), model, "olive")


@pytest.mark.parametrize("light", [0.55, 0.6, 0.65, 0.7, 1.0])
def test_a_dark_part_is_not_taken_for_nothing_in_little_light(light: float) -> None:
    """What is too dark to have a hue, as the part itself may be, is no sign against it."""
    seen = seen_in(light, OLIVE)
    assert seen is None or likeliest(seen) == "right"
    table, other = seen_in(light, (190.0, 200.0, 205.0)), seen_in(light, NAVY)
    assert table is not None
    assert likeliest(table) == "nothing"
    assert other is not None
    assert likeliest(other) == "other"


def test_what_is_too_dark_to_be_a_part_is_a_sign_against_it() -> None:
    model = ColorModel.train({"green": [sample(GREEN)], "navy": [sample(NAVY)]})
    region = np.full((40, 40), 1, np.uint8)
    seen = composition(region, model.segment(picture((8.0, 8.0, 8.0))), model, "green")
    assert seen is not None
    assert seen.own == 0.0


TOOL = tool_matrix(ToolPose(0.5, 0.1, 0.76, math.pi / 2))
POSE = forearm_pose(TOOL)
IMAGE = CameraImage(
    bgr=np.zeros((120, 160, 3), np.uint8),
    depth_m=None,
    pose=POSE,
    focal_px=80.0,
    center_px=(79.5, 59.5),
    time=0.0,
)


@given(
    aside_m=st.floats(-0.05, 0.05),
    ahead_m=st.floats(-0.03, 0.1),
    height_m=st.floats(0.02, 0.15),
    side_m=st.floats(0.02, 0.08),
    yaw=st.floats(-1.5, 1.5),
)
def test_whatever_stands_before_the_camera_hides_what_is_behind_it(
    aside_m, ahead_m, height_m, side_m, yaw
) -> None:
    """Also a box that reaches beside the camera, or behind it."""
    eye, forward = POSE[:3, 3], POSE[:3, 2] * (1.0, 1.0, 0.0)
    forward = forward / np.linalg.norm(forward)
    x, y = (eye + ahead_m * forward + aside_m * np.cross(forward, (0.0, 0.0, 1.0)))[:2]
    top_z = eye[2] - 0.02
    size = (side_m, side_m, height_m)
    box = SeenBox(x, y, yaw, size, top_z - height_m, "tower", complete=True)
    hidden = cv2.dilate(outline(IMAGE, TOOL, in_front(IMAGE, TOOL, [box])), np.ones((3, 3)))
    grid = np.linspace(-0.5, 0.5, 7) * 0.98
    local = np.array(
        [(a * side_m, b * side_m, c * height_m) for a in grid for b in grid for c in grid]
    )
    cos, sin = math.cos(yaw), math.sin(yaw)
    points = local @ np.array([[cos, sin, 0], [-sin, cos, 0], [0, 0, 1.0]])
    points += (x, y, top_z - height_m / 2)
    seen = points[(points - eye) @ POSE[:3, 2] > NEAR_M]
    if len(seen) == 0:
        return
    us, vs = np.rint(project(IMAGE, seen)).astype(int).T
    inside = (us >= 0) & (us < 160) & (vs >= 0) & (vs < 120)
    assert hidden[vs[inside], us[inside]].all()
