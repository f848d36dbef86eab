"""What a leaf event costs: Mend's incremental tree against a tick of the same tree in py_trees.

An event of Mend is everything that happens when an agent chooses a leaf, starts it and finishes
it. A tick of py_trees is what finds out there that a leaf has finished; it chooses nothing. Two
shapes are compared: `open`, only AND, so that every leaf may be under way at the same time, and
`mixed`, with THEN and OR, where little is open at once. A tick is measured in both ways that
py_trees has: `reactive` derives from the state of the children what comes next, as Mend does,
and `memory` goes on from where a stored pointer stands. Figures are means.
"""

# ruff: noqa: T201
import argparse
import statistics
import time
from itertools import pairwise
from random import Random

import numpy as np
import py_trees
from py_trees.behaviour import Behaviour
from py_trees.common import ParallelPolicy, Status

from mend.tasks.definition import BehaviorNode, GoalNode, TaskTreeDefinition
from mend.tasks.task_tree import TaskTree

_CHILDREN = 5


class Wait(Behaviour):
    """A leaf of py_trees: it runs until it is told that it is finished."""

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.finished = False

    def update(self) -> Status:
        return Status.SUCCESS if self.finished else Status.RUNNING


def make_definition(leaves: int, shape: str, seed: int) -> TaskTreeDefinition:
    """A tree of goal nodes with about five children each: ANDs, or of every kind if `mixed`."""
    random = Random(seed)
    nodes: list[GoalNode | BehaviorNode] = []
    pending: list[tuple[int | None, int]] = [(None, leaves)]
    while pending:
        parent, size = pending.pop()
        index = len(nodes)
        if size == 1:
            nodes.append(BehaviorNode(parent=parent, name=f"n{index}", behavior="wait"))
            continue
        kind = "and"
        if shape == "mixed":
            # An OR only at the bottom: one higher up would leave most of the tree out.
            kind = random.choice(["then", "and", "or"] if size <= _CHILDREN else ["then", "and"])
        nodes.append(GoalNode.model_validate({"kind": kind, "parent": parent, "name": f"n{index}"}))
        parts = min(size, _CHILDREN)
        cuts = [size * part // parts for part in range(parts + 1)]
        pending.extend((index, end - start) for start, end in pairwise(cuts))
    return TaskTreeDefinition(name="benchmark", nodes=nodes)


def make_py_tree(definition: TaskTreeDefinition, memory: bool) -> tuple[Behaviour, list[Wait]]:
    """The same tree in py_trees: Sequence for THEN, Parallel for AND, Selector for OR."""
    made: list[Behaviour] = []
    leaves: list[Wait] = []
    for node in definition.nodes:
        if node.kind == "behavior":
            leaf = Wait(node.name)
            leaves.append(leaf)
            made.append(leaf)
        elif node.kind == "then":
            made.append(py_trees.composites.Sequence(node.name, memory=memory))
        elif node.kind == "or":
            made.append(py_trees.composites.Selector(node.name, memory=memory))
        else:
            policy = ParallelPolicy.SuccessOnAll(synchronise=memory)
            made.append(py_trees.composites.Parallel(node.name, policy))
        if node.parent is not None:
            made[node.parent].add_child(made[-1])
    return made[0], leaves


def time_mend(definition: TaskTreeDefinition, events: int) -> list[float]:
    """Seconds of each event, the tree being begun again whenever it is done."""
    potentials = np.random.default_rng(7).random(len(definition.nodes))
    able = np.ones(len(definition.nodes), dtype=np.bool_)
    tree = TaskTree(definition)
    tree.running = True
    tree.eligible_leaves()
    taken: list[float] = []
    while len(taken) < events:
        if tree.done(0):
            tree = TaskTree(definition)
            tree.running = True
            tree.eligible_leaves()
        began = time.perf_counter()
        leaves = tree.eligible_leaves()
        leaf = tree.choose(leaves, potentials[leaves], able[: leaves.size])
        assert leaf is not None
        tree.start(leaf, "robot")
        tree.finish(leaf)
        taken.append(time.perf_counter() - began)
    return taken


def time_py_trees(definition: TaskTreeDefinition, memory: bool, ticks: int) -> list[float]:
    """Seconds of each tick; before each, one of the leaves that run is finished."""
    root, leaves = make_py_tree(definition, memory)
    random = Random(7)
    root.tick_once()
    taken: list[float] = []
    while len(taken) < ticks:
        running = [leaf for leaf in leaves if leaf.status is Status.RUNNING]
        if not running:
            for leaf in leaves:
                leaf.finished = False
            root.stop(Status.INVALID)
            root.tick_once()
            continue
        random.choice(running).finished = True
        began = time.perf_counter()
        root.tick_once()
        taken.append(time.perf_counter() - began)
    return taken


def mean_us(seconds: list[float]) -> float:
    return statistics.fmean(seconds) * 1e6


def compare(shape: str, size: int, quick: bool) -> str:
    """One row of the table."""
    definition = make_definition(size, shape, seed=1)
    ticks = max(20, (4_000 if quick else 100_000) // size)
    mend = mean_us(time_mend(definition, 300 if quick else 3_000))
    reactive = mean_us(time_py_trees(definition, False, ticks))
    memory = mean_us(time_py_trees(definition, True, ticks))
    return (
        f"| {shape} | {size:,} | {mend:.1f} | {reactive:.1f} | {reactive / mend:.0f} x "
        f"| {memory:.1f} | {memory / mend:.0f} x |"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="small trees only, few events")
    quick = parser.parse_args().quick
    sizes = (10, 100, 1_000) if quick else (10, 100, 1_000, 10_000)
    print("| shape | leaves | Mend, us/event | py_trees reactive, us/tick | | memory, us/tick | |")
    print("|---|---:|---:|---:|---:|---:|---:|")
    for shape in ("open", "mixed"):
        for size in sizes:
            print(compare(shape, size, quick), flush=True)


if __name__ == "__main__":
    main()
