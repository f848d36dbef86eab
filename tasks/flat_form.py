"""The published flat form of a task file: `NodeList`, and `Nodes` with masks (UNR, 2018).

A file for several robots repeats the tree for each of them, node by node as peers. A task tree of
Mend is shared by all agents, so the first robot's tree is read and the others are only checked.
"""

from collections.abc import Iterator
from dataclasses import dataclass

from mend.documents.document import LinedMapping, LinedSequence
from mend.documents.problem import Problem
from mend.documents.validation import find_extra_keys, show_kind
from mend.tasks.draft import MAX_NODES, Draft, DraftNode, find_name_mistake

FLAT_KEYS = ("NodeList", "Nodes")
LEAF_BEHAVIOR = "pick_and_place"

_NONE = "NONE"
_GOALS = {0: "then", 1: "or", 2: "and"}
_ROOT = 4
_LEAVES = (3, 5, 6, 7)
_NODE_KEYS = ("mask", "parent", "children", "peers")
IGNORED_KEYS = ("loc_obj", "off_x", "off_y", "off_z")
"""Where the published systems put an object; here the scene's places say so."""
_PARAMETER_KEYS = ("object", "place", "needs_help")
_LEAF_KEYS = (*_PARAMETER_KEYS, *IGNORED_KEYS)


@dataclass(frozen=True, slots=True)
class _FlatNode:
    """One entry of `Nodes`, as far as it could be read. `type` is None if its mask is wrong."""

    name: str
    source: LinedMapping
    type: int | None
    robot: int
    parent: str | None
    children: tuple[str, ...]

    @property
    def is_root(self) -> bool:
        return self.parent is None


def draft_flat_tree(document: LinedMapping, problems: list[Problem]) -> Draft:
    """Read the flat form; the draft holds every node that its root leads to."""
    draft = Draft(problems=problems)
    nodes = _read_nodes(document, problems)
    if not nodes:
        return draft
    _check_agreement(nodes, problems)
    _check_cycles(nodes, problems)
    roots = [node for node in nodes.values() if node.is_root]
    if not roots:
        problems.append(Problem(document.line_of("Nodes"), None, "no node has parent NONE"))
        return draft
    _check_roots(roots, problems)
    _add_nodes(draft, nodes, min(roots, key=lambda each: each.robot))
    return draft


def _read_nodes(document: LinedMapping, problems: list[Problem]) -> dict[str, _FlatNode]:
    """All entries of `Nodes` that are mappings, by name."""
    entries = document.get("Nodes")
    if not isinstance(entries, LinedMapping) or not entries:
        message = (
            f"'Nodes' must be a mapping with at least one node, but it is {show_kind(entries)}"
        )
        problems.append(Problem(document.line_of("Nodes"), None, message))
        return {}
    if len(entries) > MAX_NODES:
        message = f"the tree has more than {MAX_NODES} nodes"
        problems.append(Problem(document.line_of("Nodes"), None, message))
        return {}
    _check_node_list(document, entries, problems)
    nodes: dict[str, _FlatNode] = {}
    for name, entry in entries.items():
        if isinstance(entry, LinedMapping):
            nodes[name] = _read_node(name, entry, entries, problems)
        else:
            message = f"node '{name}' must be a mapping, but it is {show_kind(entry)}"
            problems.append(Problem(entries.line_of(name), None, message))
    return nodes


def _check_node_list(
    document: LinedMapping, entries: LinedMapping, problems: list[Problem]
) -> None:
    """`NodeList` and `Nodes` must name the same nodes, each once."""
    line = document.line_of("NodeList")
    listed = document.get("NodeList")
    if not isinstance(listed, LinedSequence):
        message = f"'NodeList' must be a list of node names, but it is {show_kind(listed)}"
        problems.append(Problem(line, None, message))
        return
    seen: set[str] = set()
    for name, at_line in zip(listed, listed.item_lines, strict=True):
        if not isinstance(name, str):
            message = f"'NodeList' must hold names, but it has {show_kind(name)}"
            problems.append(Problem(at_line, None, message))
        elif name in seen:
            problems.append(Problem(at_line, None, f"'NodeList' names '{name}' twice"))
        elif name not in entries:
            message = f"'NodeList' names '{name}', which 'Nodes' does not have"
            problems.append(Problem(at_line, None, message))
        if isinstance(name, str):
            seen.add(name)
    for name in entries:
        if name not in seen:
            message = f"node '{name}' is not in 'NodeList'"
            problems.append(Problem(entries.line_of(name), None, message))


