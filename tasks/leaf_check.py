"""Checking the leaves of a task file: their behaviors, parameters, objects and places."""

from collections.abc import Mapping
from typing import Any

from pydantic import BaseModel

from mend.documents.document import LinedMapping
from mend.documents.problem import Problem, list_names
from mend.documents.validation import find_extra_keys, validate_part
from mend.tasks.draft import Draft, DraftNode
from mend.tasks.scene import Scene

Behaviors = Mapping[str, type[BaseModel]]
"""The models of the parameters of every known behavior, by its name."""


def check_leaf(
    draft: Draft, index: int, behaviors: Behaviors, scene: Scene | None
) -> dict[str, Any]:
    """The checked parameters of a leaf; problems are noted in the draft."""
    node = draft.nodes[index]
    if node.behavior is None or node.parameters is None:
        return {}
    if node.behavior not in behaviors:
        message = f"unknown behavior '{node.behavior}'; there are {list_names(behaviors)}"
        draft.report(index, node.source.line_of("behavior"), message)
        return {}
    model = behaviors[node.behavior]
    _adopt_need_for_help(node, model, scene)
    problems = find_extra_keys(node.parameters, model.model_fields, f"'{node.behavior}'")
    problems += _check_scene(node, scene)
    checked, mistakes = validate_part(model, _known_part(node.parameters, model))
    problems += mistakes
    for problem in problems:
        draft.report(index, problem.line or node.source.line, problem.message)
    return {} if checked is None else checked.model_dump(mode="json")


def _known_part(parameters: LinedMapping, model: type[BaseModel]) -> LinedMapping:
    """The parameters that a behavior has, for the others are told of already."""
    known = LinedMapping(parameters.line)
    known.key_lines = parameters.key_lines
    known.update((key, value) for key, value in parameters.items() if key in model.model_fields)
    return known


def _adopt_need_for_help(node: DraftNode, model: type[BaseModel], scene: Scene | None) -> None:
    """A leaf that does not say whether it needs help needs it where the scene's object does."""
    if scene is None or node.parameters is None or "needs_help" not in model.model_fields:
        return
    handled = node.parameters.get("object")
    if isinstance(handled, str) and handled in scene.objects:
        node.parameters.setdefault("needs_help", scene.objects[handled].needs_help)


def _check_scene(node: DraftNode, scene: Scene | None) -> list[Problem]:
    """The scene must have the object and the place that a leaf names."""
    if scene is None or node.parameters is None:
        return []
    problems: list[Problem] = []
    for key, known in (("object", scene.objects), ("place", scene.places)):
        named = node.parameters.get(key)
        if isinstance(named, str) and named not in known:
            message = f"the scene '{scene.name}' has no {key} '{named}'; it has {list_names(known)}"
            problems.append(Problem(node.parameters.line_of(key), None, message))
    return problems
