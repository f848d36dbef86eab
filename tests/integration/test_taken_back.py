"""What people take after it was done, in a simulated world: it is seen, and done again."""

from pathlib import Path
from typing import Any

import pytest
import yaml
from broken_constraints import broken_constraints
from sampled import sample

from mend.server.composition import open_service
from mend.server.journal import events as ev
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunStatus, RunView
from mend.server.settings import Settings

FRAME = ("green_leg", "pink_bar", "yellow_bar", "blue_leg")
ALL = (*FRAME, "purple_top")
BEGINNING = """
name: beginning
scene: eket
tree:
  then:
    - {behavior: pick_and_place, object: green_leg, place: green_leg}
    - {behavior: pick_and_place, object: pink_bar, place: pink_bar}
"""


async def build(
    tmp_path: Path, interventions: list[dict[str, Any]], tree: str = "eket", **request: Any
) -> tuple[RunView, list[ev.Event]]:
    """The EKET base, or its beginning, on the tabletop while people do what the scenario says."""
    scenario = {"name": "thief", "tree": tree, "interventions": interventions}
    settings = Settings(port=0, data_dir=tmp_path, speech_voice="none", log_level="error")
    async with open_service(settings) as service:
        await service.library.trees.save("beginning", BEGINNING)
        await service.library.scenarios.save("thief", yaml.safe_dump(scenario))
        run = await service.runtime.start_run(
            RunRequest(
                tree=tree, world="tabletop", speed="max", seed=7, scenario="thief", **request
            )
        )
        view = await service.runtime.wait_for_end(run.id)
        events = await service.journal.read(0, 100_000, run.id)
    assert broken_constraints(events, {node.node: node.kind for node in view.nodes}) == []
    return view, events


def steal(part: str, *, during: str, step: int, fraction: float = 0.0) -> dict[str, Any]:
    return {
        "when": {"object": during, "step": step, "fraction": fraction},
        "do": {"act": "steal", "object": part},
    }


def undone(events: list[ev.Event]) -> list[str]:
    """What was seen gone, in the order in which it was taken back."""
    found = (each for each in events if isinstance(each, ev.NodeUndone))
    return [each.name for each in found if each.because_of is None]


def raised(events: list[ev.Event]) -> list[tuple[str, str | None]]:
    issues = (each for each in events if isinstance(each, ev.IssueRaised))
    return [(each.issue, each.object) for each in issues if each.issue != "positioning"]


@pytest.mark.slow
async def test_a_leg_stolen_after_it_was_placed_is_placed_again_and_what_follows_found(
    tmp_path: Path,
) -> None:
    thefts = [steal("green_leg", during="yellow_bar", step=3)]
    view, events = await build(tmp_path, thefts, answers=["yes"] * 20)
    assert view.status is RunStatus.FINISHED
    assert undone(events) == ["green_leg"]
    assert raised(events) == [("undone", "green_leg")]
    follows = [e for e in events if isinstance(e, ev.NodeUndone) and e.because_of is not None]
    assert [each.name for each in follows] == ["yellow_bar", "pink_bar"]


@pytest.mark.slow
@pytest.mark.parametrize(("step", "issue"), [(4, "dropped"), (6, "undone")])
async def test_who_places_what_was_to_be_put_back_has_done_it(
    step: int, issue: str, tmp_path: Path
) -> None:
    deeds = [
        steal("green_leg", during="green_leg", step=step, fraction=0.5),
        {"at_s": 26.0, "do": {"act": "place", "object": "green_leg", "place": "green_leg"}},
    ]
    view, events = await build(
        tmp_path, deeds, "beginning", answers=["yes"] * 20, person={"never": 1.0}
    )
    assert view.status is RunStatus.FINISHED
    assert raised(events) == [(issue, "green_leg")]
    done = [each for each in events if isinstance(each, ev.NodeDone) and each.name == "green_leg"]
    assert [each.by for each in done] == ["human"]


@pytest.mark.slow
async def test_all_parts_stolen_after_they_were_placed_are_placed_again(tmp_path: Path) -> None:
    thefts = [steal(part, during="purple_top", step=8, fraction=0.9) for part in ALL]
    view, events = await build(tmp_path, thefts, answers=["yes"] * 40)
    assert view.status is RunStatus.FINISHED
    assert view.result is not None
    assert view.result.missing == []
    assert sorted(undone(events)) == sorted(FRAME)
    assert {issue for issue, _ in raised(events)} == {"undone"}


@pytest.mark.slow
@pytest.mark.parametrize("step", sample([7], [6, 7, 8]))
async def test_what_is_stolen_while_it_is_placed_is_never_called_done(
    step: int, tmp_path: Path
) -> None:
    thefts = [steal("pink_bar", during="pink_bar", step=step, fraction=0.5)]
    view, events = await build(tmp_path, thefts, "beginning", answers="none", max_attempts=1)
    assert view.status is RunStatus.FAILED
    assert view.result is not None
    assert view.result.reason == "'pink_bar' could not be done: it failed once"
    assert not [e for e in events if isinstance(e, ev.NodeDone) and e.name == "pink_bar"]
    assert {part for _, part in raised(events)} == {"pink_bar"}


@pytest.mark.slow
async def test_with_nobody_there_a_stolen_part_ends_the_run_with_its_name(tmp_path: Path) -> None:
    thefts = [steal("pink_bar", during="blue_leg", step=8, fraction=0.9)]
    view, events = await build(tmp_path, thefts, answers="none", max_attempts=1)
    assert view.status is RunStatus.FAILED
    assert view.result is not None
    assert view.result.reason == "'pink_bar' could not be done: it failed once"
    assert undone(events) == ["pink_bar"]


@pytest.mark.slow
async def test_what_is_moved_from_its_place_is_placed_again_without_a_question(
    tmp_path: Path,
) -> None:
    move = {
        "when": {"object": "pink_bar", "step": 2},
        "do": {"act": "move", "object": "green_leg", "to": {"x": 0.72, "y": -0.10}},
    }
    view, events = await build(tmp_path, [move], "beginning", answers="none")
    assert undone(events) == ["green_leg"]
    assert raised(events) == [("undone", "green_leg")]
    assert view.status is RunStatus.FINISHED
