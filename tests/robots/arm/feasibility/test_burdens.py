"""What a part may have to bear, and stand on, while the leaves of a tree are done."""

import json
import math
from collections.abc import Mapping
from typing import Any

from mend.robots.arm.feasibility.burdens import Burdens
from mend.robots.arm.feasibility.moments import Job
from mend.robots.arm.feasibility.stability import stability_rad
from mend.robots.arm.feasibility.standing import at_place, beneath, starts
from mend.server.behaviors import behavior_parameters
from mend.tasks.definition import BehaviorNode
from mend.tasks.leaf_order import LeafOrder
from mend.tasks.scene import Place, Pose, Scene, SceneObject
from mend.tasks.task_file import check_task_text

FIRM_DEG = 8.0
WEIGHT = (0.04, 0.04, 0.05)


def part(pose: Pose, size: tuple[float, float, float], mass_kg: float = 0.12) -> SceneObject:
    return SceneObject(color=(0.9, 0.0, 0.0), size=size, pose=pose, mass_kg=mass_kg)


def scene(objects: dict[str, SceneObject], **places: Pose) -> Scene:
    given = {name: Place(pose=pose) for name, pose in places.items()}
    return Scene(name="made_up", objects=objects, places=given)


def bring(name: str, place: str) -> dict[str, Any]:
    return {"behavior": "pick_and_place", "object": name, "place": place}


def leans_deg(made: Scene, tree: Mapping[str, Any]) -> dict[str, float]:
    """How far each part may lean where it stands least firmly, by start and by place."""
    text = json.dumps({"name": "made_up", "tree": tree})
    nodes = check_task_text(text, behavior_parameters(), scene=made).definition.nodes
    begin, weights = starts(made), {name: each.mass_kg for name, each in made.objects.items()}
    jobs = [
        Job(index, begin[node.object], at_place(made, node.object, node.place))
        for index, node in enumerate(nodes)
        if isinstance(node, BehaviorNode) and node.object and node.place
    ]
    burdens = Burdens(jobs, [*begin.values()], LeafOrder(nodes), weights)
    wanted = [(each, None) for each in begin.values()]
    least: dict[str, float] = {}
    for standing, job in [*wanted, *((each.place, each) for each in jobs if each.place)]:
        others = burdens.around(standing, job)
        lean = stability_rad(standing, beneath(standing, others), others, weights)
        key = f"{standing.name} at {standing.where[1]}"
        least[key] = min(math.degrees(lean), least.get(key, math.inf))
    return least


def on_a_post(weight_kg: float = 0.3, /, **places: Pose) -> Scene:
    """A beam that is to lie across a post, and weights for it."""
    parts = {
        "post": part(Pose(x=0.44, y=-0.5), (0.05, 0.05, 0.05)),
        "beam": part(Pose(x=0.56, y=-0.44), (0.06, 0.24, 0.022)),
        "one": part(Pose(x=0.44, y=-0.38), WEIGHT, weight_kg),
        "two": part(Pose(x=0.44, y=-0.27), WEIGHT, weight_kg),
    }
    foot, across = Pose(x=0.5, y=0.0), Pose(x=0.5, y=0.0, z=0.75)
    return scene(parts, foot=foot, across=across, **places)


AT_ENDS = {"right": Pose(x=0.5, y=-0.09, z=0.772), "left": Pose(x=0.5, y=0.09, z=0.772)}


def built(last: dict[str, Any]) -> dict[str, Any]:
    return {"then": [bring("post", "foot"), bring("beam", "across"), last]}


def test_of_two_weights_that_balance_one_is_there_first() -> None:
    weights = [bring("one", "right"), bring("two", "left")]
    assert leans_deg(on_a_post(**AT_ENDS), built({"and": weights}))["beam at across"] < 0.0


def test_weights_on_which_only_one_comes_do_not_balance_each_other() -> None:
    weights = [bring("one", "right"), bring("one", "left")]
    assert leans_deg(on_a_post(**AT_ENDS), built({"or": weights}))["beam at across"] < 0.0


def test_alternatives_do_not_burden_a_part_together() -> None:
    places = {"outer": Pose(x=0.48, y=0.055, z=0.772), "other": Pose(x=0.52, y=0.055, z=0.772)}
    weights = [bring("one", "outer"), bring("two", "other")]
    made = on_a_post(0.05, **places)
    assert leans_deg(made, built({"or": weights}))["beam at across"] > FIRM_DEG
    assert leans_deg(made, built({"and": weights}))["beam at across"] < FIRM_DEG


