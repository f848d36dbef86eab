"""A draft: a task tree as a file has it, before its leaves are checked and its nodes named."""

import re
from dataclasses import dataclass, field
from typing import Any

from mend.documents.document import LinedMapping
from mend.documents.problem import Problem
from mend.documents.validation import show_kind
from mend.tasks.autonomy import AutonomyLevel

MAX_NODES = 200_000
MAX_NODE_DEPTH = 250
"""So many nodes may stand inside one another: each node's path names all of those above it."""
MAX_NAME_CHARACTERS = 64
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_\-]{0,63}")


@dataclass(slots=True)
class DraftNode:
    """One node of a file. `kind` is `then`, `and`, `or` or `behavior`.

    `source` is the mapping that it was read from; `behavior` is None where the file has none that
    can be used, and its parameters are then not checked.
    """

    kind: str
    parent: int | None
    position: int
    source: LinedMapping
    name: str | None = None
    behavior: str | None = None
    parameters: LinedMapping | None = None
    autonomy: AutonomyLevel = AutonomyLevel.OFF


@dataclass(slots=True)
class Draft:
    """The nodes of a file, depth first, and the problems found so far."""

    nodes: list[DraftNode] = field(default_factory=list)
    problems: list[Problem] = field(default_factory=list)

    def path_of(self, node: int) -> str:
        """The path of child indices of a node that is in the draft."""
        return self.path_of_child(self.nodes[node].parent, self.nodes[node].position)

    def path_of_child(self, parent: int | None, position: int) -> str:
        """The path of a node that is not in the draft yet."""
        steps: list[str] = []
        while parent is not None:
            steps.append(str(position))
            node = self.nodes[parent]
            parent, position = node.parent, node.position
        return "/" + "/".join(reversed(steps))

    def report(self, node: int, line: int, message: str) -> None:
        """Note a problem of a node."""
        self.problems.append(Problem(line, self.path_of(node), message))


def find_depth_mistake(draft: Draft) -> Problem | None:
    """The first node that stands inside too many others, if one does."""
    depths: list[int] = []
    for node in draft.nodes:
        depth = 1 if node.parent is None else depths[node.parent] + 1
        if depth > MAX_NODE_DEPTH:
            message = f"nodes stand inside one another in more than {MAX_NODE_DEPTH} levels"
            return Problem(node.source.line, None, message)
        depths.append(depth)
    return None


def find_name_mistake(name: Any) -> str | None:
    """A sentence if something is no name, else None."""
    if isinstance(name, str) and _NAME.fullmatch(name):
        return None
    return (
        "'name' must be a letter, then at most 63 letters, digits, '_' or '-', "
        f"but it is {show_kind(name)}"
    )


def name_nodes(draft: Draft) -> list[str]:
    """A unique name for every node: its own, else its object's, behavior's or kind's.

    Notes a problem for each name that a file gives twice.
    """
    owners: dict[str, int] = {}
    for index, node in enumerate(draft.nodes):
        if node.name is None:
            continue
        if node.name in owners:
            first = draft.nodes[owners[node.name]].source
            message = (
                f"the name '{node.name}' is given twice, first in line {first.line_of('name')}"
            )
            draft.report(index, node.source.line_of("name"), message)
        owners.setdefault(node.name, index)
    taken = set(owners)
    counts: dict[str, int] = {}
    return [node.name or _make_name(node, taken, counts) for node in draft.nodes]


def _make_name(node: DraftNode, taken: set[str], counts: dict[str, int]) -> str:
    """A name that is not taken yet, with a number where several nodes would have the same."""
    handled = None if node.parameters is None else node.parameters.get("object")
    wanted = handled if isinstance(handled, str) and handled else node.behavior or node.kind
    # An object of a behavior without a scene may be called anything; a name may not.
    wanted = re.sub(r"[^A-Za-z0-9_\-]", "_", wanted)
    wanted = wanted if _NAME.match(wanted) else f"x{wanted}"
    base = wanted[: MAX_NAME_CHARACTERS - len(f"_{MAX_NODES}")]
    name = base
    while name in taken:
        counts[base] = counts.get(base, 1) + 1
        name = f"{base}_{counts[base]}"
    taken.add(name)
    return name
