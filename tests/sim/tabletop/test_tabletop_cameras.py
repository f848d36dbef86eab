"""The tabletop's cameras show what is there, where it is."""

import numpy as np
import pytest
from tabletop_hands import Hands

from mend.robots.body import CameraImage
from mend.sim.tabletop.options import TabletopOptions
from mend.sim.tabletop.world import TabletopWorld
from mend.tasks.scene import Scene


def project(image: CameraImage, point: tuple[float, float, float]) -> tuple[float, float]:
    x, y, z = (np.array(point) - image.pose[:3, 3]) @ image.pose[:3, :3]
    return (
        float(x / z * image.focal_px + image.center_px[0]),
        float(y / z * image.focal_px + image.center_px[1]),
    )


def test_a_pixel_of_the_head_camera_unprojects_onto_the_part_that_it_shows(
    world: TabletopWorld,
) -> None:
    image, ids = world.cameras[0].head.capture_with_ids()
    assert image.depth_m is not None
    rows, columns = np.nonzero(ids == 0)
    depth = image.depth_m[rows, columns].astype(float)
    optical = np.stack(
        [
            (columns - image.center_px[0]) / image.focal_px * depth,
            (rows - image.center_px[1]) / image.focal_px * depth,
            depth,
        ],
        axis=1,
    )
    points = optical @ image.pose[:3, :3].T + image.pose[:3, 3]
    pose = world.pose_of("red")
    assert pose is not None
    low = np.array([pose.x - 0.03, pose.y - 0.015, pose.z])
    high = np.array([pose.x + 0.03, pose.y + 0.015, pose.z + 0.05])
    assert (points >= low - 2e-4).all()
    assert (points <= high + 2e-4).all()


def test_the_forearm_camera_sees_the_held_part_around_the_tool_point(hands: Hands) -> None:
    hands.pick("red")
    for yaw in (-1.0, 0.0, 0.7):
        hands.go(0.6, 0.0, 1.0, yaw)
        image, ids = hands.world.cameras[0].forearm.capture_with_ids()
        rows, columns = np.nonzero(ids == 0)
        u, v = project(image, hands.tool())
        assert len(rows) > 100
        assert columns.mean() == pytest.approx(u, abs=3)
        assert rows.mean() == pytest.approx(v, abs=6)


def test_the_forearm_camera_has_no_depth_and_the_head_camera_has(world: TabletopWorld) -> None:
    assert world.body.cameras["forearm"].capture().depth_m is None
    assert world.body.cameras["head"].capture().depth_m is not None


def test_pictures_carry_the_time_at_which_they_were_taken(hands: Hands) -> None:
    hands.wait(1.0)
    assert hands.body.cameras["forearm"].capture().time == hands.body.time_s()


def test_camera_noise_is_as_strong_as_asked_and_the_same_for_a_seed(scene: Scene) -> None:
    clean = TabletopWorld(scene, seed=1).cameras[0].head.capture().bgr.astype(float)
    noisy = [
        TabletopWorld(scene, seed, TabletopOptions(camera_noise=4.0)).cameras[0].head.capture().bgr
        for seed in (1, 1, 2)
    ]
    assert (noisy[0].astype(float) - clean).std() == pytest.approx(4.0, rel=0.15)
    assert (noisy[0] == noisy[1]).all()
    assert (noisy[0] != noisy[2]).any()
