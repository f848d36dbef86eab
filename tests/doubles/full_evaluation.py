"""A plain evaluation of a whole task tree, straight from the rules, to compare with.

It shares no code with the package: trees are nested, everything is computed by recursion each
time, levels are exact fractions.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import pairwise
from random import Random

from hypothesis import strategies as st

from mend.tasks.definition import BehaviorNode, GoalNode, TaskTreeDefinition


@dataclass(eq=False)
class Node:
    """A node; a leaf has no children and is `idle`, `active` or `done`."""

    kind: str
    children: list["Node"] = field(default_factory=list)
    status: str = "idle"
    given_up: bool = False
    attempts: int = 0
    potential: float = 0.0

    def walk(self) -> Iterator["Node"]:
        yield self
        for child in self.children:
            yield from child.walk()

    def leaves(self) -> list["Node"]:
        return [node for node in self.walk() if node.kind == "leaf"]

    def done(self) -> bool:
        if self.kind == "leaf":
            return self.status == "done"
        if self.kind == "or":
            return any(child.done() for child in self.children)
        return all(child.done() for child in self.children)

    def active(self) -> bool:
        return any(leaf.status == "active" for leaf in self.leaves())

    def begun(self) -> bool:
        return any(leaf.status != "idle" for leaf in self.leaves())

    def committed(self) -> "Node | None":
        begun = [child for child in self.children if child.begun()]
        assert len(begun) <= 1, "two alternatives of an OR were begun"
        return begun[0] if begun else None

    def heirs(self) -> list["Node"]:
        """The children that compete for this goal node's level."""
        if self.done():
            return []
        if self.kind == "then":
            return [next(child for child in self.children if not child.done())]
        if self.kind == "and":
            return [child for child in self.children if not child.done()]
        committed = self.committed()
        if committed is not None:
            return [committed]
        return [child for child in self.children if not child.given_up]

    def startable(self) -> bool:
        if self.given_up:
            return False
        if self.kind == "leaf":
            return self.status == "idle"
        return any(child.startable() for child in self.heirs())

    def evaluate_potential(self) -> float:
        if self.done():
            return 0.0
        if self.kind == "leaf":
            return self.potential
        heirs = self.heirs()
        if self.kind == "and":
            heirs = [child for child in heirs if child.startable()]
        return max((child.evaluate_potential() for child in heirs), default=0.0)

    def spread(self, level: Fraction, levels: dict["Node", Fraction]) -> dict["Node", Fraction]:
        """Pass a level down to everything under this node."""
        levels[self] = Fraction(0) if self.done() else level
        heirs = self.heirs() if levels[self] else []
        for child in self.children:
            share = Fraction(0)
            if child in heirs:
                share = levels[self] / len(heirs) if self.kind == "and" else levels[self]
            child.spread(share, levels)
        return levels


def define(root: Node) -> TaskTreeDefinition:
    """The definition of a nested tree; node i is called `n{i}`."""
    nodes: list[GoalNode | BehaviorNode] = []

    def add(node: Node, parent: int | None) -> None:
        index = len(nodes)
        name = f"n{index}"
        if node.kind == "leaf":
            nodes.append(BehaviorNode(parent=parent, name=name, behavior="wait"))
        else:
            nodes.append(
                GoalNode.model_validate({"kind": node.kind, "parent": parent, "name": name})
            )
        for child in node.children:
            add(child, index)

    add(root, None)
    return TaskTreeDefinition(name="random", nodes=nodes)


def trees(max_leaves: int = 12) -> st.SearchStrategy[Node]:
    """Random nested trees, evenly spread over sizes and nestings."""
    sizes = st.integers(2, max_leaves)
    return st.builds(random_tree, sizes, st.integers(0, 2**32 - 1).map(Random))


def random_tree(leaves: int, random: Random) -> Node:
    """A tree with so many leaves; now and then a goal node has a single child."""
    if leaves == 1 and random.random() < 0.8:
        return Node("leaf")
    parts = 1 if random.random() < 0.1 else random.randint(1, min(leaves, 4))
    cuts = sorted(random.sample(range(1, leaves), parts - 1))
    sizes = [end - start for start, end in pairwise([0, *cuts, leaves])]
    kind = random.choice(["then", "and", "or"])
    return Node(kind, [random_tree(size, random) for size in sizes])
