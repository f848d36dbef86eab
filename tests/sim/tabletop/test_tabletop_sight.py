"""What a robot makes of noisy pictures: every part by its name, equal ones kept apart."""

import itertools
import math
from collections.abc import Mapping

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sampled import sample

from mend.robots.arm.perception import Perception
from mend.robots.catalogue import Catalogue
from mend.robots.link.messages import Location
from mend.robots.vision.presence import Presence
from mend.sim.tabletop.colors import learn_colors
from mend.sim.tabletop.options import TabletopOptions
from mend.sim.tabletop.world import TabletopWorld
from mend.tasks.intervention import Act, Intervention
from mend.tasks.scene import Pose, Scene, SceneObject, Table
from mend.tasks.scene_file import built_in_scene

NOISY = TabletopOptions(camera_noise=4.0, light=1.0, depth_noise=1.0)
BOLT = SceneObject(color=(0.2, 0.5, 0.8), size=(0.024, 0.04, 0.03), pose=Pose(x=0.5, y=0.0))


def scene_of(objects: Mapping[str, SceneObject]) -> Scene:
    return Scene(name="seen", objects=dict(objects), places={})


def at(x: float, y: float, yaw: float = 0.0, z: float | None = None, **changes) -> SceneObject:
    pose = Pose(x=x, y=y, z=z, yaw=yaw)
    return BOLT.model_copy(update={"pose": pose, **changes})


class Watcher:
    """A world and the perception of its robot."""

    def __init__(self, scene: Scene, seed: int = 1, options: TabletopOptions = NOISY) -> None:
        self.world = TabletopWorld(scene, seed, options)
        self.catalogue = Catalogue.from_scene(scene)
        self.perception = Perception(self.world.body, learn_colors(scene, options), self.catalogue)

    def seen(self) -> dict[str, tuple[float, float]]:
        sightings = self.perception.head.sight_all(self.perception.head.look())
        return {name: (each.x, each.y) for name, each in sightings.items()}

    def do(self, act: Act, name: str, **more) -> None:
        assert self.world.intervene(Intervention(act=act, object=name, **more)) == ""

    def presence(
        self, name: str, x: float, y: float, z: float | None = None, yaw: float = 0.0
    ) -> Presence:
        part, at = self.catalogue.parts[name], Location(x=x, y=y, z=z, yaw=yaw)
        return self.perception.head.presence(self.perception.head.look(), part, at)


def near(one: tuple[float, float], other: tuple[float, float], within_m: float = 0.004) -> bool:
    return math.dist(one, other) < within_m


@pytest.mark.parametrize("name", ["eket", "tea_table", "workshop"])
def test_every_part_of_the_shipped_scenes_is_seen_where_it_is(name: str) -> None:
    watcher = Watcher(built_in_scene(name))
    seen = watcher.seen()
    for part in watcher.catalogue.parts:
        truth = watcher.world.pose_of(part)
        assert truth is not None
        assert near(seen[part], (truth.x, truth.y)), part
    assert all(
        box.name is not None
        for box in watcher.perception.head.seen_boxes(watcher.perception.head.look())
    )


def test_equal_parts_start_with_the_names_that_the_scene_gives_them() -> None:
    spots = {f"bolt_{i}{j}": (0.42 + 0.05 * i, -0.5 + 0.06 * j) for i in range(5) for j in range(5)}
    watcher = Watcher(scene_of({name: at(*spot) for name, spot in spots.items()}))
    seen = watcher.seen()
    assert all(near(seen[name], spot) for name, spot in spots.items())


@pytest.mark.parametrize("lower", ["bolt_0", "bolt_1"])
def test_of_equal_parts_on_one_another_the_upper_one_is_seen(lower: str) -> None:
    upper = {"bolt_0": "bolt_1", "bolt_1": "bolt_0"}[lower]
    stack = {lower: at(0.5, -0.2), upper: at(0.5, -0.2, z=0.73)}
    assert set(Watcher(scene_of(stack)).seen()) == {upper}


