"""What is seen gone is done no longer: it is taken back, and nothing is built on it."""

import asyncio
from typing import Any

import numpy as np
import pytest
from broken_constraints import broken_constraints
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from pretend_robots import PretendRobot
from pretend_service import pretend_service
from random_task import random_task
from sampled import sample
from task_documents import definition_of

from mend.dialogue.registry import load_scripts
from mend.robots.link.messages import RoomLimits
from mend.server.journal import events as ev
from mend.server.runtime.context import RunSettings
from mend.server.runtime.run_state import RunState
from mend.server.runtime.views import RunStatus, RunView
from mend.sim.tabletop.layout import lay_out
from mend.tasks.definition import TaskTreeDefinition
from mend.tasks.scene import Base, Place, Pose
from mend.tasks.task_tree import TaskTree

NAMES = [(f"part_{i}", f"spot_{i}") for i in range(1, 6)]
SCENE = lay_out(NAMES, seed=1)
LEAVES = [{"behavior": "pick_and_place", "object": part, "place": spot} for part, spot in NAMES]


async def run_with(
    tree: Any,
    thefts: dict[str, list[str]],
    *,
    settings: RunSettings | None = None,
    hidden: frozenset[str] = frozenset(),
    **fields: Any,
) -> tuple[RunView, list[ev.Event]]:
    """A run in which parts are gone once another one has been placed; its events break nothing."""
    async with pretend_service(
        definition_of(tree), scene=SCENE, settings=settings, thefts=thefts, hidden_at_place=hidden
    ) as service:
        view, events = await service.run_to_end(**fields)
    assert broken_constraints(events, {node.node: node.kind for node in view.nodes}) == []
    return view, events


def story(events: list[ev.Event]) -> list[str]:
    """What became of the leaves, in order."""
    words = {ev.NodeStarted: "start", ev.NodeDone: "done", ev.NodeUndone: "undone"}
    return [
        f"{words[type(each)]} {each.name.removeprefix('part_')}"
        for each in events
        if isinstance(each, ev.NodeStarted | ev.NodeDone | ev.NodeUndone)
    ]


def in_turn(*numbers: int) -> list[str]:
    return [line for i in numbers for line in (f"start {i}", f"done {i}")]


async def test_what_a_then_puts_after_a_stolen_part_is_taken_back_and_found_in_place() -> None:
    view, events = await run_with({"then": LEAVES}, {"part_3": ["part_1"]}, answers=["yes"])
    assert view.status is RunStatus.FINISHED
    assert story(events) == [
        *in_turn(1, 2, 3),
        *("undone 3", "undone 2", "undone 1"),
        *in_turn(1, 2, 3, 4, 5),
    ]
    undone = [each for each in events if isinstance(each, ev.NodeUndone)]
    assert [each.because_of for each in undone] == ["/0", "/0", None]
    assert undone[-1].reason == "part_1 is no longer at spot_1"
    [issue] = [each for each in events if isinstance(each, ev.IssueRaised)]
    assert (issue.issue, issue.object, issue.step) == ("undone", "part_1", 0)


async def test_an_and_takes_back_the_stolen_part_alone() -> None:
    view, events = await run_with({"and": LEAVES}, {"part_3": ["part_1"]}, answers=["yes"])
    assert view.status is RunStatus.FINISHED
    assert [line for line in story(events) if "undone" in line] == ["undone 1"]


async def test_what_is_stolen_after_everything_is_done_is_seen_by_the_last_look() -> None:
    view, events = await run_with({"and": LEAVES[:2]}, {"part_2": ["part_1"]}, answers=["yes"])
    assert view.status is RunStatus.FINISHED
    assert story(events) == [*in_turn(1, 2), "undone 1", *in_turn(1)]
    assert view.result is not None
    assert (view.result.reason, view.result.missing) == ("the task is done", [])


async def test_with_nobody_there_the_run_fails_naming_the_part_that_is_gone() -> None:
    view, events = await run_with({"then": LEAVES[:2]}, {"part_2": ["part_1"]}, answers="none")
    assert view.status is RunStatus.FAILED
    assert view.result is not None
    assert view.result.reason == "'part_1' could not be done: it failed 3 times"
    issues = [each.issue for each in events if isinstance(each, ev.IssueRaised)]
    assert issues == ["undone"] * 3


