"""Checking task trees, scenes and scenarios with all that they name, and asking the worlds."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from mend.documents.problem import InvalidFileError, Problem
from mend.server.behaviors import behavior_parameters, behavior_step_counts
from mend.server.documents import (
    SPOKEN,
    CheckedDocument,
    DocumentKind,
    DocumentMistake,
    FixedDocuments,
    RobotReach,
    Uploaded,
    WorldFit,
    WrongDocumentError,
)
from mend.server.scene_checks import WorldChecks
from mend.tasks.definition import BehaviorNode, TaskTreeDefinition
from mend.tasks.library import NotInLibraryError
from mend.tasks.scenario import Scenario
from mend.tasks.scenario_file import (
    Misfit,
    ReadScenario,
    check_scenario_text,
    find_misfits,
    read_scenario_text,
)
from mend.tasks.scene import Scene
from mend.tasks.scene_file import ReadScene, check_scene_text, read_scene_text
from mend.tasks.scene_problem import SceneProblem
from mend.tasks.task_file import CheckedTask, check_task_text


@dataclass(frozen=True)
class Finder:
    """Finds what documents name: the fixed ones first, then the uploaded ones."""

    fixed: Mapping[DocumentKind, FixedDocuments]
    uploaded: Uploaded

    def text(self, kind: DocumentKind, name: str) -> str:
        """Raises `NotInLibraryError`."""
        fixed = self.fixed[kind]
        if name in fixed.names():
            return fixed.read(name)
        uploaded = self.uploaded.get(kind, {})
        if name in uploaded:
            return uploaded[name]
        known = sorted({*fixed.names(), *uploaded})
        raise NotInLibraryError(
            f"there is no {SPOKEN[kind]} '{name}'; there are {', '.join(known) or 'none'}"
        )

    def scene(self, name: str) -> Scene:
        """Raises `NotInLibraryError` and `InvalidFileError`."""
        scene = check_scene_text(self.text(DocumentKind.SCENE, name), source=f"scenes/{name}.yaml")
        return scene.model_copy(update={"name": name})

    def task(self, name: str, scene: Scene | None = None) -> CheckedTask:
        """Raises `NotInLibraryError` and `InvalidFileError`; `scene` instead of the tree's own."""
        text = self.text(DocumentKind.TREE, name)
        return check_task_text(
            text, behavior_parameters(), self.scene, source=name, default_name=name, scene=scene
        )

    def scenario(self, name: str) -> Scenario:
        """Raises `NotInLibraryError` and `InvalidFileError`."""
        scenario = check_scenario_text(self.text(DocumentKind.SCENARIO, name), source=name)
        return scenario.model_copy(update={"name": name})


class _Checker:
    """What the checkers of all kinds share."""

    kind: DocumentKind

    def __init__(self, fixed: Mapping[DocumentKind, FixedDocuments], worlds: WorldChecks) -> None:
        self._fixed = fixed
        self._worlds = worlds

    def _wrong(self, error: InvalidFileError, text: str) -> WrongDocumentError:
        return WrongDocumentError(f"{self._what()}", _mistakes(error.problems, text))

    def _what(self) -> str:
        return "task" if self.kind is DocumentKind.TREE else SPOKEN[self.kind]

    def _refuse_unfit(self, fits: Sequence[WorldFit]) -> Sequence[WorldFit]:
        """Raise `WrongDocumentError` where no world can do it."""
        if fits and all(each.problems for each in fits):
            raise WrongDocumentError(
                self._what(),
                [
                    mistake.model_copy(
                        update={"message": f"in the world '{each.world}': {mistake.message}"}
                    )
                    for each in fits
                    for mistake in each.problems
                ],
                fits,
            )
        return fits


class TreeChecker(_Checker):
    """Reads task files. Implements `server.documents.DocumentChecker`."""

    kind = DocumentKind.TREE

    def check(self, text: str, uploaded: Uploaded) -> CheckedDocument:
        return self._checked(self._task(text, uploaded), ())

    def try_in_worlds(self, text: str, uploaded: Uploaded) -> CheckedDocument:
        task = self._task(text, uploaded)
        if task.scene is None:
            return self._checked(task, ())
        fits = [
            WorldFit(
                world=world,
                problems=[_mistake_of_leaf(each, task, text.splitlines()) for each in problems],
            )
            for world, problems in self._worlds.try_tree(task.scene, task.definition).items()
        ]
        return self._checked(task, self._refuse_unfit(fits))

    def _task(self, text: str, uploaded: Uploaded) -> CheckedTask:
        finder = Finder(self._fixed, uploaded)
        try:
            return check_task_text(text, behavior_parameters(), finder.scene)
        except InvalidFileError as error:
            raise self._wrong(error, text) from error

    def _checked(self, task: CheckedTask, fits: Sequence[WorldFit]) -> CheckedDocument:
        scene = task.definition.scene
        return CheckedDocument(
            task.definition.name,
            task.definition.to_json(),
            frozenset({(DocumentKind.SCENE, scene)} if scene else ()),
            fits,
        )