def _read_node(
    name: str, entry: LinedMapping, entries: LinedMapping, problems: list[Problem]
) -> _FlatNode:
    mistake = find_name_mistake(name)
    if mistake is not None:
        problems.append(Problem(entries.line_of(name), None, f"node '{name}': {mistake}"))
    kind, robot = _read_mask(name, entry, problems)
    known = _NODE_KEYS if kind in _GOALS or kind == _ROOT else (*_NODE_KEYS, *_LEAF_KEYS)
    problems.extend(find_extra_keys(entry, known, f"node '{name}'"))
    children = tuple(_read_references(name, entry, "children", entries, problems))
    _check_child_count(name, entry, kind, len(children), problems)
    # Peers are the same node on other robots: only checked, because all agents share one tree.
    list(_read_references(name, entry, "peers", entries, problems))
    parent = entry.get("parent")
    if not isinstance(parent, str):
        message = f"'parent' of node '{name}' must be a node or NONE, but it is {show_kind(parent)}"
        problems.append(Problem(entry.line_of("parent"), None, message))
        parent = ""
    elif parent != _NONE and parent not in entries:
        message = f"node '{name}' has parent '{parent}', which 'Nodes' does not have"
        problems.append(Problem(entry.line_of("parent"), None, message))
    return _FlatNode(name, entry, kind, robot, None if parent == _NONE else parent, children)


def _read_mask(name: str, entry: LinedMapping, problems: list[Problem]) -> tuple[int | None, int]:
    """The type and robot of a node's mask; the type is None if it is wrong."""
    mask = entry.get("mask")
    if not isinstance(mask, LinedMapping):
        message = f"'mask' of node '{name}' must be a mapping, but it is {show_kind(mask)}"
        problems.append(Problem(entry.line_of("mask"), None, message))
        return None, 0
    known = ("type", "robot", "node", "skill")
    problems.extend(find_extra_keys(mask, known, f"the mask of node '{name}'"))
    for key in ("type", "robot", "node"):
        if type(mask.get(key)) is not int or mask[key] < 0:
            message = f"'{key}' in the mask of node '{name}' must be a number from 0"
            came = show_kind(mask.get(key))
            problems.append(Problem(mask.line_of(key), None, f"{message}, but it is {came}"))
    kind, robot = mask.get("type"), mask.get("robot")
    if type(kind) is int and kind not in (*_GOALS, _ROOT, *_LEAVES):
        message = f"node '{name}' has type {kind}; types are 0 (THEN) to 7 (PICK)"
        problems.append(Problem(mask.line_of("type"), None, message))
        kind = None
    return kind if type(kind) is int else None, robot if type(robot) is int else 0


def _read_references(
    name: str, entry: LinedMapping, key: str, entries: LinedMapping, problems: list[Problem]
) -> Iterator[str]:
    """The nodes that `children` or `peers` names and that exist, each once."""
    listed = entry.get(key)
    if listed is None:
        return
    if not isinstance(listed, LinedSequence):
        message = f"'{key}' of node '{name}' must be a list, but it is {show_kind(listed)}"
        problems.append(Problem(entry.line_of(key), None, message))
        return
    seen: set[str] = set()
    for each, line in zip(listed, listed.item_lines, strict=True):
        if each == _NONE:
            continue
        if not isinstance(each, str) or each not in entries:
            message = f"'{key}' of node '{name}' names {show_kind(each)}, which is not in 'Nodes'"
            problems.append(Problem(line, None, message))
        elif each in seen:
            problems.append(Problem(line, None, f"'{key}' of node '{name}' names '{each}' twice"))
        else:
            seen.add(each)
            yield each


def _check_child_count(
    name: str, entry: LinedMapping, kind: int | None, count: int, problems: list[Problem]
) -> None:
    line = entry.line_of("children")
    listed = entry.get("children")
    named = isinstance(listed, LinedSequence) and any(each != _NONE for each in listed)
    if kind in _LEAVES and count:
        problems.append(Problem(line, None, f"node '{name}' is a leaf, but it has children"))
    elif kind in _GOALS and not named:
        problems.append(Problem(line, None, f"goal node '{name}' is empty; it needs a child"))
    elif kind == _ROOT and (count > 1 or not named):
        message = f"root '{name}' must have exactly one child, but it has {count}"
        problems.append(Problem(line, None, message))


