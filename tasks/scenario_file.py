"""Scenario files: reading and checking them."""

from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

from tasks.document import DocumentError, LinedMapping, read_document, read_text
from tasks.library import SCENARIOS
from tasks.problem import InvalidFileError, Problem
from tasks.scenario import Scenario
from tasks.scene import Scene
from tasks.validation import show_kind, validate_part


class ScenarioFileError(InvalidFileError):
    """A scenario file has mistakes; raised by every function that reads one."""


def check_scenario_file(path: Path) -> Scenario:
    """Read and check a scenario file (YAML or JSON). Raises `ScenarioFileError`."""
    try:
        text = read_text(path)
    except DocumentError as error:
        raise ScenarioFileError(str(path), [error.problem]) from error
    return check_scenario_text(text, source=str(path))


def check_scenario_text(text: str, *, source: str = "scenario") -> Scenario:
    """Check the text of a scenario file; `source` names it in errors.

    Raises `ScenarioFileError`.
    """
    try:
        document, problems = read_document(text)
    except DocumentError as error:
        raise ScenarioFileError(source, [error.problem]) from error
    if not isinstance(document, LinedMapping):
        message = f"a scenario file is a mapping, but this is {show_kind(document)}"
        raise ScenarioFileError(source, [*problems, Problem(1, None, message)])
    scenario, mistakes = validate_part(Scenario, document)
    problems += mistakes
    if scenario is None or problems:
        raise ScenarioFileError(source, problems)
    return scenario


@cache
def built_in_scenario(name: str) -> Scenario:
    """A scenario of the library. Raises `NotInLibraryError`."""
    return check_scenario_text(SCENARIOS.read(name), source=f"scenarios/{name}.yaml")


def scene_problems(scenario: Scenario, scene: Scene) -> list[str]:
    """One sentence for each object or place of a scenario that the scene does not have."""

    def unknown(kind: str, name: str | None, known: Any, where: str) -> Iterator[str]:
        if name is not None and name not in known:
            yield f"{where} names the {kind} '{name}', which the scene '{scene.name}' has not"

    problems: list[str] = []
    for name in scenario.scene:
        problems += unknown("object", name, scene.objects, "scene")
    for index, each in enumerate(scenario.interventions):
        where = f"interventions[{index}]"
        if each.when is not None:
            problems += unknown("object", each.when.object, scene.objects, f"{where}.when")
        problems += unknown("object", each.do.object, scene.objects, f"{where}.do")
        problems += unknown("place", each.do.place, scene.places, f"{where}.do")
    return problems


def moved_scene(scene: Scene, scenario: Scenario) -> Scene:
    """The scene with its objects where the scenario wants them.

    Raises `ValueError` for an object that the scene does not have.
    """
    unknown = sorted(set(scenario.scene) - set(scene.objects))
    if unknown:
        raise ValueError(
            f"scenario '{scenario.name}' moves '{unknown[0]}', which scene '{scene.name}' "
            "does not have"
        )
    objects = {
        name: part.model_copy(update={"pose": scenario.scene.get(name, part.pose)})
        for name, part in scene.objects.items()
    }
    return scene.model_copy(update={"objects": objects})