class SceneFileChecker(_Checker):
    """Reads scene files. Implements `server.documents.DocumentChecker`."""

    kind = DocumentKind.SCENE

    def check(self, text: str, uploaded: Uploaded) -> CheckedDocument:  # noqa: ARG002
        return self._checked(self._read(text).scene, ())

    def try_in_worlds(self, text: str, uploaded: Uploaded) -> CheckedDocument:  # noqa: ARG002
        read = self._read(text)
        lines = text.splitlines()
        fits = [
            WorldFit(
                world=world,
                problems=[
                    _mistake(Problem(read.line_of(each.where), None, each.message), lines)
                    for each in problems
                ],
                reach=[
                    RobotReach(robot=robot, x=x, y=y, min_m=reach.min_m, max_m=reach.max_m)
                    for robot, (reach, x, y) in self._worlds.reaches(world, read.scene).items()
                ],
            )
            for world, problems in self._worlds.try_scene(read.scene).items()
        ]
        return self._checked(read.scene, self._refuse_unfit(fits))

    def _read(self, text: str) -> ReadScene:
        try:
            return read_scene_text(text)
        except InvalidFileError as error:
            raise self._wrong(error, text) from error

    def _checked(self, scene: Scene, fits: Sequence[WorldFit]) -> CheckedDocument:
        return CheckedDocument(scene.name, scene.model_dump(mode="json"), worlds=fits)


class ScenarioChecker(_Checker):
    """Reads scenario files. Implements `server.documents.DocumentChecker`."""

    kind = DocumentKind.SCENARIO

    def check(self, text: str, uploaded: Uploaded) -> CheckedDocument:
        scenario, task = self._read(text, uploaded)
        return self._checked(scenario, task)

    def try_in_worlds(self, text: str, uploaded: Uploaded) -> CheckedDocument:
        """As `check`: what a scenario does to a scene need not suit any robot."""
        return self.check(text, uploaded)

    def _read(self, text: str, uploaded: Uploaded) -> tuple[Scenario, CheckedTask]:
        finder = Finder(self._fixed, uploaded)
        try:
            read = read_scenario_text(text)
        except InvalidFileError as error:
            raise self._wrong(error, text) from error
        scenario = read.scenario
        try:
            task = finder.task(scenario.tree)
        except (NotInLibraryError, InvalidFileError) as error:
            misfit = Misfit(("tree",), str(error).splitlines()[0])
            raise self._unfit(read, [misfit], text) from error
        misfits = find_misfits(scenario, task.definition, task.scene, behavior_step_counts())
        if misfits:
            raise self._unfit(read, misfits, text)
        return scenario, task

    def _unfit(
        self, read: ReadScenario, misfits: Sequence[Misfit], text: str
    ) -> WrongDocumentError:
        problems = [read.problem(each) for each in misfits]
        return WrongDocumentError(self._what(), _mistakes(problems, text))

    def _checked(self, scenario: Scenario, task: CheckedTask) -> CheckedDocument:
        uses = {(DocumentKind.TREE, scenario.tree)}
        if task.definition.scene:
            uses.add((DocumentKind.SCENE, task.definition.scene))
        return CheckedDocument(scenario.name, scenario.model_dump(mode="json"), frozenset(uses))


def _mistakes(problems: Iterable[Problem], text: str) -> list[DocumentMistake]:
    lines = text.splitlines()
    return [_mistake(each, lines) for each in problems]


def _mistake(problem: Problem, lines: Sequence[str]) -> DocumentMistake:
    return DocumentMistake(
        line=problem.line,
        column=problem.column or _content_column(lines, problem.line),
        node=problem.node_path,
        message=problem.message,
    )


def _mistake_of_leaf(
    problem: SceneProblem, task: CheckedTask, lines: Sequence[str]
) -> DocumentMistake:
    """A problem of a scene, told to who reads the tree: at the leaf that it is about."""
    named, tree = set(problem.where), task.definition
    leaf = next(
        (
            index
            for index, node in enumerate(tree.nodes)
            if isinstance(node, BehaviorNode) and named & {node.object, node.place}
        ),
        None,
    )
    if leaf is None:
        return DocumentMistake(line=None, column=None, node=None, message=problem.message)
    return _mistake(Problem(task.lines[leaf], _path(tree, leaf), problem.message), lines)


def _path(tree: TaskTreeDefinition, node: int) -> str:
    """The path of child indices of a node."""
    steps: list[str] = []
    parent = tree.nodes[node].parent
    while parent is not None:
        siblings = [index for index, each in enumerate(tree.nodes) if each.parent == parent]
        steps.append(str(siblings.index(node)))
        node, parent = parent, tree.nodes[parent].parent
    return "/" + "/".join(reversed(steps))


def _content_column(lines: Sequence[str], number: int | None) -> int | None:
    """Where the content of a line begins, after its indentation and the dashes of a list."""
    if number is None or not 0 < number <= len(lines):
        return None
    line = lines[number - 1]
    return len(line) - len(line.lstrip(" -\t")) + 1
