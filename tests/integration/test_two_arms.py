"""Two arms that share a table and a task, as the examples have it."""

from collections.abc import Sequence
from pathlib import Path

import pytest
from broken_constraints import broken_constraints
from outside_their_space import outside_their_space
from sampled import sample
from touching_robots import touching_robots
from untruths import kinds_of
from watched_world import where_parts_rest

from mend.server.composition import open_service
from mend.server.journal import events as ev
from mend.server.journal.sqlite import IN_MEMORY
from mend.server.journal.stored_event import read_event
from mend.server.runtime.requests import RunRequest
from mend.server.settings import Settings
from mend.tasks.definition import BehaviorNode, TaskTreeDefinition

EXAMPLES = Path(__file__).parents[2] / "examples" / "two_arms"
THERE_M = 0.005
FOUR_SCENE = """
name: four
table: {height: 0.70, center: [0.52, 0.0], size: [0.44, 1.40]}
robots:
  left: {x: 0.0, y: 0.0}
  right: {x: 1.04, y: 0.0, yaw: 3.1416}
objects:
  bolt: {color: [0.9, 0.1, 0.1], size: [0.02, 0.04, 0.03], pose: {x: 0.42, y: -0.5}}
  bracket: {color: [0.1, 0.2, 0.9], size: [0.03, 0.05, 0.03], pose: {x: 0.54, y: -0.5}}
  nut: {color: [0.9, 0.8, 0.1], size: [0.03, 0.03, 0.03], pose: {x: 0.62, y: 0.5}}
  handle: {color: [0.1, 0.7, 0.2], size: [0.02, 0.06, 0.03], pose: {x: 0.50, y: 0.5}}
places:
  bolt: {pose: {x: 0.42, y: -0.25}}
  bracket: {pose: {x: 0.54, y: -0.25}}
  nut: {pose: {x: 0.62, y: 0.25}}
  handle: {pose: {x: 0.50, y: 0.25}}
"""
FOUR_TREE = """
name: four
scene: four
tree:
  and:
    - {behavior: pick_and_place, object: bolt, place: bolt}
    - {behavior: pick_and_place, object: bracket, place: bracket}
    - {behavior: pick_and_place, object: nut, place: nut}
    - {behavior: pick_and_place, object: handle, place: handle}
"""
TWO_TREE = """
name: two
scene: four
tree:
  and:
    - {behavior: pick_and_place, object: bolt, place: bolt}
    - {behavior: pick_and_place, object: nut, place: nut}
"""
OF_THE_KIT = ("bolt_1", "bolt_4", "bolt_7", "bracket_2", "nut_1", "nut_3", "handle_2", "handle_5")
SOME_TREE = """
name: some
scene: kit
tree:
  and:
""" + "".join(
    f"    - {{behavior: pick_and_place, object: {each}, place: {each}}}\n" for each in OF_THE_KIT
)
OWN_TREES = {"four": FOUR_TREE, "two": TWO_TREE, "some": SOME_TREE}
KIT, SHARES = sample(
    ("some", {"left": 4, "right": 4}),
    ("kit", {"left": 11, "right": 9}),
)
"""What is done of the kit, and how many parts of it each of two robots does."""
CARRYING = 5
"""The step in which a part is on its way."""


def settings(journal: str | Path = IN_MEMORY) -> Settings:
    return Settings(port=0, journal=Path(journal), log_level="error", speech_voice="none")


def request(tree: str, scene: str, world: str = "tabletop") -> RunRequest:
    return RunRequest(tree=tree, scene=scene, world=world, speed="max", seed=3, answers="none")


def text_of(name: str) -> str | None:
    """An example's text, if it is one."""
    file = EXAMPLES / f"{name}.yaml"
    return file.read_text() if file.exists() else None


async def done_in(tree: str, scene: str | None, world: str = "tabletop") -> Sequence[ev.Event]:
    """The events of a run that nobody helps, in which each part of the tree comes to its place."""
    async with open_service(settings()) as service:
        if scene is not None:
            await service.library.scenes.save(scene, text_of(scene) or FOUR_SCENE)
        if tree != "kit":
            await service.library.trees.save(tree, text_of(tree) or OWN_TREES[tree])
        run = await service.runtime.start_run(request(tree, scene or "kit", world))
        await service.runtime.wait_for_end(run.id)
        events = await service.journal.read(0, 100_000, run.id)
        snapshot = await service.journal.world(run.id)
    started = events[0]
    assert isinstance(started, ev.RunStarted)
    assert isinstance(events[-1], ev.RunFinished)
    assert broken_constraints(events, kinds_of(started)) == []
    resting = where_parts_rest(started, snapshot)
    definition = TaskTreeDefinition.model_validate(started.tree)
    for name in {each.object for each in definition.nodes if isinstance(each, BehaviorNode)}:
        assert name is not None
        pose, rest = started.scene["places"][name]["pose"], resting[name]
        assert rest is not None
        assert (rest.x, rest.y) == pytest.approx((pose["x"], pose["y"]), abs=THERE_M)
    return events


