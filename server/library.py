"""Task trees and scenarios as the runtime takes them: checked, with their scenes."""

from collections.abc import Iterable, Sequence
from pathlib import Path

from pydantic import BaseModel

from server.errors import InvalidError, NotFoundError
from server.runtime.ports import LoadedTree
from server.trees import CheckedTree, TreeLibrary, TreeMistake, WrongTreeError
from tasks.definition import TaskTreeDefinition
from tasks.library import SCENARIOS, SCENES, TREES, NotInLibraryError
from tasks.plugins import load_plugins
from tasks.problem import Problem
from tasks.scenario import Scenario
from tasks.scenario_file import built_in_scenario
from tasks.scene import Scene
from tasks.scene_file import SceneFileError, built_in_scene, check_scene_file
from tasks.task_file import TaskFileError, check_task_text


def built_in_trees() -> dict[str, str]:
    """The text of every task file of the library, by name."""
    return {name: TREES.read(name) for name in TREES.names()}


class Scenes:
    """The scenes that trees may name: those of a folder, then those of the library."""

    def __init__(self, folder: Path | None) -> None:
        self._folder = folder

    def names(self) -> list[str]:
        """Every scene that there is, sorted."""
        own = {path.stem for path in self._folder.glob("*.yaml")} if self._folder else set()
        return sorted({*own, *SCENES.names()})

    def find(self, name: str) -> Scene:
        """One scene. Raises `NotInLibraryError` or `SceneFileError`."""
        # Only a listed name is opened, so that a name is never taken for a path.
        for path in sorted(self._folder.glob("*.yaml")) if self._folder else ():
            if path.stem == name:
                return check_scene_file(path)
        return built_in_scene(name)


class SceneLibrary:
    """Implements `server.trees.SceneShelf`."""

    def __init__(self, scenes: Scenes) -> None:
        self._scenes = scenes

    def names(self) -> list[str]:
        return self._scenes.names()

    def scene(self, name: str) -> Scene:
        """One scene. Raises `NotFoundError`, and `InvalidError` for a file with mistakes."""
        try:
            return self._scenes.find(name)
        except NotInLibraryError as error:
            raise NotFoundError(f"there is no scene '{name}'") from error
        except SceneFileError as error:
            raise InvalidError(f"the scene '{name}' cannot be used", [str(error)]) from error


class TaskLibrary:
    """Implements `server.runtime.runtime.TreeSource`."""

    def __init__(self, trees: TreeLibrary, scenes: Scenes) -> None:
        self._trees = trees
        self._scenes = scenes

    async def load(self, name: str) -> LoadedTree:
        """A tree and the scene that it names. Raises `NotFoundError` or `InvalidError`."""
        view = await self._trees.tree(name)
        definition = TaskTreeDefinition.model_validate(view.definition)
        try:
            scene = self._scenes.find(definition.scene) if definition.scene else None
        except (NotInLibraryError, SceneFileError) as error:
            raise InvalidError(f"the scene of tree '{name}' cannot be used: {error}") from error
        return LoadedTree(name, definition, scene)


class BuiltInScenarios:
    """The scenarios that come with Mend."""

    def scenarios(self) -> list[Scenario]:
        return [built_in_scenario(name) for name in SCENARIOS.names()]

    def load(self, name: str) -> Scenario:
        """One scenario. Raises `NotFoundError`."""
        try:
            return built_in_scenario(name)
        except NotInLibraryError as error:
            raise NotFoundError(str(error)) from error


def behavior_parameters() -> dict[str, type[BaseModel]]:
    """The parameter model of every behavior, by name."""
    return {name: each.parameters for name, each in load_plugins("mend.behaviors").items()}


def check_uploaded_tree(text: str, scenes: Scenes) -> CheckedTree:
    """Read a task file. Raises `WrongTreeError` with every mistake."""
    try:
        definition = check_task_text(text, behavior_parameters(), scenes.find).definition
    except TaskFileError as error:
        sentences = [each.describe("line") for each in error.problems]
        raise WrongTreeError(_mistakes(error.problems, text), sentences) from error
    return CheckedTree(name=definition.name, definition=definition.to_json())


def _mistakes(problems: Iterable[Problem], text: str) -> list[TreeMistake]:
    lines = text.splitlines()
    return [
        TreeMistake(
            line=each.line,
            column=each.column or _content_column(lines, each.line),
            node=each.node_path,
            message=each.message,
        )
        for each in problems
    ]


def _content_column(lines: Sequence[str], number: int | None) -> int | None:
    """Where the content of a line begins, after its indentation and the dashes of a list."""
    if number is None or not 0 < number <= len(lines):
        return None
    line = lines[number - 1]
    return len(line) - len(line.lstrip(" -\t")) + 1
