import itertools
import json

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st
from sampled import sample

from mend.errors import WrongInputError
from mend.robots.catalogue import Part
from mend.server.behaviors import behavior_parameters
from mend.sim.random_parts import DrawnSizes
from mend.sim.random_scene import MOST_PARTS, random_scene, scene_document
from mend.sim.standing_room import standing
from mend.tasks.definition import BehaviorNode
from mend.tasks.footprint import Footprint
from mend.tasks.library import NotInLibraryError
from mend.tasks.scene import Pose, Scene, SceneObject
from mend.tasks.scene_file import check_scene_text
from mend.tasks.scene_problem import SceneProblem
from mend.tasks.task_file import check_task_text

SEEDS = st.integers(0, 10**9)
COUNTS = st.integers(1, MOST_PARTS)
SIZES = DrawnSizes()


def _bottom(scene: Scene, pose: Pose) -> float:
    return scene.table.height if pose.z is None else pose.z


def _height(part: SceneObject) -> float:
    return part.size[2] + (part.knob[2] if part.knob else 0.0)


def _solids(scene: Scene, poses: dict[str, Pose]) -> list[tuple[str, Footprint, float, float]]:
    return [
        (
            name,
            Footprint(pose.x, pose.y, pose.yaw, *scene.objects[name].size[:2]),
            _bottom(scene, pose),
            _bottom(scene, pose) + _height(scene.objects[name]),
        )
        for name, pose in poses.items()
    ]


def _starts(scene: Scene) -> dict[str, Pose]:
    return {name: part.pose for name, part in scene.objects.items()}


def _targets(scene: Scene) -> dict[str, Pose]:
    return {name.replace("place", "part"): place.pose for name, place in scene.places.items()}


def _as_text(document: dict) -> str:
    return yaml.safe_dump(document, sort_keys=False)


@given(SEEDS, COUNTS)
@settings(max_examples=sample(3, 12), deadline=None)
def test_a_random_scene_is_a_valid_scene_file_of_so_many_parts(seed, count):
    made = random_scene(seed, count)
    assert check_scene_text(_as_text(scene_document(made.scene))) == made.scene
    assert len(made.scene.objects) == len(made.scene.places) == count


@given(SEEDS, COUNTS)
@settings(max_examples=sample(3, 12), deadline=None)
def test_no_two_parts_fill_the_same_space(seed, count):
    scene = random_scene(seed, count).scene
    both = [
        *(("start", *each) for each in _solids(scene, _starts(scene))),
        *(("place", *each) for each in _solids(scene, _targets(scene))),
    ]
    for (_, _, ground, low, high), (_, _, other, other_low, other_high) in itertools.combinations(
        both, 2
    ):
        apart = low >= other_high - 1e-6 or other_low >= high - 1e-6
        assert apart or not ground.overlaps(other)


@given(SEEDS, COUNTS)
@settings(max_examples=sample(3, 12), deadline=None)
def test_what_is_above_the_table_stands_on_another_part(seed, count):
    scene = random_scene(seed, count).scene
    for poses in (_starts(scene), _targets(scene)):
        solids = _solids(scene, poses)
        for _, ground, low, _ in solids:
            if low > scene.table.height:
                assert any(
                    abs(high - low) < 1e-6
                    and Footprint(ground.x, ground.y, 0, 0.013, 0.013).overlaps(other)
                    for _, other, _, high in solids
                )


@given(SEEDS, COUNTS)
@settings(max_examples=sample(3, 12), deadline=None)
def test_the_tree_places_every_part_once_and_keeps_to_what_stands_on_what(seed, count):
    made = random_scene(seed, count)

    def find(name: str) -> Scene:
        if name != made.scene.name:
            raise NotInLibraryError(name)
        return made.scene

    task = check_task_text(_as_text(made.tree), behavior_parameters(), find)
    leaves = [each for each in task.definition.nodes if each.kind == "behavior"]
    assert sorted(each.object for each in leaves) == sorted(made.scene.objects)
    assert sorted(each.place for each in leaves) == sorted(made.scene.places)
    assert "or" not in {each.kind for each in task.definition.nodes}
    before = _certainly_before(task.definition.nodes)
    for first, then in _needed_order(made.scene):
        assert (first, then) in before


def _certainly_before(nodes) -> set[tuple[str, str]]:
    """Pairs of objects of which a THEN has the first one placed before the second."""

    def way(index):
        while index is not None:
            yield index
            index = nodes[index].parent

    pairs = set()
    leaves = [index for index, node in enumerate(nodes) if node.kind == "behavior"]
    for first, then in itertools.combinations(leaves, 2):
        common = next(each for each in way(first) if each in set(way(then)))
        if nodes[common].kind == "then":
            pairs.add((nodes[first].object, nodes[then].object))
    return pairs


