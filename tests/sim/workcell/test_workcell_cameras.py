"""Cameras measure truly, both renderers alike, and light and noise are by the seed."""

from collections.abc import Iterator

import numpy as np
import pytest
from numpy.typing import NDArray
from workcell_hands import Hands

from mend.robots.body import CameraImage
from mend.robots.vision.projection import project, unproject
from mend.sim.raster import Light
from mend.sim.workcell.options import WorkcellOptions
from mend.sim.workcell.parts import RigidPart
from mend.sim.workcell.physics import to_matrix
from mend.sim.workcell.rendering import CameraOptics, Renderer, Rendering
from mend.sim.workcell.world import WorkcellWorld
from mend.tasks.intervention import Act, Intervention
from mend.tasks.scene import Pose, Scene


@pytest.fixture(scope="module")
def worlds(scene: Scene) -> Iterator[dict[str, WorkcellWorld]]:
    """The same moment, a part in the gripper, with either renderer."""
    both = {}
    for renderer in ("bullet", "fast"):
        both[renderer] = WorkcellWorld(scene, 5, WorkcellOptions(renderer=renderer))
        Hands(both[renderer]).pick("bar")
    yield both
    for world in both.values():
        world.close()


def capture(
    worlds: dict[str, WorkcellWorld], renderer: str, camera: str
) -> tuple[CameraImage, Rendering]:
    world = worlds[renderer]
    chosen = world.head if camera == "head" else world.forearm
    return chosen.capture_with_bodies()


def mask_of(rendering: Rendering, part: RigidPart) -> NDArray[np.bool_]:
    return np.asarray(rendering.bodies == part.body_id)


@pytest.mark.parametrize("camera", ["head", "forearm"])
def test_both_renderers_draw_the_same(worlds: dict[str, WorkcellWorld], camera: str) -> None:
    (one, reference), (other, fast) = (
        capture(worlds, renderer, camera) for renderer in ("bullet", "fast")
    )
    assert np.array_equal(one.pose, other.pose)
    assert (one.center_px, one.focal_px) == (other.center_px, other.focal_px)
    shared = (reference.depth_m < 3.0) & (fast.depth_m < 3.0)
    assert np.median(np.abs(reference.depth_m - fast.depth_m)[shared]) < 0.001
    difference = np.abs(one.bgr.astype(int) - other.bgr.astype(int))
    assert np.median(difference) <= 4
    for name, part in worlds["fast"].parts.items():
        a, b = mask_of(reference, worlds["bullet"].parts[name]), mask_of(fast, part)
        if a.sum() > 50:
            assert (a & b).sum() / (a | b).sum() > 0.95, name


def test_the_forearm_camera_sees_what_the_gripper_holds(worlds: dict[str, WorkcellWorld]) -> None:
    world = worlds["fast"]
    image, rendering = capture(worlds, "fast", "forearm")
    assert image.depth_m is None
    rows, columns = np.nonzero(mask_of(rendering, world.parts["bar"]))
    assert len(rows) > 100
    tool_u, tool_v = project(image, world.body.tool_pose()[None, :3, 3])[0]
    assert abs(columns.mean() - tool_u) < 20
    assert abs(rows.mean() - tool_v) < 20


@pytest.mark.parametrize("renderer", ["bullet", "fast"])
def test_unprojected_pixels_lie_on_the_parts_surface(scene: Scene, renderer: str) -> None:
    world = WorkcellWorld(scene, 5, WorkcellOptions(renderer=renderer, depth_noise=0.0))
    image, rendering = world.head.capture_with_bodies()
    for name in ("leg", "bar"):
        part = world.parts[name]
        vs, us = np.nonzero(mask_of(rendering, part))
        points = unproject(image, us, vs)
        pose, (sx, sy, sz) = part.pose(), part.definition.size
        frame = to_matrix(pose.position, pose.quaternion)
        local = (points - pose.position) @ frame[:3, :3]
        outside = np.abs(local - (0, 0, sz / 2)) - np.array([sx, sy, sz]) / 2
        distance = np.abs(outside.max(axis=1))
        assert np.sqrt((distance**2).mean()) < 0.001, name
        top = local[np.abs(local[:, 2] - sz) < 0.002]
        middle = (top.max(axis=0) + top.min(axis=0)) / 2
        assert abs(middle[0]) < 0.002, name
        assert abs(middle[1]) < 0.002, name
    world.close()