def test_a_stolen_equal_is_the_one_that_is_missing_and_comes_back_as_itself() -> None:
    spots = {f"bolt_{i}": (0.42 + 0.05 * i, -0.3) for i in range(5)}
    watcher = Watcher(scene_of({name: at(*spot) for name, spot in spots.items()}))
    watcher.seen()
    watcher.do(Act.STEAL, "bolt_2")
    assert set(watcher.seen()) == set(spots) - {"bolt_2"}
    watcher.do(Act.MOVE, "bolt_2", to=Pose(x=0.6, y=0.1))
    seen = watcher.seen()
    assert near(seen.pop("bolt_2"), (0.6, 0.1))
    assert all(near(where, spots[name]) for name, where in seen.items())


@pytest.mark.parametrize("wanted", ["bolt_1", "bolt_3"])
@pytest.mark.parametrize("brought", ["bolt_1", "bolt_3"])
def test_of_equals_that_are_gone_the_one_that_is_wanted_is_brought_back(
    wanted: str, brought: str
) -> None:
    spots = {f"bolt_{i}": (0.42 + 0.05 * i, -0.3) for i in range(5)}
    watcher = Watcher(scene_of({name: at(*spot) for name, spot in spots.items()}))
    watcher.seen()
    for gone in ("bolt_1", "bolt_3"):
        watcher.do(Act.STEAL, gone)
    assert set(watcher.seen()) == {"bolt_0", "bolt_2", "bolt_4"}
    watcher.perception.head.want(watcher.catalogue.parts[wanted])
    watcher.do(Act.MOVE, brought, to=Pose(x=0.6, y=0.1))
    seen = watcher.seen()
    assert near(seen.pop(wanted), (0.6, 0.1))
    assert set(seen) == {"bolt_0", "bolt_2", "bolt_4"}
    assert all(near(where, spots[name]) for name, where in seen.items())


def test_what_is_wanted_takes_no_equal_from_where_that_stands() -> None:
    spots = {f"bolt_{i}": (0.42 + 0.05 * i, -0.3) for i in range(5)}
    watcher = Watcher(scene_of({name: at(*spot) for name, spot in spots.items()}))
    watcher.seen()
    watcher.do(Act.STEAL, "bolt_2")
    watcher.perception.head.want(watcher.catalogue.parts["bolt_2"])
    seen = watcher.seen()
    assert set(seen) == set(spots) - {"bolt_2"}
    assert all(near(where, spots[name]) for name, where in seen.items())


@settings(max_examples=sample(6, 15), deadline=None)
@given(
    moves=st.lists(st.tuples(st.integers(0, 4), st.integers(0, 11)), min_size=1, max_size=6),
    seed=st.integers(0, 1000),
)
def test_names_stay_with_equal_parts_that_are_moved_one_by_one(moves, seed: int) -> None:
    free = [(0.42 + 0.06 * i, -0.45 + 0.08 * j) for i in range(4) for j in range(4)]
    spots = dict(zip((f"bolt_{i}" for i in range(4)), free, strict=False))
    del free[:4]
    watcher = Watcher(scene_of({name: at(*spot) for name, spot in spots.items()}), seed)
    watcher.seen()
    for number, to in moves:
        name = f"bolt_{number % 4}"
        spot = free[to % len(free)]
        free.append(spots[name])
        free.remove(spot)
        spots[name] = spot
        watcher.do(Act.MOVE, name, to=Pose(x=spot[0], y=spot[1]))
        seen = watcher.seen()
        assert all(near(seen[each], where) for each, where in spots.items())


@pytest.mark.parametrize("yaw", [0.0, 0.6, -1.2])
def test_equal_boxes_a_finger_apart_are_told_apart(yaw: float) -> None:
    gap_m = 0.008
    along, aside = BOLT.size[0] + gap_m, BOLT.size[1] + gap_m
    cos, sin = math.cos(yaw), math.sin(yaw)
    spots = {
        f"bolt_{i}{j}": (
            0.5 + cos * i * along - sin * j * aside,
            -0.2 + sin * i * along + cos * j * aside,
        )
        for i, j in itertools.product(range(3), range(3))
    }
    watcher = Watcher(scene_of({name: at(*spot, yaw=yaw) for name, spot in spots.items()}))
    seen = watcher.seen()
    assert all(near(seen[name], spot) for name, spot in spots.items())


