"""A head camera that shows nothing: the robot says so, and calls nothing done that is unseen."""

from pathlib import Path
from typing import Any

import pytest
import yaml
from broken_constraints import broken_constraints

from mend.server.composition import open_service
from mend.server.journal import events as ev
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunStatus, RunView
from mend.server.settings import Settings

BEGINNING = {
    "name": "beginning",
    "scene": "eket",
    "tree": {
        "then": [
            {"behavior": "pick_and_place", "object": part, "place": part}
            for part in ("green_leg", "pink_bar")
        ]
    },
}
"""The first two parts of the EKET base."""

LEG = {
    "name": "leg",
    "scene": "eket",
    "tree": {"behavior": "pick_and_place", "object": "green_leg", "place": "green_leg"},
}


async def build(
    tmp_path: Path, interventions: list[dict[str, Any]], tree: str = "eket", **request: Any
) -> tuple[RunView, list[ev.Event]]:
    """The EKET base while people do what the scenario says."""
    scenario = {"name": "dark", "tree": tree, "interventions": interventions}
    settings = Settings(port=0, data_dir=tmp_path, speech_voice="none", log_level="error")
    async with open_service(settings) as service:
        await service.library.trees.save("beginning", yaml.safe_dump(BEGINNING))
        await service.library.trees.save("leg", yaml.safe_dump(LEG))
        await service.library.scenarios.save("dark", yaml.safe_dump(scenario))
        asked = {"tree": tree, "speed": "max", "seed": 7, "scenario": "dark", **request}
        run = await service.runtime.start_run(RunRequest.model_validate(asked))
        view = await service.runtime.wait_for_end(run.id)
        events = await service.journal.read(0, 100_000, run.id)
    assert broken_constraints(events, {node.node: node.kind for node in view.nodes}) == []
    return view, events


def during(part: str, step: int, act: str, **fields: Any) -> dict[str, Any]:
    return {"when": {"object": part, "step": step}, "do": {"act": act, **fields}}


def raised(events: list[ev.Event]) -> list[tuple[str, str | None]]:
    issues = (each for each in events if isinstance(each, ev.IssueRaised))
    return [(each.issue, each.object) for each in issues if each.issue != "positioning"]


@pytest.mark.slow
@pytest.mark.parametrize("world", ["tabletop", "workcell"])
async def test_a_covered_camera_is_told_and_uncovered_and_the_task_is_done(
    world: str, tmp_path: Path
) -> None:
    dark = [during("green_leg", 5, "cover")]
    view, events = await build(tmp_path, dark, tree="leg", world=world, answers=["yes"] * 20)
    assert view.status is RunStatus.FINISHED
    assert raised(events) == [("blind", "green_leg")]
    [issue] = [each for each in events if isinstance(each, ev.IssueRaised) and each.interrupts]
    assert issue.detection is not None
    assert issue.detection.explanation == "the picture of my head camera is black"
    [done] = [each for each in events if isinstance(each, ev.NodeDone)]
    assert done.by == "robot"


@pytest.mark.slow
async def test_what_is_stolen_while_it_is_dark_is_never_called_done(tmp_path: Path) -> None:
    parts = ["green_leg", "pink_bar", "yellow_bar"]
    dark = [during("yellow_bar", 5, "cover")]
    dark += [during("yellow_bar", 7, "steal", object=each) for each in parts[:2]]
    view, events = await build(
        tmp_path, dark, world="tabletop", answers=["yes"] * 2 + ["no"] * 40, max_attempts=1
    )
    assert raised(events)[0] == ("blind", "yellow_bar")
    assert {part for issue, part in raised(events) if issue == "undone"} == {"green_leg"}
    assert view.status is RunStatus.FAILED


@pytest.mark.slow
async def test_with_nobody_there_a_robot_in_the_dark_fails_and_says_why(tmp_path: Path) -> None:
    dark = [during("green_leg", 2, "cover")]
    view, events = await build(tmp_path, dark, world="tabletop", answers="none", max_attempts=1)
    assert view.status is RunStatus.FAILED
    assert raised(events) == [("blind", "green_leg")]
    assert not [each for each in events if isinstance(each, ev.NodeDone)]


@pytest.mark.slow
async def test_what_is_stolen_from_under_what_is_on_its_way_is_missed_before_it_is_covered(
    tmp_path: Path,
) -> None:
    theft = [during("purple_top", 4, "steal", object="pink_bar")]
    view, events = await build(tmp_path, theft, world="tabletop", answers=["yes"] * 20)
    assert view.status is RunStatus.FINISHED
    undone = [each for each in events if isinstance(each, ev.NodeUndone)]
    assert [each.name for each in undone if each.because_of is None] == ["pink_bar"]
    last = events[-1]
    assert isinstance(last, ev.RunFinished)
    assert {each.object for each in last.unseen} == {
        "green_leg",
        "pink_bar",
        "yellow_bar",
        "blue_leg",
    }


def at(time_s: float, act: str, **fields: Any) -> dict[str, Any]:
    return {"at_s": time_s, "do": {"act": act, **fields}}


@pytest.mark.slow
async def test_what_is_put_back_after_the_camera_sees_again_is_help(tmp_path: Path) -> None:
    dark = [during("pink_bar", 4, "cover"), during("pink_bar", 5, "steal", object="pink_bar")]
    dark += [at(40.0, "uncover"), at(46.0, "put_back", object="pink_bar")]
    view, events = await build(
        tmp_path, dark, tree="beginning", world="tabletop", answers=["silence"] * 9, max_attempts=1
    )
    [dropped] = [each for each in events if isinstance(each, ev.Resolved)]
    assert raised(events) == [("dropped", "pink_bar")]
    assert dropped.helped
    assert view.status is RunStatus.FINISHED
    assert [each.blind for each in events if isinstance(each, ev.FirstLook)] == [True]
    assert len([each for each in events if isinstance(each, ev.LookedAnew)]) == 1


@pytest.mark.slow
async def test_a_camera_that_only_sees_again_puts_no_lost_part_right(tmp_path: Path) -> None:
    dark = [during("pink_bar", 4, "cover"), during("pink_bar", 5, "steal", object="pink_bar")]
    dark += [at(15.5, "put_back", object="pink_bar"), at(40.0, "uncover")]
    view, events = await build(
        tmp_path, dark, tree="beginning", world="tabletop", answers=["silence"] * 9, max_attempts=1
    )
    assert [each for each in events if isinstance(each, ev.Resolved)] == []
    assert view.status is RunStatus.FAILED
