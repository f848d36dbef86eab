"""The nested form of a task file: `then`, `and`, `or` with a list of nodes, and leaves."""

from difflib import get_close_matches
from typing import Any

from mend.documents.document import LinedMapping, LinedSequence
from mend.documents.problem import Problem
from mend.documents.validation import show_kind
from mend.tasks.autonomy import AutonomyLevel
from mend.tasks.draft import MAX_NODES, Draft, DraftNode, find_name_mistake

GOAL_KEYS = ("then", "and", "or")
DECLARED_AUTONOMY = ("low", "high", "full")
"""What a leaf may say that it needs; nothing is what it needs without it."""
_KIND_KEYS = (*GOAL_KEYS, "behavior")

_Pending = tuple[Any, int, int | None, int]
"""A value to read: the value, its line, its parent's index and its position among the children."""


def draft_nested_tree(root: Any, line: int, problems: list[Problem]) -> Draft:
    """Read a nested tree; the draft holds every node that could be made out."""
    draft = Draft(problems=problems)
    pending: list[_Pending] = [(root, line, None, 0)]
    while pending:
        value, at_line, parent, position = pending.pop()
        if len(draft.nodes) >= MAX_NODES:
            message = f"the tree has more than {MAX_NODES} nodes"
            draft.problems.append(Problem(at_line, None, message))
            break
        node = _draft_node(draft, value, at_line, parent, position)
        if node is not None:
            draft.nodes.append(node)
            pending.extend(reversed(_read_children(draft, len(draft.nodes) - 1)))
    return draft


def _draft_node(
    draft: Draft, value: Any, line: int, parent: int | None, position: int
) -> DraftNode | None:
    """One node without its children, or None with a problem where its kind is not clear."""
    found = [key for key in _KIND_KEYS if key in value] if isinstance(value, LinedMapping) else []
    if isinstance(value, LinedMapping) and len(found) == 1:
        kind = found[0]
        return DraftNode(kind, parent, position, value)
    if not isinstance(value, LinedMapping):
        message = f"a node is a mapping with one of {_show_kind_keys()}, not {show_kind(value)}"
    elif found:
        several = " and ".join(f"'{key}'" for key in found)
        message = f"a node may have only one of {_show_kind_keys()}, but this one has {several}"
    else:
        message = f"a node needs one of {_show_kind_keys()}" + _meant(value)
    draft.problems.append(Problem(line, draft.path_of_child(parent, position), message))
    return None


def _read_children(draft: Draft, index: int) -> list[_Pending]:
    """Complete the node that was added last; returns its children, which are still to be read."""
    node = draft.nodes[index]
    if "name" in node.source:
        _read_name(draft, index)
    if node.kind == "behavior":
        _read_leaf(draft, index)
        return []
    for key in node.source:
        if key not in (node.kind, "name"):
            message = f"unknown key '{key}'; a goal node has '{node.kind}' and may have 'name'"
            draft.report(index, node.source.line_of(key), message)
    children = node.source[node.kind]
    if not isinstance(children, LinedSequence):
        message = f"'{node.kind}' must be a list of nodes, but it is {show_kind(children)}"
        draft.report(index, node.source.line_of(node.kind), message)
        return []
    if not children:
        message = f"'{node.kind}' is empty; a goal node needs a child"
        draft.report(index, node.source.line_of(node.kind), message)
    lined = zip(children, children.item_lines, strict=True)
    return [(child, line, index, position) for position, (child, line) in enumerate(lined)]


def _read_name(draft: Draft, index: int) -> None:
    node = draft.nodes[index]
    mistake = find_name_mistake(node.source["name"])
    if mistake is None:
        node.name = node.source["name"]
    else:
        draft.report(index, node.source.line_of("name"), mistake)


def _read_leaf(draft: Draft, index: int) -> None:
    node = draft.nodes[index]
    behavior = node.source["behavior"]
    if not isinstance(behavior, str):
        message = f"'behavior' must be the name of a behavior, but it is {show_kind(behavior)}"
        draft.report(index, node.source.line_of("behavior"), message)
        return
    node.behavior = behavior
    node.parameters = LinedMapping(node.source.line)
    if "autonomy" in node.source:
        _read_autonomy(draft, index)
    for key, value in node.source.items():
        if key not in ("behavior", "name", "autonomy"):
            node.parameters[key] = value
            node.parameters.key_lines[key] = node.source.line_of(key)


def _read_autonomy(draft: Draft, index: int) -> None:
    node = draft.nodes[index]
    declared = node.source["autonomy"]
    if declared in DECLARED_AUTONOMY:
        node.autonomy = AutonomyLevel(declared)
        return
    message = f"'autonomy' must be low, high or full, but it is {show_kind(declared)}"
    draft.report(index, node.source.line_of("autonomy"), message)


def _meant(value: LinedMapping) -> str:
    """What a key that is none was probably meant to be."""
    for key in value:
        if close := get_close_matches(str(key), _KIND_KEYS, 1, 0.7):
            return f"; is '{key}' meant to be '{close[0]}'?"
    return ""


def _show_kind_keys() -> str:
    return ", ".join(f"'{key}'" for key in _KIND_KEYS[:-1]) + f" or '{_KIND_KEYS[-1]}'"
