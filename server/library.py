"""Task trees and scenarios as the runtime takes them: checked, with their scenes."""

from pathlib import Path

from pydantic import BaseModel

from server.errors import InvalidError, NotFoundError
from server.runtime.ports import LoadedTree
from server.trees import CheckedTree, TreeLibrary
from tasks.definition import TaskTreeDefinition
from tasks.library import SCENARIOS, TREES, NotInLibraryError
from tasks.plugins import load_plugins
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

    def find(self, name: str) -> Scene:
        """One scene. Raises `NotInLibraryError` or `SceneFileError`."""
        # Only a listed name is opened, so that a name is never taken for a path.
        for path in sorted(self._folder.glob("*.yaml")) if self._folder else ():
            if path.stem == name:
                return check_scene_file(path)
        return built_in_scene(name)


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
    """Read a task file. Raises `InvalidError` with one sentence per mistake."""
    try:
        definition = check_task_text(text, behavior_parameters(), scenes.find).definition
    except TaskFileError as error:
        problems = [each.describe("line") for each in error.problems]
        count = "a mistake" if len(problems) == 1 else f"{len(problems)} mistakes"
        raise InvalidError(f"the task file has {count}", problems) from error
    return CheckedTree(name=definition.name, definition=definition.to_json())
