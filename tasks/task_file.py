"""Task files: reading and checking them, in the nested or the published flat form."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mend.documents.document import DocumentError, LinedMapping, read_document, read_text
from mend.documents.problem import InvalidFileError, Problem
from mend.documents.validation import find_extra_keys, show_kind
from mend.tasks.definition import BehaviorNode, GoalNode, TaskTreeDefinition
from mend.tasks.draft import Draft, find_depth_mistake, find_name_mistake, name_nodes
from mend.tasks.flat_form import FLAT_KEYS, draft_flat_tree
from mend.tasks.leaf_check import Behaviors, check_leaf
from mend.tasks.library import TREES, NotInLibraryError
from mend.tasks.nested_form import draft_nested_tree
from mend.tasks.scene import Scene
from mend.tasks.scene_file import built_in_scene, check_scene_file
from mend.tasks.tree_problems import find_tree_problems

FindScene = Callable[[str], Scene]
"""Finds a scene by name; raises `NotInLibraryError` or `InvalidFileError`."""

_HEAD_KEYS = ("name", "description", "scene")


@dataclass(frozen=True, slots=True)
class CheckedTask:
    """A task file without mistakes. `scene` is None if it names none; `lines` has each node's."""

    definition: TaskTreeDefinition
    scene: Scene | None
    lines: Sequence[int]


def check_task_file(
    path: Path,
    behaviors: Behaviors,
    find_scene: FindScene | None = None,
    scene: Scene | None = None,
) -> CheckedTask:
    """Read and check a task file (YAML or JSON). Raises `InvalidFileError`.

    Its scene is looked for in `scenes/` beside the file, then in the library, unless `find_scene`
    is given, or `scene`, which is taken instead of it.
    """
    try:
        text = read_text(path)
    except DocumentError as error:
        raise InvalidFileError(str(path), [error.problem]) from error

    def find_beside(name: str) -> Scene:
        beside = path.parent / "scenes" / f"{name}.yaml"
        if beside.is_file():
            return check_scene_file(beside)
        try:
            return built_in_scene(name)
        except NotInLibraryError as error:
            raise NotInLibraryError(f"{error}, nor is there a file '{beside}'") from error

    return check_task_text(
        text,
        behaviors,
        find_scene or find_beside,
        source=str(path),
        default_name=path.stem,
        scene=scene,
    )


def check_built_in_task(name: str, behaviors: Behaviors) -> CheckedTask:
    """A task of the library. Raises `NotInLibraryError`."""
    return check_task_text(TREES.read(name), behaviors, source=f"library/{name}.yaml")


def check_task_text(
    text: str,
    behaviors: Behaviors,
    find_scene: FindScene = built_in_scene,
    *,
    source: str = "task",
    default_name: str = "task",
    scene: Scene | None = None,
) -> CheckedTask:
    """Check the text of a task file; `source` names it in errors. Raises `InvalidFileError`.

    `default_name` is the name of a flat file, which need not have one of its own. `scene` is taken
    instead of the one that the file names.
    """
    try:
        document, problems = read_document(text)
    except DocumentError as error:
        raise InvalidFileError(source, [error.problem]) from error
    if not isinstance(document, LinedMapping):
        message = f"a task file is a mapping, but this is {show_kind(document)}"
        raise InvalidFileError(source, [*problems, Problem(1, None, message)])
    is_flat = any(key in document for key in FLAT_KEYS)
    if is_flat and "name" not in document and find_name_mistake(default_name) is None:
        document["name"] = default_name
    head = _check_head(document, problems)
    scene = scene or _find_scene(document, find_scene, problems)
    draft = _draft_tree(document, is_flat, problems)
    nodes = _check_nodes(draft, behaviors, scene)
    if draft.problems:
        raise InvalidFileError(source, draft.problems)
    lines = [each.source.line for each in draft.nodes]
    return CheckedTask(TaskTreeDefinition(nodes=nodes, **head), scene, lines)


def _check_head(document: LinedMapping, problems: list[Problem]) -> dict[str, Any]:
    """Name, description and scene, with a problem for each that is wrong."""
    head = {key: document[key] for key in _HEAD_KEYS if key in document}
    if "name" not in document:
        problems.append(Problem(document.line, None, "'name' is missing"))
    elif mistake := find_name_mistake(document["name"]):
        problems.append(Problem(document.line_of("name"), None, mistake))
    for key in ("description", "scene"):
        if key in head and not isinstance(head[key], str):
            message = f"'{key}' must be text, but it is {show_kind(head[key])}"
            problems.append(Problem(document.line_of(key), None, message))
    return head


def _find_scene(
    document: LinedMapping, find_scene: FindScene, problems: list[Problem]
) -> Scene | None:
    """The scene that the file names; None, with a problem, if it cannot be had."""
    name = document.get("scene")
    if not isinstance(name, str):
        return None
    try:
        return find_scene(name)
    except NotInLibraryError as error:
        message = str(error)
    except InvalidFileError as error:
        line = document.line_of("scene")
        # Each in its own line of what is told, and as many as of one file.
        problems += [
            Problem(line, None, f"the scene '{name}' has a mistake: {each}")
            for each in str(error).splitlines()
        ]
        return None
    problems.append(Problem(document.line_of("scene"), None, message))
    return None


def _draft_tree(document: LinedMapping, is_flat: bool, problems: list[Problem]) -> Draft:
    if is_flat:
        problems.extend(find_extra_keys(document, (*_HEAD_KEYS, *FLAT_KEYS), "a flat task file"))
        return draft_flat_tree(document, problems)
    problems.extend(find_extra_keys(document, (*_HEAD_KEYS, "tree"), "a task file"))
    if "tree" not in document:
        problems.append(Problem(document.line, None, "'tree' is missing"))
        return Draft(problems=problems)
    return draft_nested_tree(document["tree"], document.line_of("tree"), problems)


def _check_nodes(
    draft: Draft, behaviors: Behaviors, scene: Scene | None
) -> list[GoalNode | BehaviorNode]:
    """The nodes of the definition; useless where the draft has problems afterwards."""
    if (too_deep := find_depth_mistake(draft)) is not None:
        # Nothing more is said: the paths of what lies so deep are too long for sentences.
        draft.problems[:] = [too_deep]
        return []
    parameters = {
        index: check_leaf(draft, index, behaviors, scene)
        for index, node in enumerate(draft.nodes)
        if node.kind == "behavior"
    }
    names = name_nodes(draft)
    if draft.problems:
        return []
    nodes = _make_nodes(draft, names, parameters)
    for problem in find_tree_problems(nodes, scene):
        source = draft.nodes[problem.leaf].parameters or draft.nodes[problem.leaf].source
        draft.report(problem.leaf, source.line_of(problem.parameter), problem.message)
    return nodes


def _make_nodes(
    draft: Draft, names: list[str], parameters: Mapping[int, dict[str, Any]]
) -> list[GoalNode | BehaviorNode]:
    """The nodes of a draft without problems."""
    nodes: list[GoalNode | BehaviorNode] = []
    for index, node in enumerate(draft.nodes):
        if node.kind == "behavior":
            nodes.append(
                BehaviorNode(
                    parent=node.parent,
                    name=names[index],
                    behavior=node.behavior or "",
                    parameters=parameters[index],
                    autonomy=node.autonomy,
                )
            )
        else:
            fields = {"kind": node.kind, "parent": node.parent, "name": names[index]}
            nodes.append(GoalNode.model_validate(fields))
    return nodes
