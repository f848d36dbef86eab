"""The files that commands take: read, or every mistake as `file:line: sentence`."""

from dataclasses import dataclass
from pathlib import Path

from mend.documents.problem import Problem, list_names
from mend.server.behaviors import behavior_parameters
from mend.server.cli.failures import CommandLineError
from mend.tasks.library import SCENES, NotInLibraryError
from mend.tasks.scene import Scene
from mend.tasks.scene_file import ReadScene, check_scene_file, read_scene_file, read_scene_text
from mend.tasks.scene_problem import SceneProblem
from mend.tasks.task_file import CheckedTask, check_built_in_task, check_task_file

SUFFIXES = (".yaml", ".yml", ".json")


@dataclass(frozen=True, slots=True)
class SceneSource:
    """A scene with its lines, and what its file is called in sentences."""

    read: ReadScene
    source: str

    def problem(self, problem: SceneProblem) -> Problem:
        """A problem of the scene with its line."""
        return Problem(self.read.line_of(problem.where), None, problem.message)


def read_text(path: Path) -> str:
    """A file's text. Raises `CommandLineError` if it is none, and `OSError`."""
    try:
        return path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise CommandLineError(f"'{path}' is not a text file in UTF-8") from error


def read_task(path: Path, scene: Scene | None = None) -> CheckedTask:
    """A task file, with its own scene or another one.

    Raises `InvalidFileError` with every mistake.
    """
    return check_task_file(path, behavior_parameters(), scene=scene)


def read_scene(path: Path) -> Scene:
    """A scene file. Raises `InvalidFileError` with every mistake."""
    return check_scene_file(path)


def scene_of_task_file(path: Path, name: str) -> SceneSource:
    """The scene that a task file names: beside it, else of the library.

    Raises `NotInLibraryError` and `InvalidFileError`.
    """
    beside = path.parent / "scenes" / f"{name}.yaml"
    if beside.is_file():
        return SceneSource(read_scene_file(beside), str(beside))
    source = f"scenes/{name}.yaml"
    return SceneSource(read_scene_text(SCENES.read(name), source=source), source)


def task_of_scenario_file(path: Path, tree: str) -> CheckedTask:
    """The task tree that a scenario file is for: of the library, else a file of its name.

    That is beside the scenario, or in the folder above. Raises `NotInLibraryError` and
    `InvalidFileError`.
    """
    try:
        return check_built_in_task(tree, behavior_parameters())
    except NotInLibraryError as error:
        folders = (path.parent, path.parent / "..")
        files = [folder / f"{tree}{suffix}" for folder in folders for suffix in SUFFIXES]
        found = next((each for each in files if each.is_file()), None)
        if found is None:
            looked = list_names(str(each) for each in files)
            raise NotInLibraryError(
                f"{error}, nor is there any of the files {looked}; or name its file with --tree"
            ) from error
        return read_task(found)


def is_file(argument: str) -> bool:
    """Whether an argument names a file rather than something of the library."""
    return Path(argument).suffix in SUFFIXES or "/" in argument