def test_parts_of_one_color_are_told_apart_by_size() -> None:
    sizes = {"s": (0.02, 0.03, 0.03), "m": (0.03, 0.04, 0.03), "l": (0.03, 0.04, 0.045)}
    objects = {
        name: at(0.45 + 0.07 * i, -0.3 + 0.05 * i, 0.3 * i, size=size)
        for i, (name, size) in enumerate(sizes.items())
    }
    watcher = Watcher(scene_of(objects))
    seen = watcher.seen()
    assert all(near(seen[name], (each.pose.x, each.pose.y)) for name, each in objects.items())


@pytest.mark.parametrize("color", [(0.72, 0.70, 0.68), (0.2, 0.2, 0.2), (0.9, 0.9, 0.9)])
def test_a_grey_part_is_seen_by_its_depth(color) -> None:
    watcher = Watcher(scene_of({"grey": at(0.5, -0.2, 0.4, color=color), "blue": at(0.6, 0.0)}))
    seen = watcher.seen()
    assert near(seen["grey"], (0.5, -0.2))
    assert near(seen["blue"], (0.6, 0.0))


def test_a_tower_of_equal_parts_is_seen_from_the_top() -> None:
    table_z = 0.70
    parts = {
        "low": at(0.5, -0.2, size=(0.06, 0.08, 0.03)),
        "high": at(0.5, -0.2, 0.5, table_z + 0.03, size=(0.03, 0.04, 0.03)),
    }
    watcher = Watcher(scene_of(parts))
    sightings = watcher.perception.head.sight_all(watcher.perception.head.look())
    assert sightings["high"].z == pytest.approx(table_z + 0.03, abs=0.002)
    assert sightings["low"].z == pytest.approx(table_z, abs=0.002)
    assert near((sightings["low"].x, sightings["low"].y), (0.5, -0.2))


def test_of_equal_parts_the_one_that_stands_at_a_place_is_the_one_that_belongs_there() -> None:
    height_m, table_z = 0.047, 0.70
    size = (0.055, 0.06, height_m)
    watcher = Watcher(
        scene_of(
            {
                "low": at(0.493, -0.524, -1.2, size=size),
                "middle": at(0.497, -0.527, 2.2, table_z + height_m, size=size),
                "high": at(0.492, -0.521, 0.6, table_z + 2 * height_m, size=size),
            }
        )
    )
    perception, target = watcher.perception, Location(x=0.57, y=-0.35, yaw=0.9)
    high = watcher.catalogue.parts["high"]
    watcher.seen()
    assert not perception.head.recognize_at(perception.head.look(), high, target)
    watcher.do(Act.MOVE, "high", to=Pose(x=0.57, y=-0.35, yaw=0.9))
    assert perception.head.recognize_at(perception.head.look(), high, target)
    assert near(watcher.seen()["high"], (0.57, -0.35))
    watcher.do(Act.STEAL, "high")
    assert not perception.head.recognize_at(perception.head.look(), high, target)


def test_a_part_that_is_seen_elsewhere_is_not_hidden_at_its_place() -> None:
    size = (0.06, 0.05, 0.05)
    watcher = Watcher(
        scene_of(
            {
                "part": at(0.5, -0.2, size=size),
                "below": at(0.6, 0.0, size=size, color=(0.8, 0.2, 0.1)),
            }
        )
    )
    watcher.do(Act.MOVE, "part", to=Pose(x=0.6, y=0.0))
    pose = watcher.world.pose_of("part")
    assert pose is not None
    assert pose.z == pytest.approx(0.75)
    assert watcher.presence("part", 0.6, 0.0) is Presence.GONE
    assert watcher.presence("part", 0.6, 0.0, 0.75) is Presence.THERE


def test_something_unknown_is_a_box_without_a_name() -> None:
    scene = scene_of({"known": at(0.5, -0.2), "stranger": at(0.6, 0.0, size=(0.05, 0.09, 0.06))})
    watcher = Watcher(scene)
    known = {"known": watcher.catalogue.parts["known"]}
    perception = Perception(
        watcher.world.body,
        learn_colors(scene, NOISY),
        Catalogue(known, {}, scene.table, watcher.catalogue.starts),
    )
    (stranger,) = [
        box for box in perception.head.seen_boxes(perception.head.look()) if box.name is None
    ]
    assert near((stranger.x, stranger.y), (0.6, 0.0))
    assert sorted(stranger.size) == pytest.approx([0.05, 0.06, 0.09], abs=0.003)


