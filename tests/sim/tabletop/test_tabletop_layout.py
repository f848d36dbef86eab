"""Whatever a tree names is laid out so that the robot can see, tell apart and reach it."""

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mend.errors import WrongInputError
from mend.robots.arm.body import ToolPose
from mend.sim.tabletop.adapter import adapter
from mend.sim.tabletop.layout import MOST_OBJECTS, distinct_colors, lay_out
from mend.sim.tabletop.world import TabletopWorld
from mend.tasks.definition import BehaviorNode


@given(
    objects=st.integers(1, MOST_OBJECTS),
    places=st.integers(0, MOST_OBJECTS),
    seed=st.integers(0, 99),
)
@settings(max_examples=30, deadline=None)
def test_everything_is_on_the_table_in_reach_and_apart(
    objects: int, places: int, seed: int
) -> None:
    count = max(objects, places)
    names = [(f"o{i % objects}", f"p{i % places}" if places else None) for i in range(count)]
    scene = lay_out(names, seed)
    assert set(scene.objects) == {f"o{i}" for i in range(objects)}
    assert set(scene.places) == {f"p{i}" for i in range(places)}

    world = TabletopWorld(scene, seed)
    poses = [each.pose for each in (*scene.objects.values(), *scene.places.values())]
    for pose in poses:
        assert abs(pose.x - scene.table.center[0]) <= scene.table.size[0] / 2 - 0.05
        assert abs(pose.y - scene.table.center[1]) <= scene.table.size[1] / 2 - 0.05
        if places:
            above = ToolPose(pose.x, pose.y, scene.table.height + 0.2, 0.0)
            assert world.body.plan_path([above]) is not None
    spots = np.array([(pose.x, pose.y) for pose in poses])
    apart = np.linalg.norm(spots[:, None] - spots[None], axis=2) + np.eye(len(spots))
    assert apart.min() > 0.10


def test_the_same_seed_lays_out_the_same_scene_and_another_does_not() -> None:
    names = [(f"o{i}", f"p{i}") for i in range(8)]
    assert lay_out(names, 1) == lay_out(names, 1)
    assert lay_out(names, 1) != lay_out(names, 2)


@pytest.mark.parametrize("kind", ["objects", "places"])
def test_more_than_fits_is_refused_in_a_sentence(kind: str) -> None:
    names = [
        (f"o{i}", "p") if kind == "objects" else ("o", f"p{i}") for i in range(MOST_OBJECTS + 1)
    ]
    with pytest.raises(WrongInputError, match=f"at most {MOST_OBJECTS} {kind}, this tree names 65"):
        lay_out(names, 0)


@pytest.mark.parametrize("count", [1, 6, 17, MOST_OBJECTS])
def test_colors_stay_apart_in_hue_and_saturation_when_shaded(count: int) -> None:
    bins: dict[tuple[int, int], int] = {}
    for index, color in enumerate(distinct_colors(count)):
        for shade in np.linspace(0.5, 1.0, 11):
            bgr = np.uint8([[[channel * 255 * shade for channel in color[::-1]]]])
            hue, saturation, _ = cv2.cvtColor(bgr, cv2.COLOR_BGR2HSV)[0, 0].tolist()
            key = (hue // 6, saturation // 16)
            assert bins.setdefault(key, index) == index


def test_every_object_is_seen_by_the_head_camera_even_in_the_fullest_scene() -> None:
    names = [(f"o{i}", f"p{i}") for i in range(MOST_OBJECTS)]
    world = TabletopWorld(lay_out(names, 4), seed=0)
    _, ids = world.cameras[0].head.capture_with_ids()
    counts = np.bincount(ids[(ids >= 0) & (ids < MOST_OBJECTS)], minlength=MOST_OBJECTS)
    assert counts.min() >= 30


@pytest.mark.parametrize("count", [1, 2, 7, 20, MOST_OBJECTS])
def test_what_is_laid_out_can_be_done(count: int) -> None:
    names = [(f"part_{number}", f"spot_{number}") for number in range(count)]
    leaves = [
        BehaviorNode(
            parent=0,
            name=name,
            behavior="pick_and_place",
            parameters={"object": name, "place": place},
        )
        for name, place in names
    ]
    assert adapter.check_scene(lay_out(names, seed=count), leaves) == []
