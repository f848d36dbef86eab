"""Task trees and scenarios as the runtime takes them: checked, with their scenes."""

from pydantic import BaseModel

from server.errors import InvalidError, NotFoundError
from server.runtime.runtime import LoadedTree
from server.trees import CheckedTree, TreeLibrary
from tasks.definition import TaskTreeDefinition
from tasks.library import SCENARIOS, TREES, NotInLibraryError
from tasks.plugins import load_plugins
from tasks.scenario import Scenario
from tasks.scenario_file import built_in_scenario
from tasks.scene_file import built_in_scene
from tasks.task_file import TaskFileError, check_task_text


def built_in_trees() -> dict[str, str]:
    """The text of every task file of the library, by name."""
    return {name: TREES.read(name) for name in TREES.names()}


class TaskLibrary:
    """Implements `server.runtime.runtime.TreeSource`."""

    def __init__(self, trees: TreeLibrary) -> None:
        self._trees = trees

    async def load(self, name: str) -> LoadedTree:
        """A tree and the scene that it names. Raises `NotFoundError` or `InvalidError`."""
        view = await self._trees.tree(name)
        definition = TaskTreeDefinition.model_validate(view.definition)
        scene = built_in_scene(definition.scene) if definition.scene else None
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


def check_uploaded_tree(text: str) -> CheckedTree:
    """Read a task file. Raises `InvalidError` with one sentence per mistake."""
    try:
        definition = check_task_text(text, behavior_parameters()).definition
    except TaskFileError as error:
        problems = [each.describe("line") for each in error.problems]
        count = "a mistake" if len(problems) == 1 else f"{len(problems)} mistakes"
        raise InvalidError(f"the task file has {count}", problems) from error
    return CheckedTree(name=definition.name, definition=definition.to_json())