def test_presence_tells_there_gone_and_hidden() -> None:
    watcher = Watcher(
        scene_of(
            {
                "part": at(0.6, 0.0),
                "equal": at(0.45, -0.4),
                "other": at(0.45, -0.3, size=(0.05, 0.05, 0.05), color=(0.8, 0.2, 0.1)),
                "wall": at(0.45, 0.2, size=(0.03, 0.2, 0.3), color=(0.1, 0.7, 0.2)),
            }
        )
    )
    assert watcher.presence("part", 0.6, 0.0) is Presence.THERE
    assert watcher.presence("equal", 0.6, 0.0) is Presence.THERE
    watcher.do(Act.MOVE, "wall", to=Pose(x=0.5, y=0.0))
    assert watcher.presence("part", 0.6, 0.0) is Presence.HIDDEN
    watcher.do(Act.MOVE, "wall", to=Pose(x=0.45, y=0.25))
    watcher.do(Act.STEAL, "part")
    assert watcher.presence("part", 0.6, 0.0) is Presence.GONE
    watcher.do(Act.MOVE, "other", to=Pose(x=0.6, y=0.0))
    assert watcher.presence("part", 0.6, 0.0) is Presence.GONE
    watcher.do(Act.MOVE, "other", to=Pose(x=0.45, y=-0.3))
    watcher.do(Act.MOVE, "equal", to=Pose(x=0.6, y=0.0))
    assert watcher.presence("part", 0.6, 0.0) is Presence.THERE


@settings(max_examples=sample(10, 20), deadline=None)
@given(
    x=st.floats(0.42, 0.68),
    y=st.floats(-0.55, 0.15),
    yaw=st.floats(-1.5, 1.5),
    size=st.tuples(st.floats(0.015, 0.11), st.floats(0.015, 0.06), st.floats(0.012, 0.09)),
    seed=st.integers(0, 1000),
)
def test_a_part_alone_is_there_where_it_is_and_gone_where_it_is_not(
    x: float, y: float, yaw: float, size: tuple[float, float, float], seed: int
) -> None:
    size = tuple(float(np.round(side, 3)) for side in size)
    watcher = Watcher(scene_of({"part": at(x, y, yaw, size=size)}), seed)
    assert watcher.presence("part", x, y, yaw=yaw) is Presence.THERE
    oblong_m = abs(size[0] - size[1])
    if oblong_m > 0.008:
        assert watcher.presence("part", x, y, yaw=yaw + math.pi / 2) is Presence.GONE
    elsewhere = -0.55 if y > -0.2 else 0.15
    assert watcher.presence("part", x, elsewhere) is Presence.GONE
    watcher.do(Act.STEAL, "part")
    assert watcher.presence("part", x, y) is Presence.GONE


@pytest.mark.parametrize(("seed", "options"), [(57, NOISY), (20, TabletopOptions()), (3, NOISY)])
def test_what_is_seen_beside_a_load_is_no_equal_that_stood_elsewhere(
    seed: int, options: TabletopOptions
) -> None:
    rng = np.random.default_rng(seed)
    size = tuple(np.round(rng.uniform((0.03, 0.03, 0.03), (0.08, 0.06, 0.07)), 3).tolist())
    color, other_color = (
        tuple(np.round(rng.uniform(0.05, most, 3), 2).tolist()) for most in (0.6, 0.9)
    )
    shares = rng.uniform(0.3, 0.7), rng.uniform(0.3, 0.7)
    low = (size[0] * shares[0], size[1] * shares[1], rng.uniform(0.015, 0.04))
    load = tuple(np.round(low, 3).tolist())
    y, yaw, x = rng.uniform(-0.4, 0.0), rng.uniform(-1.5, 1.5), rng.uniform(0.42, 0.5)
    stolen_yaw, third_yaw, turn = (rng.uniform(-m, m) for m in (1.5, 1.5, 0.5))
    watcher = Watcher(
        scene_of(
            {
                "carrier": at(x, y, yaw, size=size, color=color),
                "stolen": at(0.6, 0.1, stolen_yaw, size=size, color=color),
                "third": at(0.62, -0.1, third_yaw, size=size, color=color),
                "load": at(0.45, 0.2, size=load, color=other_color),
            }
        ),
        seed,
        options,
    )
    watcher.seen()
    assert watcher.presence("stolen", 0.6, 0.1, yaw=stolen_yaw) is Presence.THERE
    watcher.do(Act.MOVE, "load", to=Pose(x=x, y=y, yaw=yaw + turn))
    watcher.do(Act.STEAL, "stolen")
    assert watcher.presence("stolen", 0.6, 0.1, yaw=stolen_yaw) is Presence.GONE


