"""The drawing of a task tree: where each node goes, from the root at the left to the leaves."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

COLUMN_PX = 132
ROW_PX = 46
GOAL_WIDTH_PX = 68
LEAF_WIDTH_PX = 250
NODE_HEIGHT_PX = 32
MARGIN_PX = 10
MAX_TOUCHED = 400
"""Of a tree with more nodes than this, only what a run has touched is drawn in full."""

NodeKind = Literal["then", "and", "or", "behavior", "stub"]
NodeFate = Literal["untouched", "active", "done", "abandoned", "tried"]


@dataclass(frozen=True, slots=True)
class NodeState:
    """One node as the run left it; `detail` is one short line about how.

    A `stub` stands for siblings that nothing happened to.
    """

    path: str
    kind: NodeKind
    name: str
    object: str | None
    fate: NodeFate
    detail: str = ""


@dataclass(frozen=True, slots=True)
class DrawnNode:
    """A node and where it stands: left edge and vertical middle, in px."""

    state: NodeState
    x: float
    y: float
    width: float


@dataclass(frozen=True, slots=True)
class DrawnEdge:
    """From a goal node to a child; `order` is the child's number under a THEN."""

    kind: NodeKind
    x1: float
    y1: float
    x2: float
    y2: float
    order: int | None
    fate: NodeFate


@dataclass(frozen=True, slots=True)
class TreeDrawing:
    """Everything of the drawing, in px of its own coordinates."""

    width: float
    height: float
    nodes: list[DrawnNode]
    edges: list[DrawnEdge]


def draw_tree(states: Sequence[NodeState]) -> TreeDrawing:
    """Lay out the nodes, which come parents first and siblings in their order."""
    shown = _worth_drawing(states)
    children: dict[str, list[NodeState]] = {}
    for state in shown[1:]:
        children.setdefault(parent_path(state.path), []).append(state)
    nodes, rows = _place(shown[0], children)
    return TreeDrawing(
        width=max(each.x + each.width for each in nodes.values()) + MARGIN_PX,
        height=rows * ROW_PX + MARGIN_PX,
        nodes=list(nodes.values()),
        edges=[
            _edge(nodes[path], nodes[child.path], order)
            for path, below in children.items()
            for order, child in enumerate(below, 1)
        ],
    )


def parent_path(path: str) -> str:
    """The path of a node's parent; of every node but the root."""
    return path.rpartition("/")[0] or "/"


def _worth_drawing(states: Sequence[NodeState]) -> list[NodeState]:
    """A small tree whole; of a large one what was touched, with stubs for the rest."""
    if len(states) <= MAX_TOUCHED:
        return list(states)
    kept = {"/"}
    for state in [each for each in states if each.fate != "untouched"][:MAX_TOUCHED]:
        path = state.path
        while path not in kept:
            kept.add(path)
            path = parent_path(path)
    shown = [each for each in states if each.path in kept]
    hidden = Counter(parent_path(each.path) for each in states if each.path not in kept)
    for path, count in hidden.items():
        if path in kept:
            shown.append(NodeState(f"{path}/…", "stub", f"{count} more", None, "untouched"))
    return shown


def _place(
    root: NodeState, children: Mapping[str, list[NodeState]]
) -> tuple[dict[str, DrawnNode], int]:
    """Every leaf in a row of its own, every goal node at the middle of its children."""
    order: list[tuple[NodeState, int]] = []
    waiting = [(root, 0)]
    while waiting:
        state, depth = waiting.pop()
        order.append((state, depth))
        waiting.extend((each, depth + 1) for each in reversed(children.get(state.path, [])))
    rows = sum(state.path not in children for state, _ in order)
    row = rows
    nodes: dict[str, DrawnNode] = {}
    for state, depth in reversed(order):
        below = [nodes[each.path].y for each in children.get(state.path, [])]
        if below:
            y = (below[0] + below[-1]) / 2
        else:
            row -= 1
            y = MARGIN_PX + (row + 0.5) * ROW_PX
        width = LEAF_WIDTH_PX if state.kind in ("behavior", "stub") else GOAL_WIDTH_PX
        nodes[state.path] = DrawnNode(state, MARGIN_PX + depth * COLUMN_PX, y, width)
    return {state.path: nodes[state.path] for state, _ in order}, rows


def _edge(parent: DrawnNode, child: DrawnNode, order: int) -> DrawnEdge:
    return DrawnEdge(
        kind=parent.state.kind,
        x1=parent.x + parent.width,
        y1=parent.y,
        x2=child.x,
        y2=child.y,
        order=order if parent.state.kind == "then" and child.state.kind != "stub" else None,
        fate=child.state.fate,
    )
