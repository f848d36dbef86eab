"""Maps out of made-up drives, with poses that are known and with poses that are not."""

from dataclasses import replace

import numpy as np
import pytest
from made_up_floor import FLOOR
from synthetic.settings import SceneSettings
from synthetic.world import scene

from mend.localization.distance_field import distance_field
from mend.localization.logs.log import Log
from mend.localization.mapping import map_of
from mend.localization.pose import compose, relative
from mend.localization.scan_matching import matched_poses
from mend.maps.vector_map import VectorMap


def _off_the_walls(vector_map: VectorMap) -> np.ndarray:
    """How far points along a map's segments are from the floor's walls."""
    shares = np.linspace(0.0, 1.0, 9)[:, None, None]
    start, end = vector_map.segments[:, :2], vector_map.segments[:, 2:]
    points = (start * (1 - shares) + end * shares).reshape(-1, 2)
    return distance_field(FLOOR, 0.05, 1.0).at(points)


@pytest.mark.slow
def test_a_drive_gives_its_walls_back() -> None:
    made_up = scene(FLOOR, SceneSettings(length_m=12.0), seed=3)
    built = map_of(made_up.log, made_up.log.references)
    assert built.lengths.sum() > 30.0
    assert np.percentile(_off_the_walls(built), 90) < 0.05


@pytest.mark.slow
def test_poses_that_nobody_corrected_are_matched() -> None:
    made_up = scene(FLOOR, SceneSettings(length_m=12.0), seed=3)
    raw = Log("raw", tuple(replace(each, reference=None) for each in made_up.log.steps))
    poses = matched_poses(raw)
    off = np.hypot(*(compose(made_up.truth[0], poses) - made_up.truth)[:, :2].T)
    odometry = made_up.truth[0]
    for step in raw.steps[1:]:
        odometry = compose(odometry, step.odometry)
    drift = relative(made_up.truth[-1], odometry)
    assert off.max() < 0.15
    assert off.max() < np.hypot(drift[0], drift[1])
