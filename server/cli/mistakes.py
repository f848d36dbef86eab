"""Every mistake of a file, one `file:line: sentence` each, also what no robot could do."""

from collections.abc import Iterable, Mapping
from pathlib import Path

from server.cli.task_files import (
    SceneSource,
    read_task,
    scene_of_task_file,
    task_of_scenario_file,
)
from server.scene_checks import WorldChecks
from tasks.library import NotInLibraryError
from tasks.problem import InvalidFileError, Problem
from tasks.scenario_file import check_scenario_file, scene_problems
from tasks.scene_file import read_scene_file
from tasks.scene_problem import SceneProblem

InWorlds = Mapping[str, Iterable[SceneProblem]]
"""What each world's robot cannot do."""


def task_mistakes(path: Path, worlds: WorldChecks) -> list[str]:
    """Every mistake of a task file, and what a robot cannot do in its scene."""
    try:
        task = read_task(path)
        name = task.definition.scene
        found = scene_of_task_file(path, name) if name else None
    except InvalidFileError as error:
        return str(error).splitlines()
    if found is None:
        return []
    return _in_scene(worlds.try_tree(found.read.scene, task.definition), found)


def scene_mistakes(path: Path, worlds: WorldChecks) -> list[str]:
    """Every mistake of a scene file, and what a robot cannot do with its objects."""
    try:
        found = SceneSource(read_scene_file(path), str(path))
    except InvalidFileError as error:
        return str(error).splitlines()
    return _in_scene(worlds.try_scene(found.read.scene), found)


def scenario_mistakes(path: Path, worlds: WorldChecks) -> list[str]:  # noqa: ARG001
    """Every mistake of a scenario file, also what it expects of its tree and does not get."""
    try:
        scenario = check_scenario_file(path)
        task = task_of_scenario_file(path, scenario.tree)
    except InvalidFileError as error:
        return str(error).splitlines()
    except NotInLibraryError as error:
        return [f"{path}: tree: {error}"]
    problems = scene_problems(scenario, task.scene) if task.scene else []
    return [f"{path}: {each}" for each in problems]


def delivery_mistakes(path: Path, worlds: WorldChecks) -> list[str]:  # noqa: ARG001
    """Every mistake of a delivery file, else what contradicts itself in it."""
    # Imported only here: schedulers would make every other command wait.
    from fleet.scheduling.problem_file import read_delivery_file

    try:
        delivery = read_delivery_file(path)
    except InvalidFileError as error:
        return str(error).splitlines()
    return [each.describe(str(path)) for each in delivery.contradictions]


def _in_scene(problems: InWorlds, scene: SceneSource) -> list[str]:
    """Problems with the lines of the scene's file; one that all worlds have is told once."""
    told: dict[Problem, list[str]] = {}
    for world, found in problems.items():
        for each in found:
            problem = Problem(scene.read.line_of(each.where), None, each.message)
            told.setdefault(problem, []).append(world)
    ordered = sorted(told.items(), key=lambda item: item[0].line or 0)
    return [
        Problem(problem.line, None, f"{_in_worlds(worlds)}: {problem.message}").describe(
            scene.source
        )
        for problem, worlds in ordered
    ]


def _in_worlds(worlds: list[str]) -> str:
    names = " and ".join(f"'{world}'" for world in worlds)
    return f"in the world {names}" if len(worlds) == 1 else f"in the worlds {names}"
