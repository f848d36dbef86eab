"""What says of a surface where it reaches."""

import numpy as np
import pytest
from drawn_scene import TABLE_Z, DrawnScene, Resting

from mend.robots.vision.evidence import Evidence, gather, may_tell_of
from mend.robots.vision.height_map import measure_heights
from mend.robots.vision.level_surfaces import Surface, Surfaces, find_surfaces
from mend.tasks.scene import Table

FAR_OFF = {"pink_bar": Resting(0.6, 0.3), "yellow_bar": Resting(0.9, -0.5)}
BESIDE = {"green_leg": Resting(0.68, -0.15)}


def with_a_leg_behind_a_post(parts: dict[str, Resting]) -> tuple[Surfaces, Surface]:
    """All surfaces of a picture, and the leg's, of which two pieces are seen."""
    leg = {"blue_leg": Resting(0.62, -0.15)}
    post = ((0.55, -0.14, TABLE_Z), (0.02, 0.02, 0.25))
    heights = measure_heights(DrawnScene({**leg, **parts}, [post]).picture(), Table())
    assert heights is not None
    surfaces = find_surfaces(heights)
    bluest = max(surfaces.all, key=lambda each: each.color[0] - each.color[1])
    assert len(bluest.pieces) == 2
    return surfaces, bluest


@pytest.mark.parametrize("parts", [FAR_OFF, BESIDE, {**FAR_OFF, **BESIDE}])
def test_what_a_surface_is_taken_for_changes_nothing_of_those_of_which_it_tells_nothing(
    parts: dict[str, Resting],
) -> None:
    surfaces, joined = with_a_leg_behind_a_post(parts)
    apart = surfaces.with_pieces_apart([joined])
    others = [each for each in surfaces.all if each is not joined]
    away = [each for each in others if not may_tell_of(joined, each)]
    assert all(same(gather(each, surfaces), gather(each, apart)) for each in away)
    assert len(away) >= sum(name in parts for name in FAR_OFF)


def test_a_surface_tells_of_what_is_beside_it() -> None:
    surfaces, joined = with_a_leg_behind_a_post({**FAR_OFF, **BESIDE})
    told = [each for each in surfaces.all if each is not joined and may_tell_of(joined, each)]
    apart = surfaces.with_pieces_apart([joined])
    changed = [
        each
        for each in surfaces.all
        if each is not joined and not same(gather(each, surfaces), gather(each, apart))
    ]
    assert set(changed) <= set(told)
    assert told


def same(one: Evidence, other: Evidence) -> bool:
    return all(
        np.array_equal(getattr(one, name), getattr(other, name))
        for name in ("points", "inside", "telling", "measured", "rim")
    )
