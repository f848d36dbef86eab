"""The end of a run is compared with its events and with where the parts really are."""

from dataclasses import replace
from typing import Any

import pytest
from pretend_service import pretend_service
from recorded_service import recorded_events
from task_documents import definition_of
from untruths import Rest, find_untruths

from mend.server.journal import events as ev
from mend.sim.tabletop.layout import lay_out
from mend.tasks.intervention import Act, Intervention
from mend.tasks.scene import Scene

NAMES = [("part_1", "spot_1"), ("part_2", "spot_2")]
SCENE = lay_out(NAMES, seed=1)
LEAVES = [{"behavior": "pick_and_place", "object": part, "place": spot} for part, spot in NAMES]


def at_places() -> dict[str, Rest | None]:
    poses = {part: SCENE.places[spot].pose for part, spot in NAMES}
    return {part: Rest(pose.x, pose.y, SCENE.table.height) for part, pose in poses.items()}


def with_end(events: list[ev.Event], **changed: Any) -> list[ev.Event]:
    return [*events[:-1], events[-1].model_copy(update=changed)]


async def events_of(goal: str, failing: int = 0) -> list[ev.Event]:
    """A run of two parts, each of which is missed so often while nobody answers."""
    faults = {part: [("missed", 4)] * failing for part, _ in NAMES}
    async with pretend_service(definition_of({goal: LEAVES}), faults, scene=SCENE) as service:
        _, events = await service.run_to_end(answers="none")
    return events


async def test_a_finished_run_with_all_parts_at_their_places_is_true() -> None:
    events = with_end(await events_of("then"), missing=[])
    assert find_untruths(events, at_places()) == []


@pytest.mark.parametrize("rest", [None, Rest(0.0, 0.0, 0.7), "on_top"])
async def test_a_part_that_is_not_at_its_place_must_be_told_to_be_missing(rest: Any) -> None:
    events = with_end(await events_of("then"), missing=[])
    resting = at_places()
    at_place = resting["part_2"]
    if rest == "on_top" and at_place is not None:
        rest = replace(at_place, z=at_place.z + 0.05)
    untruths = find_untruths(events, {**resting, "part_2": rest})
    assert "'part_2' is not at its place, but is not told to be missing" in untruths
    assert not any("part_1" in each for each in untruths)


async def test_a_part_at_its_place_must_not_be_told_to_be_missing() -> None:
    told = ev.MissingPart(node="/0", name="part_1", object="part_1", place="spot_1")
    events = with_end(await events_of("then"), missing=[told])
    assert find_untruths(events, at_places()) == [
        "'part_1' is told to be missing, but is at its place"
    ]


async def test_a_part_that_leans_at_its_place_may_be_told_to_be_missing() -> None:
    told = ev.MissingPart(node="/0", name="part_1", object="part_1", place="spot_1")
    at_place = at_places()["part_1"]
    assert at_place is not None
    hanging = replace(at_place, z=at_place.z - 0.0197, lean_rad=0.33)
    for missing in ([told], []):
        events = with_end(await events_of("then"), missing=missing)
        assert find_untruths(events, {**at_places(), "part_1": hanging}) == []


async def test_what_somebody_hides_may_be_told_to_be_missing() -> None:
    told = ev.MissingPart(node="/0", name="part_1", object="part_1", place="spot_1")
    *before, end = with_end(await events_of("then"), missing=[told])
    act = Intervention(act=Act.BLOCK)
    stamp = {"time": end.time, "wall_time": end.wall_time, "run": end.run}
    block = ev.InterventionDone(**stamp, act="block", object=None, intervention=act, by="scenario")
    assert find_untruths([*before, block, end], at_places()) == []


async def test_a_leaf_done_without_its_part_is_untrue_even_if_that_is_told() -> None:
    told = ev.MissingPart(node="/0", name="part_1", object="part_1", place="spot_1")
    events = with_end(await events_of("then"), missing=[told])
    assert find_untruths(events, {**at_places(), "part_1": None}) == [
        "'/0' is done, but 'part_1' never was at its place"
    ]


def test_what_lies_under_something_missing_may_be_told_to_be_missing_too() -> None:
    events = recorded_events()
    started = events[0]
    assert isinstance(started, ev.RunStarted)
    scene = Scene.model_validate(started.scene, strict=False)
    resting: dict[str, Rest | None] = dict.fromkeys(scene.objects)
    for name, place in scene.places.items():
        z = scene.table.height if place.pose.z is None else place.pose.z
        resting[name] = Rest(place.pose.x, place.pose.y, z)
    top = resting["purple_top"]
    assert top is not None
    resting["purple_top"] = replace(top, z=top.z - 0.0197, lean_rad=0.33)
    done = {each.name: each for each in events if isinstance(each, ev.NodeDone)}
    told = [
        ev.MissingPart(node=done[name].node, name=name, object=name, place=name)
        for name in ("green_leg", "purple_top")
    ]
    assert find_untruths(with_end(events, missing=told), resting) == []
    assert find_untruths(with_end(events, missing=told[:1]), resting) == [
        "'green_leg' is told to be missing, but is at its place"
    ]


async def test_who_clears_the_way_may_have_moved_any_part() -> None:
    told = ev.MissingPart(node="/0", name="part_1", object="part_1", place="spot_1")
    *before, end = with_end(await events_of("then"), missing=[told])
    act = Intervention(act=Act.RELEASE, object="part_2", place="spot_2")
    stamp = {"time": end.time, "wall_time": end.wall_time, "run": end.run}
    cleared = ev.InterventionDone(
        **stamp, act="release", object="part_2", intervention=act, by="helper"
    )
    assert find_untruths([*before, cleared, end], {**at_places(), "part_1": None}) == []


async def test_a_failure_after_three_failed_attempts_is_true() -> None:
    assert find_untruths(await events_of("then", failing=3), {}) == []


async def test_a_failure_must_name_a_leaf_that_failed() -> None:
    events = with_end(await events_of("then", failing=3), node="/1")
    assert any("0 attempts at '/1' failed" in each for each in find_untruths(events, {}))


async def test_a_failure_with_an_alternative_left_is_untrue() -> None:
    events = await events_of("or", failing=3)
    assert find_untruths(events, {}) == []
    kept = [each for each in events if not isinstance(each, ev.NodeAbandoned)]
    assert any("could have abandoned" in each for each in find_untruths(kept, {}))


async def test_a_part_just_like_it_will_do() -> None:
    events = with_end(await events_of("then"), missing=[])
    started = events[0]
    assert isinstance(started, ev.RunStarted)
    alike = dict.fromkeys(SCENE.objects, SCENE.objects["part_1"])
    scene = SCENE.model_copy(update={"objects": alike})
    equal = started.model_copy(update={"scene": scene.model_dump(mode="json")})
    swapped = {"part_1": at_places()["part_2"], "part_2": at_places()["part_1"]}
    assert find_untruths([equal, *events[1:]], swapped) == []
    assert find_untruths(events, swapped) != []
    assert find_untruths([equal, *events[1:]], {**swapped, "part_2": None}) != []