def _check_agreement(nodes: dict[str, _FlatNode], problems: list[Problem]) -> None:
    """Each child must name the parent that names it, and the other way round."""
    named = {child for node in nodes.values() for child in node.children}
    for node in nodes.values():
        for child in node.children:
            # A parent that does not exist is a mistake of its own, told already.
            parent = nodes[child].parent if child in nodes else node.name
            if parent != node.name and (parent is None or parent in nodes):
                message = f"node '{node.name}' has child '{child}', whose parent is "
                came = Problem(
                    node.source.line_of("children"), None, f"{message}'{parent or _NONE}'"
                )
                problems.append(came)
        if node.parent in nodes and node.name not in named:
            message = (
                f"node '{node.name}' has parent '{node.parent}', which does not name it a child"
            )
            problems.append(Problem(node.source.line_of("parent"), None, message))


def _check_cycles(nodes: dict[str, _FlatNode], problems: list[Problem]) -> None:
    """No node may be its own ancestor; one problem for each cycle."""
    settled: set[str] = set()
    for start in nodes:
        way: dict[str, None] = {}
        name: str | None = start
        while name is not None and name in nodes and name not in settled and name not in way:
            way[name] = None
            name = nodes[name].parent
        if name is not None and name in way:
            steps = list(way)
            cycle = steps[steps.index(name) :]
            shown = " -> ".join([*cycle[:10], "..."] if len(cycle) > 10 else [*cycle, name])
            line = nodes[name].source.line_of("parent")
            problems.append(Problem(line, None, f"nodes are their own ancestors: {shown}"))
        settled.update(way)


def _check_roots(roots: list[_FlatNode], problems: list[Problem]) -> None:
    """One root for each robot."""
    seen: dict[int, str] = {}
    for root in roots:
        if root.robot in seen:
            message = (
                f"'{root.name}' and '{seen[root.robot]}' are both roots for robot {root.robot}; "
                "a robot has one"
            )
            problems.append(Problem(root.source.line_of("parent"), None, message))
        seen.setdefault(root.robot, root.name)


def _add_nodes(draft: Draft, nodes: dict[str, _FlatNode], root: _FlatNode) -> None:
    """Add the nodes under a root, depth first; the published ROOT itself is left out."""
    tops = root.children[:1] if root.type == _ROOT else (root.name,)
    pending: list[tuple[str, int | None, int]] = [(name, None, 0) for name in tops]
    visited: set[str] = set()
    while pending:
        name, parent, position = pending.pop()
        if name in visited or name not in nodes:
            continue
        visited.add(name)
        flat = nodes[name]
        if flat.type == _ROOT:
            message = f"root '{name}' stands under another node"
            draft.problems.append(Problem(flat.source.line_of("parent"), None, message))
        index = len(draft.nodes)
        draft.nodes.append(_draft_node(draft, flat, parent, position))
        children = [(child, index, place) for place, child in enumerate(flat.children)]
        pending.extend(reversed(children))


def _draft_node(draft: Draft, flat: _FlatNode, parent: int | None, position: int) -> DraftNode:
    if flat.type not in _LEAVES:
        # Where the mask is wrong the kind does not matter any more: the draft has a problem.
        kind = "and" if flat.type is None else _GOALS.get(flat.type, "and")
        return DraftNode(kind, parent, position, flat.source, name=flat.name)
    leaf = DraftNode("behavior", parent, position, flat.source, name=flat.name)
    handled = flat.source.get("object")
    if not isinstance(handled, str):
        message = f"'object' of node '{flat.name}' must be text, but it is {show_kind(handled)}"
        draft.problems.append(Problem(flat.source.line_of("object"), None, message))
        return leaf
    leaf.behavior = LEAF_BEHAVIOR
    leaf.parameters = LinedMapping(flat.source.line)
    # The published form has one place for each object, without a name of its own.
    leaf.parameters.update(object=handled, place=handled)
    for key in _PARAMETER_KEYS:
        if key in flat.source:
            leaf.parameters[key] = flat.source[key]
            leaf.parameters.key_lines[key] = flat.source.line_of(key)
    return leaf