def test_what_is_brought_after_cannot_hold_a_part_down() -> None:
    parts = {
        "edge": part(Pose(x=0.5, y=0.0), (0.05, 0.05, 0.05)),
        "board": part(Pose(x=0.56, y=-0.44), (0.06, 0.16, 0.022)),
        "stone": part(Pose(x=0.44, y=-0.38), WEIGHT, 0.5),
    }
    places = {"out": Pose(x=0.5, y=0.03, z=0.75), "on_it": Pose(x=0.5, y=-0.02, z=0.772)}
    leans = leans_deg(
        scene(parts, **places), {"then": [bring("board", "out"), bring("stone", "on_it")]}
    )
    assert leans["board at out"] < 0.0


def test_of_two_weights_that_balance_at_the_start_one_is_taken_first() -> None:
    post, across = Pose(x=0.5, y=-0.4), Pose(x=0.5, y=-0.4, z=0.75)
    parts = {
        "post": part(post, (0.05, 0.05, 0.05)),
        "beam": part(across, (0.06, 0.24, 0.022)),
        "one": part(Pose(x=0.5, y=-0.49, z=0.772), WEIGHT, 0.3),
        "two": part(Pose(x=0.5, y=-0.31, z=0.772), WEIGHT, 0.3),
    }
    made = scene(parts, near=Pose(x=0.48, y=0.0), far=Pose(x=0.6, y=0.0))
    both = {"and": [bring("one", "near"), bring("two", "far")]}
    assert leans_deg(made, both)["beam at beam"] < 0.0
    assert leans_deg(made, bring("one", "near"))["beam at beam"] < 0.0


def on_pillars(tree: dict[str, Any]) -> float:
    pillar = (0.04, 0.04, 0.1)
    parts = {
        "pillar": part(Pose(x=0.44, y=-0.46), pillar),
        "other": part(Pose(x=0.44, y=-0.36), pillar),
        "third": part(Pose(x=0.44, y=-0.26), pillar),
        "lintel": part(Pose(x=0.58, y=-0.4), (0.04, 0.19, 0.022)),
    }
    places = {
        "right": Pose(x=0.52, y=-0.07),
        "left": Pose(x=0.52, y=0.07),
        "middle": Pose(x=0.52, y=0.0),
        "across": Pose(x=0.52, y=0.0, z=0.8),
    }
    whole = {"then": [tree, bring("lintel", "across")]}
    return leans_deg(scene(parts, **places), whole)["lintel at across"]


def test_pillars_of_which_only_one_is_placed_do_not_carry_together() -> None:
    right, left = bring("pillar", "right"), bring("other", "left")
    assert on_pillars({"or": [right, left]}) < 0.0
    assert on_pillars({"and": [right, left]}) > FIRM_DEG


def test_either_of_two_ways_to_carry_a_part_is_looked_at_as_a_whole() -> None:
    ends = {"and": [bring("pillar", "right"), bring("other", "left")]}
    assert on_pillars({"or": [ends, bring("third", "middle")]}) > FIRM_DEG


def test_a_tower_that_is_taken_down_from_the_top_stands_all_the_time() -> None:
    block = (0.05, 0.05, 0.04)
    parts = {
        name: part(Pose(x=0.5, y=-0.4, z=0.70 + 0.04 * level), block)
        for level, name in enumerate(["low", "high", "top"])
    }
    places = {f"p_{n}": Pose(x=0.5, y=0.1, z=0.70 + 0.04 * n) for n in range(3)}
    order = [bring("top", "p_0"), bring("high", "p_1"), bring("low", "p_2")]
    assert min(leans_deg(scene(parts, **places), {"then": order}).values()) > FIRM_DEG


def test_a_plate_full_of_parts_is_looked_at_in_no_more_states_than_can_be() -> None:
    parts = {f"part_{n}": part(Pose(x=0.4, y=-0.6), (0.02, 0.02, 0.03)) for n in range(40)}
    parts["plate"] = part(Pose(x=0.6, y=-0.1), (0.3, 0.3, 0.02))
    places = {
        f"p_{n}": Pose(x=0.49 + 0.05 * (n % 5), y=-0.22 + 0.03 * (n // 5), z=0.72)
        for n in range(40)
    }
    tree = {"and": [bring(f"part_{n}", f"p_{n}") for n in range(40)]}
    assert leans_deg(scene(parts, **places), tree)["plate at plate"] > FIRM_DEG
