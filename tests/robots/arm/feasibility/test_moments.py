"""When a part is handled, by the order of random trees: no execution contradicts its moments."""

import json

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from random_task import random_nesting

from mend.robots.arm.feasibility.moments import Job, Moment, Moments
from mend.robots.arm.feasibility.standing import Standing, at_place, starts
from mend.server.behaviors import behavior_parameters
from mend.tasks.definition import BehaviorNode
from mend.tasks.leaf_order import LeafOrder
from mend.tasks.scene import Place, Pose, Scene, SceneObject
from mend.tasks.task_file import check_task_text
from mend.tasks.task_tree import TaskTree

seeds = st.integers(0, 2**31)
counts = st.integers(2, 6)


class Drawn:
    """A random tree that brings parts, far apart from each other, to places of their own."""

    def __init__(self, seed: int, count: int) -> None:
        self.rng = np.random.default_rng(seed)
        names = [f"part_{number}" for number in range(count)]
        leaves = [{"behavior": "pick_and_place", "object": each, "place": each} for each in names]
        scene = Scene(
            name="apart",
            objects={name: _box(Pose(x=0.4, y=-0.7 + 0.1 * n)) for n, name in enumerate(names)},
            places={
                name: Place(pose=Pose(x=0.6, y=-0.7 + 0.1 * n)) for n, name in enumerate(names)
            },
        )
        text = json.dumps({"name": "t", "tree": random_nesting(self.rng, leaves)})
        self.definition = check_task_text(text, behavior_parameters(), scene=scene).definition
        nodes = self.definition.nodes
        self.order = LeafOrder(nodes)
        begin = starts(scene)
        self.jobs = [
            Job(index, begin[node.object], at_place(scene, node.object, node.object))
            for index, node in enumerate(nodes)
            if isinstance(node, BehaviorNode) and node.object is not None
        ]
        self.moments = Moments(self.jobs, list(begin.values()), self.order, together=True)

    def job_of(self, leaf: int) -> Job:
        return next(each for each in self.jobs if each.leaf == leaf)

    def execution(self) -> list[tuple[Job, frozenset[int]]]:
        """Each job in turn, with the leaves that are done when it starts."""
        tree = TaskTree(self.definition)
        tree.running = True
        found, done = [], frozenset[int]()
        while len(eligible := tree.eligible_leaves()):
            leaf = int(self.rng.choice(eligible))
            found.append((self.job_of(leaf), done))
            tree.start(leaf, "r1")
            tree.finish(leaf)
            done |= {leaf}
        return found


def _box(pose: Pose) -> SceneObject:
    return SceneObject(color=(0.9, 0.1, 0.1), size=(0.03, 0.03, 0.03), pose=pose)


def allows(moment: Moment, done: frozenset[int]) -> bool:
    return moment.done <= done and not moment.waiting & done


@settings(deadline=None)
@given(seeds, counts)
def test_what_is_sure_of_a_moment_is_so_in_every_execution(seed: int, count: int) -> None:
    drawn = Drawn(seed, count)
    for job, done in drawn.execution():
        assert allows(drawn.moments.of(job), done)


@settings(deadline=None)
@given(seeds, counts)
def test_what_stands_there_in_an_execution_surely_or_possibly_does(seed: int, count: int) -> None:
    drawn = Drawn(seed, count)
    for job, done in drawn.execution():
        sure, maybe = drawn.moments.around(drawn.moments.of(job))
        others = [each for each in drawn.jobs if each is not job]
        stands = {_spot(each.place if each.leaf in done else each.start) for each in others}
        assert {_spot(each) for each in sure} <= stands
        assert stands <= {_spot(each) for each in (*sure, *maybe)}


@settings(deadline=None)
@given(seeds, counts)
def test_with_something_or_without_it_every_execution_is_in_one_of_both(
    seed: int, count: int
) -> None:
    drawn = Drawn(seed, count)
    for job, done in drawn.execution():
        moment = drawn.moments.of(job)
        _, maybe = drawn.moments.around(moment)
        for standing in maybe:
            assert sum(allows(each, done) for each in drawn.moments.split(moment, standing)) == 1


def _spot(standing: Standing | None) -> tuple[str, ...]:
    assert standing is not None
    return standing.where
