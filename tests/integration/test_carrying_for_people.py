"""Robots carry things and tell messages, with helpers who keep their word or do not."""

import asyncio
import json
from collections.abc import Callable
from pathlib import Path

import pytest
from sampled import sample

from mend.maps.building.building import Building
from mend.maps.building.random_building import random_building
from mend.server.composition import open_service
from mend.server.journal import events as ev
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunStatus, RunView
from mend.server.settings import Settings
from mend.sim.building.scene import scene_of
from mend.tasks.intervention import Act, Intervention
from mend.tasks.scenario import Person

EXAMPLES = Path(__file__).parents[2] / "examples" / "buildings"
PATIENCE_S = 500.0
KEEPS_WORD = Person(acts=True)
LIES = Person(acts=True, never=1.0)


def office(robots: int = 1) -> str:
    scene = scene_of(Building(random_building(7, 1, 6)), "office", robots)
    return scene.model_dump_json(exclude_defaults=True)


def task(*leaves: dict[str, str]) -> str:
    return json.dumps({"name": "task", "scene": "office", "tree": {"then": list(leaves)}})


BRING = task(
    {"behavior": "collect_item", "place": "F1-101", "item": "mail"},
    {"behavior": "hand_over_item", "place": "F1-104", "item": "mail"},
)
TELL = task({"behavior": "deliver_message", "place": "F1-101", "message": "Lunch is here."})


def settings_in(folder: Path) -> Settings:
    return Settings(port=0, data_dir=folder, log_level="error", speech_voice="none")


def request(person: Person, answers: list[str], **options: float | str) -> RunRequest:
    return RunRequest.model_validate(
        {
            "tree": "task",
            "world": "building",
            "speed": "max",
            "seed": 2,
            "answers": answers,
            "person": person,
            "world_options": {"localizer": "exact", "shut_doors": 0.0, **options},
        }
    )


async def run(
    folder: Path,
    scene: tuple[str, str],
    tree: str,
    person: Person,
    answers: list[str],
    **options: float | str,
) -> tuple[RunView, list[ev.Event]]:
    """A run and its events."""
    async with open_service(settings_in(folder)) as service, asyncio.timeout(PATIENCE_S):
        await service.library.scenes.save(*scene)
        await service.library.trees.save("task", tree)
        begun = await service.runtime.start_run(request(person, answers, **options))
        view = await service.runtime.wait_for_end(begun.id)
        events = list(await service.journal.read(0, 100_000, begun.id))
    return view, events


async def run_with_restart(
    folder: Path, so: Callable[[ev.Event], bool]
) -> tuple[RunView, list[ev.Event]]:
    """A run of `BRING` whose service is ended at an event, and begun again."""
    async with open_service(settings_in(folder)) as service, asyncio.timeout(PATIENCE_S):
        await service.library.scenes.save("office", office())
        await service.library.trees.save("task", BRING)
        begun = await service.runtime.start_run(request(KEEPS_WORD, ["yes"] * 40))
        with service.journal.subscribe(0) as records:
            async for record in records:
                if so(ev.any_event.validate_json(record.text)):
                    break
    async with open_service(settings_in(folder)) as service, asyncio.timeout(PATIENCE_S):
        view = await service.runtime.wait_for_end(begun.id)
        events = list(await service.journal.read(0, 100_000, begun.id))
    return view, events


def said(events: list[ev.Event]) -> list[str]:
    return [each.text for each in events if isinstance(each, ev.Prompt)]


def issues_of(events: list[ev.Event]) -> list[str]:
    return [each.issue for each in events if isinstance(each, ev.IssueRaised)]


def require_thanks_only_for_help(events: list[ev.Event]) -> None:
    """Whoever is thanked was felt, seen or heard to help in that very dialogue."""
    helped = {each.dialogue for each in events if isinstance(each, ev.Resolved) and each.helped}
    for each in events:
        if isinstance(each, ev.Prompt) and "Thank you" in each.text:
            assert each.dialogue in helped, each.text


@pytest.mark.slow
async def test_the_example_is_carried_out_over_the_floors(tmp_path: Path) -> None:
    kept = (EXAMPLES / "scenes" / "office_at_work.yaml").read_text("utf-8")
    tree = (EXAMPLES / "bring_and_tell.yaml").read_text("utf-8")
    view, events = await run(
        tmp_path, ("office_at_work", kept), tree, KEEPS_WORD, ["yes"] * 30, unmapped=0.0
    )
    assert view.status is RunStatus.FINISHED, view.result
    issues = issues_of(events)
    assert issues.count("item_not_given") == issues.count("item_not_taken") == 2
    assert issues.count("nobody_answers") == 1
    told = said(events)
    assert any('"The visitors for 11-12 o\'clock have come."' in each for each in told), told
    require_thanks_only_for_help(events)