async def test_another_alternative_is_taken_when_a_part_is_gone_for_good() -> None:
    tree = {"then": [{"or": LEAVES[:2]}, LEAVES[2]]}
    view, events = await run_with(tree, {"part_3": ["part_1"]}, answers="none")
    assert view.status is RunStatus.FINISHED
    assert view.result is not None
    assert view.result.missing == []
    assert story(events)[-4:] == in_turn(2, 3)


@pytest.mark.parametrize("most", [0, 2])
async def test_what_is_taken_away_each_time_is_not_placed_for_ever(most: int) -> None:
    settings = RunSettings(max_times_gone=most)
    thefts = {"part_1": ["part_1"] * 50}
    view, events = await run_with(
        {"then": LEAVES[:1]}, thefts, settings=settings, answers=["yes"] * 50
    )
    assert view.status is RunStatus.FAILED
    assert view.result is not None
    times = most + 1
    assert view.result.reason == (
        f"'part_1' could not be done: it was gone again after it had been done {times} times"
    )
    assert story(events).count("undone 1") == times


async def test_the_last_leaf_for_a_part_says_where_it_is_to_be() -> None:
    there = {**LEAVES[0], "name": "there"}
    back = {**LEAVES[0], "place": "spot_2", "name": "back"}
    view, events = await run_with(
        {"then": [there, back, LEAVES[2]]}, {"part_3": ["part_1"]}, answers=["yes"]
    )
    assert view.status is RunStatus.FINISHED
    assert [each.name for each in events if isinstance(each, ev.NodeUndone)] == ["part_3", "back"]


async def test_what_is_hidden_is_believed_to_be_where_it_was_put() -> None:
    hidden = frozenset({"part_1"})
    view, events = await run_with({"then": LEAVES[:2]}, {"part_2": ["part_1"]}, hidden=hidden)
    assert view.status is RunStatus.FINISHED
    assert [line for line in story(events) if "undone" in line] == []


async def test_what_the_last_look_cannot_see_is_told_as_that() -> None:
    hidden = frozenset({"part_1"})
    view, events = await run_with({"then": LEAVES[:2]}, {}, hidden=hidden)
    assert isinstance(events[-1], ev.RunFinished)
    assert [(each.node, each.place) for each in events[-1].unseen] == [("/0", "spot_1")]
    assert view.result is not None
    assert (
        view.result.reason
        == "the task is done; the last look could not tell whether part_1 stayed there"
    )


async def test_a_run_does_not_end_with_a_table_that_is_not_seen() -> None:
    async with pretend_service(definition_of({"then": LEAVES[:2]}), scene=SCENE) as service:
        service.robots.make = lambda name: PretendRobot(name, blinded_by="part_2")
        view, events = await service.run_to_end(answers=["yes"])
    assert broken_constraints(events, {node.node: node.kind for node in view.nodes}) == []
    assert view.status is RunStatus.FINISHED
    assert story(events)[-3:] == ["undone 2", *in_turn(2)]
    [undone] = [each for each in events if isinstance(each, ev.NodeUndone)]
    assert undone.unseen
    assert undone.reason == "whether part_2 is at spot_2 cannot be seen: the camera is covered"
    [issue] = [each for each in events if isinstance(each, ev.IssueRaised)]
    assert (issue.issue, issue.object) == ("blind", "part_2")
    [prompt] = [each for each in events if isinstance(each, ev.Prompt) and each.kind == "ask"]
    assert prompt.text.startswith("I cannot see what is on the table.")
    assert isinstance(events[-1], ev.RunFinished)
    assert events[-1].unseen == []


async def test_with_nobody_there_a_run_that_sees_no_table_fails() -> None:
    async with pretend_service(definition_of({"then": LEAVES[:2]}), scene=SCENE) as service:
        service.robots.make = lambda name: PretendRobot(name, blinded_by="part_1")
        view, events = await service.run_to_end(answers="none")
    assert view.status is RunStatus.FAILED
    assert {each.issue for each in events if isinstance(each, ev.IssueRaised)} == {"blind"}