def test_the_cameras_take_pictures_as_often_as_the_renderer_can(
    worlds: dict[str, WorkcellWorld],
) -> None:
    assert worlds["bullet"].body.cameras["forearm"].period_s == pytest.approx(1 / 10)
    assert worlds["fast"].body.cameras["forearm"].period_s == pytest.approx(1 / 30)


def test_noise_changes_pictures_by_its_deviation(scene: Scene) -> None:
    world = WorkcellWorld(scene, 5, WorkcellOptions(camera_noise=4.0))
    one = world.head.capture().bgr.astype(float)
    world.body.advance_cycle()
    other = world.head.capture().bgr.astype(float)
    inner = (one > 30) & (one < 225) & (other > 30) & (other < 225)
    assert (one - other)[inner].std() == pytest.approx(4.0 * np.sqrt(2), rel=0.1)
    world.close()


def test_one_moment_has_one_picture(scene: Scene) -> None:
    world = WorkcellWorld(scene, 5, WorkcellOptions(camera_noise=4.0))
    picture = world.head.capture()
    assert world.head.capture() is picture
    world.body.advance_cycle()
    assert world.head.capture() is not picture
    world.close()


def test_a_picture_shows_what_a_person_did_in_the_same_moment(scene: Scene) -> None:
    world = WorkcellWorld(scene, 5)
    before = world.head.capture()
    assert not world.intervene(Intervention(act=Act.STEAL, object=next(iter(scene.objects))))
    after = world.head.capture()
    assert after.time == before.time
    assert (after.bgr != before.bgr).any()
    world.close()


def test_light_varies_with_the_seed_and_only_then(scene: Scene) -> None:
    brightness = []
    for seed, light in ((1, 0.0), (2, 0.0), (1, 1.0), (2, 1.0)):
        world = WorkcellWorld(scene, seed, WorkcellOptions(light=light))
        # A patch of the table in front of the camera, where no part is.
        brightness.append(world.head.capture().bgr[100:110, 100:110].mean())
        world.close()
    assert brightness[0] == brightness[1]
    assert len({round(each, 1) for each in brightness}) == 3


def test_the_same_seed_gives_the_same_pictures(scene: Scene) -> None:
    pictures = []
    for _ in range(2):
        world = WorkcellWorld(scene, 6, WorkcellOptions(camera_noise=2.0, light=1.0))
        pictures.append(world.head.capture().bgr)
        world.close()
    assert np.array_equal(*pictures)


class CountingRenderer:
    """Counts how often it draws."""

    def __init__(self, renderer: Renderer) -> None:
        self._renderer = renderer
        self.drawn = 0

    def render(self, view: CameraOptics, light: Light) -> Rendering:
        self.drawn += 1
        return self._renderer.render(view, light)


def test_what_has_not_moved_is_drawn_once_but_measured_each_time(scene: Scene) -> None:
    world = WorkcellWorld(scene, 5, WorkcellOptions(depth_noise=1.0))
    for _ in range(60):
        world.body.advance_cycle()
    renderer = world.head._renderer = CountingRenderer(world.head._renderer)
    pictures = []
    for _ in range(5):
        pictures.append(world.head.capture())
        world.body.advance_cycle()
    assert renderer.drawn == 1
    assert not np.array_equal(pictures[0].depth_m, pictures[4].depth_m, equal_nan=True)
    x, y, _ = world.parts["leg"].pose().position
    away = Intervention(act=Act.MOVE, object="leg", to=Pose(x=x + 0.05, y=y))
    assert world.intervene(away) == ""
    world.head.capture()
    assert renderer.drawn == 2
    world.close()
