"""The software camera agrees with the geometry that it draws."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from mend.robots.body import Matrix4
from mend.sim.raster import Light, Mesh, Rasterizer, box_triangles

SIZE = (160, 120)
FOCAL = SIZE[1] / 2 / math.tan(math.radians(60) / 2)
CENTER = ((SIZE[0] - 1) / 2, (SIZE[1] - 1) / 2)


def looking_down(height_m: float) -> Matrix4:
    pose = np.diag([1.0, -1.0, -1.0, 1.0])
    pose[2, 3] = height_m
    return pose


def at(x: float, y: float, z: float, yaw: float = 0.0) -> Matrix4:
    pose = np.eye(4)
    pose[:2, :2] = [[math.cos(yaw), -math.sin(yaw)], [math.sin(yaw), math.cos(yaw)]]
    pose[:3, 3] = x, y, z
    return pose


def unproject(depth_m: NDArray[np.float32], camera: Matrix4) -> NDArray[np.float64]:
    v, u = np.mgrid[: depth_m.shape[0], : depth_m.shape[1]]
    depth = depth_m.astype(float)
    points = np.stack(
        [(u - CENTER[0]) / FOCAL * depth, (v - CENTER[1]) / FOCAL * depth, depth], axis=-1
    )
    return np.asarray(points @ camera[:3, :3].T + camera[:3, 3])


def tilted_camera() -> Matrix4:
    tilt = 0.5
    pose = looking_down(0.8)
    pose[1, 3] = -0.8 * math.tan(tilt)
    turn = np.eye(4)
    turn[1:3, 1:3] = [[math.cos(tilt), -math.sin(tilt)], [math.sin(tilt), math.cos(tilt)]]
    return np.asarray(pose @ turn)


@given(x=st.floats(-0.1, 0.1), y=st.floats(-0.1, 0.1), yaw=st.floats(-3.0, 3.0), tilt=st.booleans())
@settings(max_examples=40, deadline=None)
def test_unprojected_pixels_lie_on_the_box_that_they_show(
    x: float, y: float, yaw: float, tilt: bool
) -> None:
    size = np.array([0.12, 0.08, 0.06])
    pose = at(x, y, 0.1, yaw)
    camera = tilted_camera() if tilt else looking_down(0.7)
    image = Rasterizer([Mesh(box_triangles(size), (1, 0, 0))]).render(
        pose[None], camera, SIZE, FOCAL
    )

    shown = image.ids == 0
    points = unproject(image.depth_m, camera)[shown]
    local = (points - pose[:3, 3]) @ pose[:3, :3]
    off_surface = np.abs((np.abs(local) - size / 2).max(axis=1))

    assert shown.sum() > 50
    assert off_surface.max() < 0.0002


def test_the_outline_is_where_the_corners_project() -> None:
    size = (0.2, 0.1, 0.1)
    camera = looking_down(1.0)
    image = Rasterizer([Mesh(box_triangles(size), (0, 1, 0))]).render(
        at(0.03, -0.02, 0.0)[None], camera, SIZE, FOCAL
    )
    rows, columns = np.nonzero(image.ids == 0)
    top_m = 1.0 - 0.05

    def column(x: float) -> float:
        return FOCAL * x / top_m + CENTER[0]

    def row(y: float) -> float:
        return -FOCAL * y / top_m + CENTER[1]

    assert columns.min() == math.ceil(column(0.03 - 0.1))
    assert columns.max() == math.floor(column(0.03 + 0.1))
    assert rows.min() == math.ceil(row(-0.02 + 0.05))
    assert rows.max() == math.floor(row(-0.02 - 0.05))


def test_the_nearer_object_hides_the_farther_whatever_their_order() -> None:
    box = box_triangles((0.1, 0.1, 0.1))
    meshes = [Mesh(box, (1, 0, 0)), Mesh(box, (0, 0, 1))]
    for near, far in ((0, 1), (1, 0)):
        poses = np.tile(np.eye(4), (2, 1, 1))
        poses[near, 2, 3] = 0.3
        image = Rasterizer(meshes).render(poses, looking_down(1.0), SIZE, FOCAL)
        assert set(np.unique(image.ids)) <= {-1, near, far}
        assert image.ids[60, 80] == near
        assert image.depth_m[60, 80] == pytest.approx(0.65, abs=1e-5)


def test_only_what_is_in_front_of_the_near_plane_is_drawn() -> None:
    long_box = Mesh(box_triangles((0.05, 0.05, 4.0)), (1, 1, 0))
    camera = looking_down(0.5)
    camera[0, 3] = 0.1
    image = Rasterizer([long_box]).render(np.eye(4)[None], camera, SIZE, FOCAL, near_m=0.1)
    shown = image.depth_m[image.ids == 0]
    assert len(shown) > 0
    assert shown.min() >= 0.1 - 1e-6
    assert np.isfinite(image.depth_m).all()


def test_from_inside_a_closed_surface_nothing_is_seen() -> None:
    room = Mesh(box_triangles((2.0, 2.0, 2.0)), (1, 1, 1))
    image = Rasterizer([room]).render(
        np.eye(4)[None], looking_down(0.5), SIZE, FOCAL, far_m=7.0, background=(10, 20, 30)
    )
    assert (image.ids == -1).all()
    assert (image.depth_m == np.float32(7.0)).all()
    assert (image.bgr == (10, 20, 30)).all()


def test_a_face_is_as_bright_as_it_is_turned_to_the_light() -> None:
    mesh = Mesh(box_triangles((0.3, 0.3, 0.3)), (0.5, 0.25, 1.0))
    light = Light(direction=(0.0, math.sin(1.0), math.cos(1.0)), ambient=0.4, diffuse=0.6)
    image = Rasterizer([mesh]).render(np.eye(4)[None], looking_down(1.0), SIZE, FOCAL, light=light)
    shade = 0.4 + 0.6 * math.cos(1.0)
    expected = np.array([1.0, 0.25, 0.5]) * 255 * shade
    assert np.abs(image.bgr[60, 80].astype(float) - expected).max() <= 1.0


def test_meshes_can_be_hidden_and_repainted() -> None:
    rasterizer = Rasterizer([Mesh(box_triangles((0.1, 0.1, 0.1)), (1, 0, 0))])
    pose = np.eye(4)[None]
    hidden = rasterizer.render(pose, looking_down(1.0), SIZE, FOCAL, visible=np.array([False]))
    green = rasterizer.render(
        pose,
        looking_down(1.0),
        SIZE,
        FOCAL,
        light=Light(ambient=1.0, diffuse=0.0),
        colors=np.array([[0.0, 1.0, 0.0]]),
    )
    assert (hidden.ids == -1).all()
    assert green.bgr[60, 80].tolist() == [0, 255, 0]


def test_a_surface_of_many_triangles_has_no_cracks() -> None:
    n = 20
    corners = np.linspace(-0.5, 0.5, n + 1)
    triangles = []
    for i in range(n):
        for j in range(n):
            a, b = (corners[i], corners[j], 0.0), (corners[i + 1], corners[j], 0.0)
            c, d = (corners[i + 1], corners[j + 1], 0.0), (corners[i], corners[j + 1], 0.0)
            triangles += [(a, b, c), (a, c, d)]
    image = Rasterizer([Mesh(np.array(triangles), (1, 1, 1))]).render(
        at(0.0, 0.0, 0.0, 0.37)[None], looking_down(0.3), SIZE, FOCAL
    )
    assert (image.ids == 0).all()


@pytest.mark.parametrize("shape", [(3, 3), (4, 2, 3)])
def test_misshapen_triangles_are_refused(shape: tuple[int, ...]) -> None:
    with pytest.raises(ValueError, match="expected \\(n, 3, 3\\)"):
        Rasterizer([Mesh(np.zeros(shape), (1, 1, 1))])


def test_as_many_transforms_as_meshes_are_required() -> None:
    with pytest.raises(ValueError, match="expected \\(1, 4, 4\\)"):
        Rasterizer([Mesh(box_triangles((1, 1, 1)), (1, 1, 1))]).render(
            np.zeros((2, 4, 4)), looking_down(1.0), SIZE, FOCAL
        )
