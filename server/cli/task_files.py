"""The files that commands take: read, or every mistake as `file:line: sentence`."""

from pathlib import Path

from server.cli.failures import CommandLineError
from server.library import behavior_parameters
from tasks.library import NotInLibraryError
from tasks.problem import InvalidFileError
from tasks.scenario import Scenario
from tasks.scenario_file import check_scenario_file, scene_problems
from tasks.scene import Scene
from tasks.scene_file import check_scene_file
from tasks.task_file import CheckedTask, check_built_in_task, check_task_file


def read_text(path: Path) -> str:
    """A file's text. Raises `CommandLineError` if it is none, and `OSError`."""
    try:
        return path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise CommandLineError(f"'{path}' is not a text file in UTF-8") from error


def read_task(path: Path) -> CheckedTask:
    """A task file. Raises `InvalidFileError` with every mistake."""
    return check_task_file(path, behavior_parameters())


def read_scene(path: Path) -> Scene:
    """A scene file. Raises `InvalidFileError` with every mistake."""
    return check_scene_file(path)


def task_mistakes(path: Path) -> list[str]:
    """Every mistake of a task file, also what its scene does not have."""
    try:
        read_task(path)
    except InvalidFileError as error:
        return str(error).splitlines()
    return []


def scene_mistakes(path: Path) -> list[str]:
    """Every mistake of a scene file."""
    try:
        read_scene(path)
    except InvalidFileError as error:
        return str(error).splitlines()
    return []


def scenario_mistakes(path: Path) -> list[str]:
    """Every mistake of a scenario file, also what the scene of its tree does not have."""
    try:
        scenario = check_scenario_file(path)
    except InvalidFileError as error:
        return str(error).splitlines()
    return [f"{path}: {each}" for each in _tree_problems(scenario)]


def delivery_mistakes(path: Path) -> list[str]:
    """Every mistake of a delivery file, else what contradicts itself in it."""
    # Imported only here: schedulers would make every other command wait.
    from fleet.scheduling.problem_file import read_delivery_file

    try:
        delivery = read_delivery_file(path)
    except InvalidFileError as error:
        return str(error).splitlines()
    return [each.describe(str(path)) for each in delivery.contradictions]


def _tree_problems(scenario: Scenario) -> list[str]:
    """What a scenario expects of its tree and the tree's scene, and does not get."""
    try:
        task = check_built_in_task(scenario.tree, behavior_parameters())
    except NotInLibraryError as error:
        return [f"tree: {error}"]
    return scene_problems(scenario, task.scene) if task.scene else []