@pytest.mark.slow
async def test_who_lies_is_never_thanked_and_the_run_says_what_is_missing(tmp_path: Path) -> None:
    view, events = await run(tmp_path, ("office", office()), BRING, LIES, ["yes"] * 40)
    told = said(events)
    assert not [each for each in told if "Thank you" in each or each.startswith("I feel something")]
    assert any(each.startswith("I feel nothing new in my basket.") for each in told)
    assert set(issues_of(events)) == {"item_not_given", "item_missing"}
    assert view.status is RunStatus.FINISHED
    assert view.result is not None
    assert [each.object for each in view.result.missing] == ["mail", "mail"]


@pytest.mark.slow
async def test_a_run_ends_with_its_reason_where_a_message_is_never_confirmed(
    tmp_path: Path,
) -> None:
    view, events = await run(tmp_path, ("office", office()), TELL, KEEPS_WORD, ["silence"] * 40)
    assert view.status is RunStatus.FAILED
    assert view.result is not None
    assert "'deliver_message' could not be done: it failed 3 times" in view.result.reason
    assert issues_of(events) == ["nobody_answers"] * 3
    assert [each for each in said(events) if each.startswith("I heard no answer.")]
    assert not [each for each in said(events) if "Thank you" in each]


@pytest.mark.slow
async def test_forgetful_people_are_asked_again(tmp_path: Path) -> None:
    view, events = await run(
        tmp_path, ("office", office()), BRING, KEEPS_WORD, ["yes"] * 60, forgetful=0.5
    )
    assert view.result is not None
    assert view.status in (RunStatus.FINISHED, RunStatus.FAILED)
    require_thanks_only_for_help(events)


@pytest.mark.slow
async def test_the_robot_that_has_an_item_hands_it_over(tmp_path: Path) -> None:
    view, events = await run(tmp_path, ("office", office(2)), BRING, KEEPS_WORD, ["yes"] * 20)
    assert view.status is RunStatus.FINISHED, view.result
    done = [each.robot for each in events if isinstance(each, ev.NodeDone)]
    assert len(done) == 2
    assert done[0] == done[1]
    assert "item_missing" not in issues_of(events)


@pytest.mark.slow
async def test_a_robot_with_little_left_is_plugged_in_and_goes_on(tmp_path: Path) -> None:
    view, events = await run(
        tmp_path, ("office", office()), BRING, KEEPS_WORD, ["yes"] * 40, battery_wh=1.0
    )
    assert view.status is RunStatus.FINISHED, view.result
    assert "low_battery" in issues_of(events)
    require_thanks_only_for_help(events)


def is_issue(kind: str) -> Callable[[ev.Event], bool]:
    return lambda each: isinstance(each, ev.IssueRaised) and each.issue == kind


def is_felt(help_: str) -> Callable[[ev.Event], bool]:
    return lambda each: isinstance(each, ev.HelpVerified) and each.help == help_


def is_done(name: str) -> Callable[[ev.Event], bool]:
    return lambda each: isinstance(each, ev.NodeDone) and each.name == name


MOMENTS = {
    "asked": is_issue("item_not_given"),
    "given": is_felt("put_in"),
    "collected": is_done("collect_item"),
    "offered": is_issue("item_not_taken"),
    "taken": is_felt("take_out"),
}


@pytest.mark.slow
@pytest.mark.parametrize("moment", sample(["given", "collected", "taken"], list(MOMENTS)))
async def test_what_is_carried_is_neither_lost_nor_doubled_by_a_restart(
    tmp_path: Path, moment: str
) -> None:
    view, events = await run_with_restart(tmp_path, MOMENTS[moment])
    assert view.status is RunStatus.FINISHED, view.result
    assert view.result is not None
    assert not view.result.missing
    assert not {"item_missing", "item_taken"} & set(issues_of(events))
    require_thanks_only_for_help(events)


@pytest.mark.slow
async def test_what_somebody_steals_out_of_a_basket_is_missed_and_put_back(tmp_path: Path) -> None:
    async with open_service(settings_in(tmp_path)) as service, asyncio.timeout(PATIENCE_S):
        await service.library.scenes.save("office", office())
        await service.library.trees.save("task", BRING)
        begun = await service.runtime.start_run(request(KEEPS_WORD, ["yes"] * 40))
        with service.journal.subscribe(0) as records:
            async for record in records:
                if is_done("collect_item")(ev.any_event.validate_json(record.text)):
                    break
        for thing in ("mail", "spoon"):
            theft = Intervention(act=Act.STEAL, object=thing)
            await service.runtime.intervene(begun.id, theft)
        view = await service.runtime.wait_for_end(begun.id)
        events = list(await service.journal.read(0, 100_000, begun.id))
    thefts = [e for e in events if isinstance(e, ev.InterventionDone) and e.act == "steal"]
    assert [(each.object, each.detail) for each in thefts] == [
        ("mail", ""),
        ("spoon", "'spoon' is in no robot's basket"),
    ]
    assert "item_taken" in issues_of(events)
    assert view.status is RunStatus.FINISHED, view.result
    require_thanks_only_for_help(events)