async def test_what_another_robot_builds_on_it_is_cut_short() -> None:
    tree = {"then": [LEAVES[0], {"and": LEAVES[1:4]}]}
    # The second part is the slow one's alone, out of the fast one's way.
    at = {name: Pose(x=3.0 if name == "part_2" else 0.5, y=0.0) for name, _ in NAMES}
    apart = SCENE.model_copy(
        update={
            "objects": {
                name: part.model_copy(update={"pose": at[name]})
                for name, part in SCENE.objects.items()
            },
            "places": {spot: Place(pose=at[name]) for name, spot in NAMES},
            "robots": {"fast": Base(x=0.0, y=0.0), "slow": Base(x=2.5, y=0.0)},
        }
    )
    async with pretend_service(definition_of(tree), scene=apart) as service:
        stolen: set[str] = set()
        shared: dict[str, Any] = {
            "stolen": stolen,
            "finished": set(),
            "in_reach": True,
            "hidden": set(at),
            "room": RoomLimits(resting=[(0.0, 0.0)], hand_over=(0.0, 0.0), around_m=0.1),
        }
        make = {
            "fast": PretendRobot("fast", thefts={"part_3": ["part_1"]}, **shared),
            "slow": PretendRobot("slow", slow=True, **shared),
        }
        service.robots.make = lambda name: make[name]
        service.robots.robots.update(make)
        # The slow one takes a part as soon as it may; the fast one then sees the first one gone.
        view, events = await asyncio.wait_for(
            service.run_to_end(world="live", robots=["fast", "slow"]), timeout=10
        )
    assert broken_constraints(events, {node.node: node.kind for node in view.nodes}) == []
    assert view.status is RunStatus.FINISHED
    cut = [each for each in events if isinstance(each, ev.NodeReset)]
    assert [(each.robot, each.reason, each.failed_attempt) for each in cut] == [
        ("slow", "what it comes after is no longer done", False)
    ]


async def test_what_a_helper_leaves_out_is_told_as_missing_with_who_said_so() -> None:
    tree = {"then": LEAVES[:2]}
    answers = ["no", "no", "yes"]
    view, events = await run_with(tree, {"part_2": ["part_1"]}, answers=answers, max_attempts=1)
    assert view.status is RunStatus.FINISHED
    assert view.result is not None
    assert view.result.reason == "the task is done without part_1, as the script said"
    [missing] = view.result.missing
    assert (missing.object, missing.place, missing.left_out_by) == ("part_1", "spot_1", "script")
    assert story(events)[-2:] == in_turn(2)
    [left_out] = [each for each in events if isinstance(each, ev.NodeLeftOut)]
    assert (left_out.node, left_out.helper) == ("/0", "script")


async def test_what_was_left_out_and_comes_back_counts_as_there() -> None:
    tree = {"then": LEAVES[:2]}
    async with pretend_service(
        definition_of(tree), scene=SCENE, thefts={"part_1": ["part_1"]}
    ) as service:
        robots: list[PretendRobot] = []

        def make(name: str) -> PretendRobot:
            robots.append(PretendRobot(name, thefts={"part_1": ["part_1"]}, returns={"part_2"}))
            return robots[-1]

        service.robots.make = make
        view, events = await service.run_to_end(answers=["no", "no", "yes"], max_attempts=1)
    assert broken_constraints(events, {node.node: node.kind for node in view.nodes}) == []
    assert view.status is RunStatus.FINISHED
    assert view.result is not None
    assert (view.result.reason, view.result.missing) == ("the task is done", [])
    assert [each.node for each in events if isinstance(each, ev.NodeReturned)] == ["/0"]


async def test_nobody_is_asked_again_about_what_was_left_out_and_only_comes_after_a_gone_part() -> (
    None
):
    answers = ["no", "no", "yes", *["yes"] * 9]
    thefts = {"part_2": ["part_2"], "part_3": ["part_1"]}
    tree = {"then": LEAVES[:3]}
    view, events = await run_with(tree, thefts, answers=answers, max_attempts=1)
    assert view.status is RunStatus.FINISHED
    assert view.result is not None
    assert [each.object for each in view.result.missing] == ["part_2"]
    undone = [each.node for each in events if isinstance(each, ev.NodeUndone)]
    assert undone == ["/1", "/2", "/1", "/0"]
    asked_about = [each.node for each in events if isinstance(each, ev.DialogueOpened)]
    assert asked_about == ["/1", "/0"]
    left_out = [each.helper for each in events if isinstance(each, ev.NodeLeftOut)]
    assert left_out == ["script", "script"]


# --- What is found in its events ----------------------------------------------------------------


async def broken(tree: Any, thefts: dict[str, list[str]], change: Any) -> list[str]:
    """What is said of a run whose events were tampered with."""
    view, events = await run_with(tree, thefts, answers=["yes"])
    tampered = [each for event in events for each in change(event)]
    return broken_constraints(tampered, {node.node: node.kind for node in view.nodes})


