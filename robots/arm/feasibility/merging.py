"""Parts that would be one surface to the head camera: of one colour, as high, and side by side."""

from collections.abc import Iterator
from itertools import combinations

from shapely import Polygon

from mend.robots.arm.feasibility.moments import Job
from mend.robots.arm.feasibility.standing import Standing
from mend.tasks.leaf_order import LeafOrder
from mend.tasks.scene import Scene
from mend.tasks.scene_problem import SceneProblem

APART_M = 0.005
"""Tops of one colour need a gap so wide to be seen as two."""
_AS_HIGH_M = 0.006
"""Tops that differ by more are two surfaces, however noisy the depth is."""
_ALIKE = 0.15
"""Colours no channel of which differs by more (of 1) may look the same in poor light."""


def one_surface(
    scene: Scene, standing: list[Standing], jobs: list[Job], order: LeafOrder
) -> Iterator[SceneProblem]:
    """Each pair of parts that may stand so close at some time; `standing` is where all start."""
    job_of = {each.name: each for each in jobs}
    pairs = [*combinations(standing, 2)]
    for first, second in combinations(jobs, 2):
        if first.name == second.name or order.exclusive(first.leaf, second.leaf):
            continue
        if first.place and second.place and first.place.where != second.place.where:
            pairs.append((first.place, second.place))
    for start in standing:
        mine = job_of.get(start.name)
        for job in jobs:
            if job.place is None or job.name == start.name:
                continue
            if mine is None or not order.is_before(mine.leaf, job.leaf):
                pairs.append((start, job.place))
    for one, other in pairs:
        if _look_alike(scene, one, other) and _side_by_side(one, other):
            yield SceneProblem(
                other.where,
                f"the cameras cannot tell {other.name} from {one.name} beside it: they are of one "
                f"colour and equally high, so leave at least {APART_M * 1e3:.0f} mm between them",
            )


def _look_alike(scene: Scene, one: Standing, other: Standing) -> bool:
    colors = scene.objects[one.name].color, scene.objects[other.name].color
    return max(abs(a - b) for a, b in zip(*colors, strict=True)) < _ALIKE


def _side_by_side(one: Standing, other: Standing) -> bool:
    """Whether tops of both are as high as each other and too close; not if they are inside."""
    if one.meets(other):
        return False
    return any(
        abs(mine.top_z - its.top_z) < _AS_HIGH_M
        and Polygon(mine.corners()).distance(Polygon(its.corners())) < APART_M
        for mine in one.boxes
        for its in other.boxes
    )
