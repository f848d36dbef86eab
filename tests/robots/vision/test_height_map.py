"""Rays of a camera: kept while it stands still, its own once it has moved."""

from dataclasses import replace

import numpy as np
import pytest
from drawn_scene import DrawnScene, Resting

from mend.robots.vision.height_map import ground_rays
from mend.robots.vision.projection import project

SCENE = DrawnScene({"green_leg": Resting(0.5, -0.2)})


def test_a_pixel_sees_what_its_ray_meets() -> None:
    image = SCENE.picture()
    rays = ground_rays(image)
    point = image.pose[:3, 3] + 1.2 * rays[:, 300, 200]
    assert project(image, point[None])[0] == pytest.approx((200, 300))


def test_every_fourth_ray_is_the_same_ray() -> None:
    image = SCENE.picture()
    assert np.array_equal(ground_rays(image, every=4), ground_rays(image)[:, ::4, ::4])


def test_a_camera_that_has_moved_has_other_rays() -> None:
    image = SCENE.picture()
    before = ground_rays(image)
    turned = image.pose.copy()
    turned[:3, :2] = image.pose[:3, 1::-1] * (1.0, -1.0)
    assert not np.allclose(ground_rays(replace(image, pose=turned)), before)
    assert ground_rays(image) is before


def test_nobody_writes_to_what_is_kept() -> None:
    with pytest.raises(ValueError, match="read-only"):
        ground_rays(SCENE.picture())[0, 0, 0] = 1.0
