"""The TREE, --scene and --scenario of `mend run`: names of the library, or files."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from mend.documents.problem import InvalidFileError
from mend.server.behaviors import behavior_parameters, behavior_step_counts
from mend.server.cli.failures import CommandLineError
from mend.server.cli.task_files import SceneSource, is_file, read_task, read_text
from mend.server.documents import DocumentKind
from mend.server.fixed_documents import GivenFiles
from mend.tasks.library import TREES
from mend.tasks.scenario import Scenario
from mend.tasks.scenario_file import Misfit, built_in_scenario, find_misfits, read_scenario_file
from mend.tasks.scene import Scene
from mend.tasks.scene_file import built_in_scene, check_scene_file, read_scene_file
from mend.tasks.scene_problem import SceneProblem
from mend.tasks.task_file import CheckedTask, check_built_in_task


@dataclass(frozen=True, slots=True)
class RunFiles:
    """What a run is to name, and the texts of the files that were given for it.

    `scene_file` is the file of the scene, None where that is built in.
    """

    tree: str
    scene: str | None = None
    scenario: Scenario | None = None
    given: GivenFiles = field(default_factory=GivenFiles)
    scene_file: Path | None = None

    def described(self, problems: Sequence[SceneProblem]) -> list[str]:
        """One sentence per problem of the run's scene, with its line where that is a file."""
        if self.scene_file is None:
            return [each.message for each in problems]
        scene = SceneSource(read_scene_file(self.scene_file), str(self.scene_file))
        return [scene.problem(each).describe(scene.source) for each in problems]


def read_run_files(tree: str, scene: str | None, scenario: str | None) -> RunFiles:
    """Take what names a file for one, everything else for a name.

    Raises `InvalidFileError` for a file with mistakes, `CommandLineError` for a task file that goes
    by the name of a built-in tree, `NotInLibraryError`, and `OSError` for what cannot be read.
    """
    texts: dict[DocumentKind, dict[str, str]] = {}
    file = _scene_file(scene, tree) if scene else None
    chosen = _read_scene(scene, file, texts) if scene else None
    name, task = _read_tree(tree, chosen, texts)
    if task is not None and task.definition.scene and not scene:
        file = _scene_file(task.definition.scene, tree)
        if file is not None:
            texts[DocumentKind.SCENE] = {task.definition.scene: read_text(file)}
    script = _read_scenario(scenario, task, chosen, texts) if scenario else None
    named = chosen.name if chosen else None
    return RunFiles(name, named, script, GivenFiles(texts), file)


def _read_tree(
    argument: str, scene: Scene | None, texts: dict[DocumentKind, dict[str, str]]
) -> tuple[str, CheckedTask | None]:
    """The tree's name, and the tree where it is to be had."""
    if not is_file(argument):
        built_in = argument in TREES.names()
        task = check_built_in_task(argument, behavior_parameters()) if built_in else None
        return argument, task
    path = Path(argument)
    text = read_text(path)
    task = read_task(path, scene)
    name = task.definition.name
    if name in TREES.names() and text != TREES.read(name):
        raise CommandLineError(
            f"'{path}' has the name of a built-in task tree, '{name}': give it another name"
        )
    texts[DocumentKind.TREE] = {name: text}
    return name, task


def _scene_file(argument: str, tree: str) -> Path | None:
    """The file of a scene: itself, or the one beside the task file; None where it is built in."""
    if is_file(argument):
        return Path(argument)
    beside = Path(tree).parent / "scenes" / f"{argument}.yaml"
    return beside if is_file(tree) and beside.is_file() else None


def _read_scene(
    argument: str, file: Path | None, texts: dict[DocumentKind, dict[str, str]]
) -> Scene:
    if file is None:
        return built_in_scene(argument)
    scene = check_scene_file(file)
    texts[DocumentKind.SCENE] = {scene.name: read_text(file)}
    return scene


def _read_scenario(
    argument: str,
    task: CheckedTask | None,
    scene: Scene | None,
    texts: dict[DocumentKind, dict[str, str]],
) -> Scenario:
    if not is_file(argument):
        return built_in_scenario(argument)
    read = read_scenario_file(Path(argument))
    scenario = read.scenario
    if task is not None:
        found = _misfits(scenario, task, scene or task.scene)
        if found:
            raise InvalidFileError(argument, [read.problem(each) for each in found])
    texts[DocumentKind.SCENARIO] = {scenario.name: read_text(Path(argument))}
    return scenario


def _misfits(scenario: Scenario, task: CheckedTask, scene: Scene | None) -> list[Misfit]:
    tree = task.definition
    if tree.name != scenario.tree:
        message = f"the scenario is for the task tree '{scenario.tree}', not '{tree.name}'"
        return [Misfit(("tree",), message)]
    return find_misfits(scenario, tree, scene, behavior_step_counts())
