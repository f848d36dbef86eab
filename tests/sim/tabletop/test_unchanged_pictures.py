"""While nothing changes a camera gives the very same picture, and a change gives another one."""

import numpy as np
import pytest

from mend.sim.tabletop.layout import lay_out
from mend.sim.tabletop.options import TabletopOptions
from mend.sim.tabletop.world import TabletopWorld
from mend.tasks.intervention import Act, Intervention

SCENE = lay_out([("part_1", "spot_1"), ("part_2", "spot_2")], seed=3)


def world(**options: float) -> TabletopWorld:
    return TabletopWorld(SCENE, 1, TabletopOptions(**options))


def test_nothing_is_drawn_again_while_nothing_changes() -> None:
    quiet = world()
    first = quiet.cameras[0].head.capture()
    quiet.body.advance_cycle()
    later = quiet.cameras[0].head.capture()
    assert later.time > first.time
    assert later.bgr is first.bgr
    assert later.depth_m is first.depth_m


def test_nobody_can_draw_into_a_picture_that_is_given_again() -> None:
    picture = world().cameras[0].head.capture()
    with pytest.raises(ValueError, match="read-only"):
        picture.bgr[0, 0] = 0


@pytest.mark.parametrize(
    "deed",
    [
        Intervention(act=Act.STEAL, object="part_1"),
        Intervention(act=Act.PLACE, object="part_1", place="spot_1"),
        Intervention(act=Act.BLOCK),
    ],
)
def test_what_somebody_changes_is_seen(deed: Intervention) -> None:
    quiet = world()
    before = quiet.cameras[0].head.capture()
    assert quiet.intervene(deed) == ""
    quiet.body.advance_cycle()
    after = quiet.cameras[0].head.capture()
    assert not np.array_equal(before.bgr, after.bgr)
    fresh, _ = world().cameras[0].head.capture_with_ids()
    assert np.array_equal(before.bgr, fresh.bgr)


def test_each_camera_has_its_own_picture() -> None:
    quiet = world()
    head, forearm = quiet.cameras[0].head.capture(), quiet.cameras[0].forearm.capture()
    assert quiet.cameras[0].head.capture().bgr is head.bgr
    assert quiet.cameras[0].forearm.capture().bgr is forearm.bgr


@pytest.mark.parametrize("option", ["light", "depth_noise", "camera_noise"])
def test_noise_is_new_in_every_picture(option: str) -> None:
    noisy = world(**{option: 1.0})
    first = noisy.cameras[0].head.capture()
    noisy.body.advance_cycle()
    later = noisy.cameras[0].head.capture()
    same = first.bgr is later.bgr and first.depth_m is later.depth_m
    assert not same