async def test_the_audit_finds_what_was_built_on_something_gone() -> None:
    def forget_what_follows(event: ev.Event) -> list[ev.Event]:
        follows = isinstance(event, ev.NodeUndone) and event.because_of is not None
        return [] if follows else [event]

    found = await broken({"then": LEAVES[:2]}, {"part_2": ["part_1"]}, forget_what_follows)
    assert any("takes back /0 before /1, which comes after it" in each for each in found)


async def test_the_audit_finds_what_was_taken_back_for_no_reason() -> None:
    def blame(event: ev.Event) -> list[ev.Event]:
        gone = isinstance(event, ev.NodeUndone) and event.because_of is None
        return [event.model_copy(update={"because_of": "/1"})] if gone else [event]

    found = await broken({"and": LEAVES[:2]}, {"part_2": ["part_1"]}, blame)
    assert any("takes back /0, which needs no /1" in each for each in found)


async def test_the_audit_finds_a_missing_part_that_nobody_left_out() -> None:
    part = ev.MissingPart(
        node="/0", name="part_1", object="part_1", place="spot_1", left_out_by="ann"
    )

    def claim(event: ev.Event) -> list[ev.Event]:
        finished = isinstance(event, ev.RunFinished)
        return [event.model_copy(update={"missing": [part]})] if finished else [event]

    found = await broken({"and": LEAVES[:2]}, {}, claim)
    assert any("finishes without /0, which nobody left out" in each for each in found)


# --- Everything at once -----------------------------------------------------------------------


def folded(events: list[ev.Event]) -> RunState:
    """The state of a run as its journal says it."""
    started = events[0]
    assert isinstance(started, ev.RunStarted)
    state = RunState(started, load_scripts())
    for event in events[1:]:
        state.fold(event)
    return state


def folded_directly(events: list[ev.Event]) -> TaskTree:
    """A tree to which the events' transitions were applied by direct calls."""
    started = events[0]
    assert isinstance(started, ev.RunStarted)
    tree = TaskTree(TaskTreeDefinition.model_validate(started.tree))
    tree.running = True
    for event in events:
        match event:
            case ev.NodeStarted():
                tree.start(tree.index_of(event.node), event.robot)
            case ev.NodeDone() | ev.NodeLeftOut():
                tree.finish(tree.index_of(event.node))
            case ev.NodeReset():
                tree.put_back(tree.index_of(event.node), failed=event.failed_attempt)
            case ev.NodeUndone():
                tree.take_back(tree.index_of(event.node))
            case ev.NodeAbandoned():
                tree.abandon(tree.index_of(event.node))
    return tree


def seen_of(tree: TaskTree) -> list[tuple[Any, ...]]:
    nodes = range(len(tree))
    return [
        (tree.done(i), tree.active(i), tree.abandoned(i), tree.attempts(i), tree.owner(i))
        for i in nodes
    ]


@pytest.mark.slow
@settings(max_examples=sample(30, 60), deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(
    seed=st.integers(0, 2**31 - 1),
    leaves=st.integers(1, 14),
    chance=st.floats(0, 0.6),
    answers=st.sampled_from(["random", "none", "yes"]),
)
def test_every_run_ends_and_finishes_only_with_everything_there(
    seed: int, leaves: int, chance: float, answers: str
) -> None:
    rng = np.random.default_rng(seed)
    definition = definition_of(random_task(rng, leaves)["tree"])
    thefts = {
        f"part_{part}": [f"part_{rng.integers(1, leaves + 1)}" for _ in range(rng.integers(1, 4))]
        for part in range(1, leaves + 1)
        if rng.random() < chance
    }

    async def run() -> tuple[RunView, list[ev.Event], set[str]]:
        async with pretend_service(definition, thefts=thefts) as service:
            said: Any = ["yes"] * 200 if answers == "yes" else answers
            view, events = await asyncio.wait_for(
                service.run_to_end(answers=said, seed=seed), timeout=60
            )
            [robot] = service.robots.robots.values()
            return view, events, set(robot.stolen)

    view, events, gone = asyncio.run(run())
    assert broken_constraints(events, {node.node: node.kind for node in view.nodes}) == []
    assert seen_of(folded_directly(events)) == seen_of(folded(events).tree)
    if answers == "yes":
        assert view.status is RunStatus.FINISHED
    if view.status is RunStatus.FINISHED:
        assert view.result is not None
        left_out = {each.object for each in view.result.missing}
        done = {node.object for node in view.nodes if node.done and node.object} - left_out
        assert not gone & done, "it has finished, but something is gone that it counts as done"