CAKE = scene_of(
    {
        "cake": at(0.55, 0.0, size=(0.10, 0.10, 0.04), color=(0.85, 0.65, 0.4)),
        "top": at(0.48, -0.4, size=(0.06, 0.07, 0.03), color=(0.15, 0.3, 0.85)),
        "candle": at(0.6, -0.3, size=(0.015, 0.015, 0.06), color=(0.85, 0.1, 0.1)),
        "wall": at(0.45, 0.25, size=(0.03, 0.2, 0.3), color=(0.1, 0.7, 0.2)),
    }
)


def where_the_top_belongs(watcher: Watcher) -> str | None:
    """What is seen, or was seen before it was hidden, on the cake."""
    head, top = watcher.perception.head, watcher.catalogue.parts["top"]
    image, on_cake = head.look(), Location(x=0.55, y=0.0, z=CAKE.table.height + 0.04)
    found = head.occupant(image, top, head.sight(top, image), on_cake)
    return None if found is None else found.what


def test_what_was_seen_in_the_way_still_is_while_something_hides_it() -> None:
    watcher = Watcher(CAKE)
    watcher.seen()
    assert where_the_top_belongs(watcher) is None
    watcher.do(Act.MOVE, "candle", to=Pose(x=0.55, y=0.0, z=CAKE.table.height + 0.04))
    assert where_the_top_belongs(watcher) == "candle is where top belongs"
    watcher.do(Act.MOVE, "wall", to=Pose(x=0.44, y=0.0))
    assert "candle" not in watcher.seen()
    head, candle = watcher.perception.head, watcher.catalogue.parts["candle"]
    recalled = head.recall(candle, head.look())
    assert recalled is not None, "it is hidden, and nobody can say that it is missing"
    assert near((recalled.x, recalled.y), (0.55, 0.0))
    assert where_the_top_belongs(watcher) == (
        "candle is where top belongs, as I saw before something hid it"
    )
    watcher.do(Act.STEAL, "candle")
    assert where_the_top_belongs(watcher) is not None
    watcher.do(Act.MOVE, "wall", to=Pose(x=0.45, y=0.25))
    assert where_the_top_belongs(watcher) is None
    watcher.do(Act.MOVE, "wall", to=Pose(x=0.44, y=0.0))
    assert where_the_top_belongs(watcher) is None


def test_a_thin_part_of_which_little_is_seen_is_in_the_way() -> None:
    low = CAKE.objects["wall"].model_copy(update={"size": (0.08, 0.2, 0.2)})
    watcher = Watcher(CAKE.model_copy(update={"objects": {**CAKE.objects, "wall": low}}))
    watcher.do(Act.MOVE, "candle", to=Pose(x=0.55, y=0.0, z=CAKE.table.height + 0.04))
    watcher.seen()
    watcher.do(Act.MOVE, "wall", to=Pose(x=0.45, y=0.0))
    assert "candle" in watcher.seen()
    assert where_the_top_belongs(watcher) == "candle is where top belongs"


@pytest.mark.parametrize("size", [(0.36, 0.62), (0.70, 1.30), (0.90, 1.60), (1.00, 2.00)])
def test_the_lowest_parts_are_told_from_a_table_however_far_away_it_makes_the_camera(
    size: tuple[float, float],
) -> None:
    plate, knob = (0.05, 0.04, 0.008), (0.016, 0.016, 0.024)
    parts = {
        "near": at(0.6, -0.25, size=plate, knob=knob),
        "far": at(0.75, 0.05, size=plate, knob=knob),
    }
    table = Table(center=(0.7, -0.1), size=size)
    watcher = Watcher(scene_of(parts).model_copy(update={"table": table}))
    head = watcher.perception.head
    assert head.why_blind(head.look()) is None
    seen = watcher.seen()
    assert near(seen["near"], (0.6, -0.25))
    assert near(seen["far"], (0.75, 0.05))