def _needed_order(scene: Scene) -> set[tuple[str, str]]:
    """By geometry alone: what is put onto something later, what is taken off it earlier."""
    needed = set()
    for poses, top_first in ((_starts(scene), True), (_targets(scene), False)):
        solids = _solids(scene, poses)
        for upper, ground, low, _ in solids:
            for lower, other, _, high in solids:
                if upper != lower and abs(low - high) < 1e-6 and ground.overlaps(other):
                    needed.add((upper, lower) if top_first else (lower, upper))
    return needed


def test_the_same_seed_draws_the_same_scene_and_another_one_another():
    assert random_scene(5) == random_scene(5)
    assert random_scene(5) != random_scene(6)


@pytest.mark.slow(2)
def test_what_is_drawn_covers_the_limits():
    scenes = [random_scene(seed).scene for seed in range(40)]
    parts = [part for scene in scenes for part in scene.objects.values()]
    boxes = [part.size for part in parts if part.knob is None]
    for drawn, (low, high) in (
        ([min(size[:2]) for size in boxes], SIZES.width_m),
        ([max(size[:2]) for size in boxes], SIZES.length_m),
        ([size[2] for size in boxes], SIZES.height_m),
        ([len(scene.objects) for scene in scenes], (1, MOST_PARTS)),
        ([max(part.color) for part in parts], (0.14, 1.0)),
    ):
        edge = (high - low) / 6
        assert low - 1e-9 <= min(drawn) < low + edge
        assert high - edge < max(drawn) <= high + 1e-9
    colors = [part.color for part in parts]
    assert sum(max(color) - min(color) < 0.1 for color in colors) > len(colors) / 50
    assert sum(max(color) < 0.25 for color in colors) > len(colors) / 20
    knobs = sum(part.knob is not None for part in parts)
    equal = sum(
        len(scene.objects) - len({_look(p) for p in scene.objects.values()}) for scene in scenes
    )
    stacked = sum(part.pose.z is not None for part in parts)
    placed_high = sum(
        place.pose.z is not None for scene in scenes for place in scene.places.values()
    )
    for share in (knobs, equal, stacked, placed_high):
        assert share > len(parts) / 20


def _look(part: SceneObject) -> tuple:
    return part.size, part.knob, part.color


def test_what_the_world_refuses_is_drawn_anew():
    def refuse_high_parts(scene, nodes):
        leaves = [each for each in nodes if isinstance(each, BehaviorNode)]
        assert {leaf.object for leaf in leaves} == set(scene.objects)
        return [
            SceneProblem(("objects", name, "size"), "too high")
            for name, part in scene.objects.items()
            if _height(part) > 0.06
        ]

    for seed in range(10):
        made = random_scene(seed, 8, refuse_high_parts)
        assert len(made.scene.objects) == 8
        assert max(_height(part) for part in made.scene.objects.values()) <= 0.06


def test_the_world_is_asked_about_the_tree_that_is_drawn():
    asked = []

    def note(_, nodes):
        asked.append(nodes)
        return []

    for seed in range(10):
        made = random_scene(seed, 8, note)
        text = json.dumps({"name": "drawn", "tree": made.tree["tree"]})
        wanted = check_task_text(text, behavior_parameters(), scene=made.scene).definition
        assert [_told(each) for each in asked[-1]] == [_told(each) for each in wanted.nodes]


def _told(node):
    return node.kind, node.parent, getattr(node, "object", None)


@pytest.mark.parametrize("count", [0, 31, -1])
def test_there_are_no_scenes_of_none_or_too_many_parts(count):
    with pytest.raises(ValueError, match="1 to 30"):
        random_scene(0, count)


def test_the_gripper_needs_room_beside_what_it_grasps():
    part = Part("part", (0.03, 0.10, 0.05))
    here = standing(part, 0.5, 0.0, 0.7, 0.0)
    assert here.hinders(standing(part, 0.55, 0.0, 0.7, 0.0))
    assert not here.hinders(standing(part, 0.60, 0.0, 0.7, 0.0))
    # Along the fingers' sides there need not be so much.
    assert not here.hinders(standing(part, 0.5, 0.13, 0.7, 0.0))


def test_a_low_part_is_not_reached_beside_a_tower():
    low = standing(Part("low", (0.03, 0.03, 0.03)), 0.5, 0.0, 0.7, 0.0)
    tower = Part("tower", (0.03, 0.03, 0.12))
    assert low.hinders(standing(tower, 0.57, 0.0, 0.7, 0.0))
    assert not low.hinders(standing(tower, 0.63, 0.0, 0.7, 0.0))


@pytest.mark.parametrize(("parts", "told"), [(None, "with 1 to 30 parts"), (2, "with 2 parts")])
def test_where_nothing_is_possible_that_is_said(parts, told, monkeypatch):
    monkeypatch.setattr("mend.sim.random_scene._SCENES_TRIED", 1)

    def refuse_all(scene, _):
        return [SceneProblem(("objects", name), "no arm") for name in scene.objects]

    with pytest.raises(WrongInputError, match=f"{told} was found that a robot of this world"):
        random_scene(1, parts, refuse_all)
