"""Where a surface may reach, by what is seen of it."""

import math
from dataclasses import replace

import numpy as np
import pytest
from drawn_scene import PARTS, TABLE_Z, DrawnScene, Resting

from mend.robots.vision.evidence import gather
from mend.robots.vision.height_map import measure_heights
from mend.robots.vision.level_rectangle import Rectangle
from mend.robots.vision.level_surfaces import find_surfaces
from mend.robots.vision.rectangle import Fitted, fit_any
from mend.tasks.scene import Table

YAWS = (0.0, 0.4, math.pi / 2, -1.2)


@pytest.mark.parametrize("yaw", YAWS)
def test_an_outline_is_the_rectangle_where_all_sides_are_seen(yaw: float) -> None:
    fitted = Fitted(Rectangle(0.5, -0.2, yaw, (0.10, 0.04)), (True,) * 4, 0.1, 1.0)
    outline = fitted.outline(hidden_m=0.1)
    assert outline.area == pytest.approx(0.10 * 0.04)
    assert outline.centroid.coords[0] == pytest.approx((0.5, -0.2))


@pytest.mark.parametrize("yaw", YAWS)
@pytest.mark.parametrize("side", range(4))
def test_beyond_a_side_that_is_not_seen_it_may_go_on(yaw: float, side: int) -> None:
    seen = tuple(number != side for number in range(4))
    fitted = Fitted(Rectangle(0.5, -0.2, yaw, (0.10, 0.04)), seen, 0.1, 1.0)
    outline = fitted.outline(hidden_m=0.06)
    along, sign = (0.0, math.pi / 2)[side // 2], (-1, 1)[side % 2]
    shift = [sign * 0.03 * each for each in (math.cos(yaw + along), math.sin(yaw + along))]
    assert outline.centroid.coords[0] == pytest.approx((0.5 + shift[0], -0.2 + shift[1]))
    assert outline.area == pytest.approx(0.16 * 0.04 if side < 2 else 0.10 * 0.10)


def test_a_side_without_depth_does_not_make_a_top_wider() -> None:
    """Dark sides have no depth, and the colour of the top."""
    assert max(width_beside_a_dark_side_m(yaw) for yaw in (0.3, 0.5, 0.7, -0.4)) < 0.0335


def width_beside_a_dark_side_m(yaw: float) -> float:
    """How wide 30 mm seem to be."""
    name, table = "green_leg", Table()
    image = DrawnScene({name: Resting(0.5, -0.4, yaw=yaw)}).picture()
    lit = measure_heights(image, table)
    assert lit is not None
    assert image.depth_m is not None
    with np.errstate(invalid="ignore"):
        top_z = TABLE_Z + PARTS[name].size[2]
        side = (lit.height_m > TABLE_Z + 0.003) & (lit.height_m < top_z - 0.002)
        top = np.abs(lit.height_m - top_z) < 0.001
    depth_m = np.where(side, np.nan, image.depth_m).astype(np.float32)
    bgr = np.where(side[..., None], np.median(image.bgr[top], axis=0), image.bgr).astype(np.uint8)
    dark = measure_heights(replace(image, bgr=bgr, depth_m=depth_m), table)
    assert dark is not None
    surfaces = find_surfaces(dark)
    (surface,) = surfaces.all
    return min(fit_any(gather(surface, surfaces)).rectangle.extents)
