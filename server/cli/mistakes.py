"""Every mistake of a file, one `file:line: sentence` each, also what no robot could do."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from mend.documents.problem import InvalidFileError, Problem
from mend.server.behaviors import behavior_step_counts
from mend.server.cli.task_files import (
    SceneSource,
    is_file,
    read_task,
    scene_of_task_file,
    task_of_scenario_file,
)
from mend.server.scene_checks import WorldChecks
from mend.tasks.library import NotInLibraryError
from mend.tasks.scenario_file import Misfit, ReadScenario, find_misfits, read_scenario_file
from mend.tasks.scene_file import read_scene_file
from mend.tasks.scene_problem import SceneProblem
from mend.tasks.task_file import CheckedTask

InWorlds = Mapping[str, Iterable[SceneProblem]]
"""What each world's robot cannot do."""


@dataclass(frozen=True, slots=True)
class Checked:
    """What is wrong with a file, and the `worlds` that were asked about it."""

    mistakes: Sequence[str]
    worlds: Sequence[str] = ()


def task_mistakes(path: Path, worlds: WorldChecks) -> Checked:
    """Every mistake of a task file, and what a robot cannot do in its scene."""
    try:
        task = read_task(path)
        name = task.definition.scene
        found = scene_of_task_file(path, name) if name else None
    except InvalidFileError as error:
        return Checked(str(error).splitlines())
    if found is None:
        return Checked([])
    return _in_scene(worlds.try_tree(found.read.scene, task.definition), found)


def scene_mistakes(path: Path, worlds: WorldChecks) -> Checked:
    """Every mistake of a scene file, and what a robot cannot do with its objects."""
    try:
        found = SceneSource(read_scene_file(path), str(path))
    except InvalidFileError as error:
        return Checked(str(error).splitlines())
    return _in_scene(worlds.try_scene(found.read.scene), found)


def scenario_mistakes(
    path: Path,
    worlds: WorldChecks,  # noqa: ARG001
    tree: str | None = None,
) -> Checked:
    """Every mistake of a scenario file, also what it expects of its tree and does not get.

    `tree` names the tree, or its file, where that is given.
    """
    try:
        read = read_scenario_file(path)
        task = _task_of(path, read, tree)
    except InvalidFileError as error:
        return Checked(str(error).splitlines())
    except NotInLibraryError as error:
        misfits = [Misfit(("tree",), str(error))]
    else:
        if task.definition.name != read.scenario.tree:
            other = task.definition.name
            message = f"the scenario is for the task tree '{read.scenario.tree}', not '{other}'"
            return Checked([read.problem(Misfit(("tree",), message)).describe(str(path))])
        misfits = find_misfits(read.scenario, task.definition, task.scene, behavior_step_counts())
    return Checked([read.problem(each).describe(str(path)) for each in misfits])


def _task_of(path: Path, read: ReadScenario, tree: str | None) -> CheckedTask:
    if tree is not None and is_file(tree):
        return read_task(Path(tree))
    return task_of_scenario_file(path, tree or read.scenario.tree)


def delivery_mistakes(path: Path, worlds: WorldChecks) -> Checked:  # noqa: ARG001
    """Every mistake of a delivery file, else what contradicts itself in it."""
    # Imported only here: schedulers would make every other command wait.
    from mend.fleet.scheduling.problem_file import read_delivery_file

    try:
        delivery = read_delivery_file(path)
    except InvalidFileError as error:
        return Checked(str(error).splitlines())
    return Checked([each.describe(str(path)) for each in delivery.infeasibilities])


CHECKERS: Mapping[str, Callable[[Path, WorldChecks], Checked]] = {
    "task": task_mistakes,
    "scene": scene_mistakes,
    "scenario": scenario_mistakes,
    "delivery": delivery_mistakes,
}


def _in_scene(problems: InWorlds, scene: SceneSource) -> Checked:
    """Problems with the lines of the scene's file; one that all worlds have is told once."""
    told: dict[Problem, list[str]] = {}
    for world, found in problems.items():
        for each in found:
            told.setdefault(scene.problem(each), []).append(world)
    ordered = sorted(told.items(), key=lambda item: item[0].line or 0)
    mistakes = [
        Problem(problem.line, None, f"{in_worlds(worlds)}: {problem.message}").describe(
            scene.source
        )
        for problem, worlds in ordered
    ]
    return Checked(mistakes, sorted(problems))


def in_worlds(worlds: Sequence[str]) -> str:
    """Where something is so, for a sentence."""
    names = " and ".join(f"'{world}'" for world in worlds)
    return f"in the world {names}" if len(worlds) == 1 else f"in the worlds {names}"
