"""What other robots hide is worth a wait while ever less of it has been hidden all the time."""

from dataclasses import replace

import numpy as np
from drawn_scene import DrawnScene

from mend.robots.body import CameraImage
from mend.robots.vision.behind_others import BehindOthers
from mend.robots.vision.blindness import table_px, why_blind
from mend.tasks.scene import Table

PICTURE = DrawnScene().picture()
TABLE_PX = table_px(PICTURE, Table())


def hidden(columns: slice, time: float = 0.0) -> CameraImage:
    """A picture before which another robot hides some columns."""
    others = np.zeros(PICTURE.bgr.shape[:2], np.bool_)
    others[:, columns] = True
    assert PICTURE.depth_m is not None
    return replace(
        PICTURE, time=time, others=others, depth_m=np.where(others, np.nan, PICTURE.depth_m)
    )


def test_nobody_is_waited_for_who_is_not_there() -> None:
    assert not BehindOthers().will_show(PICTURE, TABLE_PX)
    assert not BehindOthers().will_show(hidden(slice(200, 400)), ~TABLE_PX & False)


def test_who_moves_is_waited_for_until_all_has_been_seen_once() -> None:
    behind = BehindOthers()
    told = [
        behind.will_show(hidden(slice(200 + 50 * step, 400 + 50 * step), 1.5 * step), TABLE_PX)
        for step in range(6)
    ]
    assert told == [True, True, True, True, False, False]


def test_who_stands_still_is_not_waited_for() -> None:
    behind = BehindOthers()
    told = [behind.will_show(hidden(slice(200, 400), time), TABLE_PX) for time in (0.0, 1.5, 2.5)]
    assert told == [True, True, False]


def test_a_table_half_hidden_by_other_robots_is_no_blindness() -> None:
    picture = hidden(slice(100, 560))
    assert why_blind(picture, Table()) is None
    assert why_blind(replace(picture, others=None), Table()) is not None
