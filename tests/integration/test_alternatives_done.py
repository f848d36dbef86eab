"""What people put to the place of an alternative is taken as done, and never taken away again."""

from pathlib import Path
from typing import Any

import pytest
import yaml
from broken_constraints import broken_constraints

from mend.server.composition import open_service
from mend.server.journal import events as ev
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunStatus
from mend.server.settings import Settings

MUG = {"behavior": "pick_and_place", "object": "mug", "place": "mug"}
ONE_PLACE = ("black_tea", "tea"), ("green_tea", "tea")
ONE_PART = ("black_tea", "tea"), ("black_tea", "sweet")


def task(alternatives: Any) -> dict[str, Any]:
    """The mug, then one of two alternatives."""
    leaves = [
        {"behavior": "pick_and_place", "object": part, "place": place, "name": f"{part}_{place}"}
        for part, place in alternatives
    ]
    return {"name": "choice", "scene": "order", "tree": {"then": [MUG, {"or": leaves}]}}


async def build(tmp_path: Path, alternatives: Any, *deeds: dict[str, Any]) -> list[ev.Event]:
    scenario = {"name": "giver", "tree": "choice", "interventions": list(deeds)}
    settings = Settings(port=0, data_dir=tmp_path, speech_voice="none", log_level="error")
    async with open_service(settings) as service:
        await service.library.trees.save("choice", yaml.safe_dump(task(alternatives)))
        await service.library.scenarios.save("giver", yaml.safe_dump(scenario))
        run = await service.runtime.start_run(
            RunRequest(
                tree="choice",
                world="tabletop",
                speed="max",
                seed=3,
                scenario="giver",
                answers=["yes"] * 9,
                person={"never": 1.0},
            )
        )
        view = await service.runtime.wait_for_end(run.id)
        events = await service.journal.read(0, 100_000, run.id)
    assert broken_constraints(events, {node.node: node.kind for node in view.nodes}) == []
    assert view.status is RunStatus.FINISHED
    return events


def started(events: list[ev.Event]) -> list[str]:
    return [each.name for each in events if isinstance(each, ev.NodeStarted)]


def done(events: list[ev.Event]) -> list[tuple[str, str]]:
    return [(each.name, each.by) for each in events if isinstance(each, ev.NodeDone)]


def asked(events: list[ev.Event]) -> list[str]:
    return [each.text for each in events if isinstance(each, ev.Prompt)]


@pytest.mark.slow
@pytest.mark.parametrize("alternatives", [ONE_PLACE, ONE_PART])
async def test_what_is_put_there_before_the_choice_is_found(
    alternatives: Any, tmp_path: Path
) -> None:
    part, place = alternatives[1]
    deed = {
        "when": {"object": "mug", "step": 3},
        "do": {"act": "place", "object": part, "place": place},
    }
    events = await build(tmp_path, alternatives, deed)
    assert started(events) == ["mug", f"{part}_{place}"]
    assert done(events) == [("mug", "robot"), (f"{part}_{place}", "found")]
    assert asked(events) == []
    chosen = [each for each in events if isinstance(each, ev.NodeStarted)][-1]
    assert [each.in_place for each in chosen.candidates] == [True, False]


@pytest.mark.slow
async def test_what_is_put_there_while_the_robot_asks_ends_the_question(tmp_path: Path) -> None:
    steal = {"when": {"object": "mug", "step": 3}, "do": {"act": "steal", "object": "black_tea"}}
    place = {"at_s": 40.0, "do": {"act": "place", "object": "black_tea", "place": "sweet"}}
    events = await build(tmp_path, ONE_PART, steal, place)
    assert started(events) == ["mug", "black_tea_tea", "black_tea_sweet"]
    assert done(events) == [("mug", "robot"), ("black_tea_sweet", "found")]
    assert asked(events)[0].startswith("I cannot find the black tea.")
    assert asked(events)[-1] == "The black tea is at the sweet already, which does as well."
    [closed] = [each for each in events if isinstance(each, ev.DialogueClosed)]
    assert closed.reason == "aborted"
    [reset] = [each for each in events if isinstance(each, ev.NodeReset)]
    assert not reset.failed_attempt
