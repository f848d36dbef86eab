"""Task trees and scenarios as the runtime takes them: checked, with their scenes."""

from server.errors import InvalidError, NotFoundError
from server.runtime.runtime import LoadedTree
from server.trees import CheckedTree, TreeLibrary
from tasks.definition import TaskTreeDefinition
from tasks.library import load_scene
from tasks.plugins import load_plugins
from tasks.scenario import Scenario
from tasks.scenario_file import ScenarioFileError, load_scenario, scenario_names
from tasks.task_file import TaskFileError, read_task_text


class TaskLibrary:
    """Implements `server.runtime.runtime.TreeSource`."""

    def __init__(self, trees: TreeLibrary) -> None:
        self._trees = trees

    async def load(self, name: str) -> LoadedTree:
        """A tree and the scene that it names. Raises `NotFoundError` or `InvalidError`."""
        view = await self._trees.tree(name)
        definition = TaskTreeDefinition.model_validate(view.definition)
        scene = load_scene(definition.scene) if definition.scene else None
        return LoadedTree(name, definition, scene)


class BuiltInScenarios:
    """The scenarios that come with Mend."""

    def scenarios(self) -> list[Scenario]:
        return [load_scenario(name) for name in scenario_names()]

    def load(self, name: str) -> Scenario:
        """One scenario. Raises `NotFoundError`."""
        try:
            return load_scenario(name)
        except ScenarioFileError as error:
            raise NotFoundError(error.problems[0]) from error


def behavior_parameters() -> dict[str, type]:
    """The parameter model of every behavior, by name."""
    return {name: each.parameters for name, each in load_plugins("mend.behaviors").items()}


def check_task_text(text: str) -> CheckedTree:
    """Read a task file. Raises `InvalidError` with one sentence per mistake."""
    try:
        definition = read_task_text(text, behavior_parameters())
    except TaskFileError as error:
        problems = [str(each) for each in error.problems]
        raise InvalidError(f"the task file has {len(problems)} mistakes", problems) from error
    return CheckedTree(name=definition.name, definition=definition.to_json())