def by_robot(events: Sequence[ev.Event]) -> dict[str, list[str]]:
    """The leaves that each robot has begun, by the name that the scene gives it."""
    begun: dict[str, list[str]] = {}
    for each in events:
        if isinstance(each, ev.NodeStarted):
            begun.setdefault(each.robot.rpartition("-")[0], []).append(each.name)
    return begun


@pytest.mark.slow
async def test_a_kit_is_done_more_than_1_6_times_faster_than_by_one() -> None:
    alone = await done_in(KIT, None)
    with touching_robots() as touched:
        together = await done_in(KIT, "kit_for_two")
    assert touched == []
    begun = by_robot(together)
    assert {name: len(leaves) for name, leaves in begun.items()} == SHARES
    assert not [each for each in together if isinstance(each, ev.IssueRaised)]
    # Simulated time: the same on every machine.
    assert alone[-1].time / together[-1].time > 1.6


@pytest.mark.slow
async def test_parts_that_cross_the_table_are_passed_on_without_asking_anybody() -> None:
    with touching_robots() as touched:
        events = await done_in("swap", "across")
    assert touched == []
    assert by_robot(events) == {
        "left": ["cup_to_transfer", "jar_from_transfer"],
        "right": ["jar_to_transfer", "cup_from_transfer"],
    }
    assert not [each for each in events if isinstance(each, ev.Prompt)]


MOVED = """
name: moved
tree: four
interventions:
  - when: {object: bolt, step: 8, fraction: 0.9}
    do: {act: move, object: bolt, to: {x: 0.45, y: 0.40}}
"""


@pytest.mark.slow
async def test_what_is_moved_to_where_another_arm_may_work_is_fetched_once_the_space_is_had() -> (
    None
):
    with touching_robots() as touched, outside_their_space() as outside:
        async with open_service(settings()) as service:
            await service.library.scenes.save("four", FOUR_SCENE)
            await service.library.trees.save("four", FOUR_TREE)
            await service.library.scenarios.save("moved", MOVED)
            moved = request("four", "four").model_copy(update={"scenario": "moved"})
            run = await service.runtime.start_run(moved)
            view = await service.runtime.wait_for_end(run.id)
    assert touched == []
    assert outside == []
    assert view.status == "finished"


@pytest.mark.slow
async def test_two_arms_go_on_where_a_stopped_service_left_them(tmp_path: Path) -> None:
    journal = tmp_path / "journal.db"
    with touching_robots() as touched:
        async with open_service(settings(journal)) as service:
            await service.library.scenes.save("four", FOUR_SCENE)
            await service.library.trees.save("four", FOUR_TREE)
            run = (await service.runtime.start_run(request("four", "four"))).id
            with service.journal.subscribe(0) as records:
                async for record in records:
                    event = read_event(record.seq, record.text)
                    if isinstance(event, ev.StepStarted) and event.step == CARRYING:
                        break
        async with open_service(settings(journal), recover=True) as service:
            view = await service.runtime.wait_for_end(run)
            events = await service.journal.read(0, 100_000, run)
    assert touched == []
    assert view.status == "finished"
    started = events[0]
    assert isinstance(started, ev.RunStarted)
    assert broken_constraints(events, kinds_of(started)) == []
    assert len([each for each in events if isinstance(each, ev.NodeDone)]) == 4


@pytest.mark.slow(4)
async def test_two_pr2s_work_at_a_time_and_never_touch() -> None:
    pytest.importorskip("pybullet")
    with touching_robots() as touched:
        events = await done_in("two", "four", "workcell")
    assert touched == []
    assert by_robot(events) == {"left": ["bolt"], "right": ["nut"]}
    assert not [each for each in events if isinstance(each, ev.IssueRaised)]
    # Each moves while the other does, not one after the other.
    started = [each.time for each in events if isinstance(each, ev.NodeStarted)]
    done = [each.time for each in events if isinstance(each, ev.NodeDone)]
    assert started[1] < done[0]
