"""What says of a surface where it reaches."""

import math

import numpy as np
from drawn_scene import PARTS, TABLE_Z, DrawnScene, Resting
from sampled import sample

from mend.robots.vision.evidence import Evidence, gather, may_tell_of
from mend.robots.vision.height_map import measure_heights
from mend.robots.vision.level_surfaces import Surfaces, find_surfaces
from mend.tasks.scene import Table

PICTURES = sample(12, 200)


def drawn_surfaces(seed: int) -> Surfaces:
    """Those of all parts anywhere, near each other, behind posts that cut some of them."""
    rng = np.random.default_rng(seed)
    parts = {
        name: Resting(rng.uniform(0.5, 0.8), rng.uniform(-0.4, 0.2), yaw=rng.uniform(0, math.pi))
        for name in PARTS
    }
    posts = [
        ((rng.uniform(0.42, 0.6), rng.uniform(-0.35, 0.2), TABLE_Z), (0.02, 0.02, 0.3))
        for _ in range(3)
    ]
    scene = DrawnScene(parts, posts, noise=rng.choice((0.0, 2.0)), seed=seed)
    heights = measure_heights(scene.picture(), Table())
    assert heights is not None
    return find_surfaces(heights)


def test_only_what_a_surface_may_tell_of_depends_on_what_that_is_taken_for() -> None:
    changed, away = 0, 0
    for seed in range(PICTURES):
        surfaces = drawn_surfaces(seed)
        for joined in [each for each in surfaces.all if each.pieces]:
            apart = surfaces.with_pieces_apart([joined])
            for other in [each for each in surfaces.all if each is not joined]:
                if not same(gather(other, surfaces), gather(other, apart)):
                    changed += 1
                    assert may_tell_of(joined, other), seed
                away += not may_tell_of(joined, other)
    assert changed > 0
    assert away > 0


def same(one: Evidence, other: Evidence) -> bool:
    return all(
        np.array_equal(getattr(one, name), getattr(other, name))
        for name in ("points", "inside", "telling", "measured", "rim")
    )
