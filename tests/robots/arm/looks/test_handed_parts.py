"""Of parts of one colour the one that is asked for is taken from a person, and no other."""

from itertools import pairwise, product

import numpy as np
import pytest
import robot_bench
from drawn_scene import COLORS, PARTS, DrawnScene, Resting
from robot_bench import RobotBench
from sampled import sample

from mend.robots.catalogue import Part
from mend.robots.link.messages import Looked
from mend.robots.vision.color_model import ColorModel, Sample

GREEN, GREY = (30, 140, 20), (90, 90, 90)
OF_ONE_COLOR = {
    "plank": Part("plank", (0.23, 0.038, 0.113)),
    "chip": Part("chip", (0.039, 0.014, 0.025)),
    "short": Part("short", (0.09, 0.03, 0.05)),
    "long": Part("long", (0.21, 0.03, 0.05)),
    "high": Part("high", (0.09, 0.03, 0.11)),
}


def bench_with(monkeypatch: pytest.MonkeyPatch, color: tuple[int, int, int]) -> RobotBench:
    """A robot that knows only these parts, which all are of one colour."""
    for known in (PARTS, COLORS):
        for name in tuple(known):
            monkeypatch.delitem(known, name)  # type: ignore[attr-defined]
    for name, part in OF_ONE_COLOR.items():
        monkeypatch.setitem(PARTS, name, part)
        monkeypatch.setitem(COLORS, name, color)
    bgr, empty = (DrawnScene(parts).picture().bgr for parts in ({"short": Resting(0.55, -0.2)}, {}))
    sample = Sample(bgr, (bgr != empty).any(axis=2).astype(np.uint8))
    monkeypatch.setattr(
        robot_bench, "MODEL", ColorModel.train({name: [sample] for name in OF_ONE_COLOR})
    )
    bench = RobotBench()
    bench.body.parts.clear()
    return bench


def takes(bench: RobotBench, wanted: str) -> bool:
    bench.look(expect="in_gripper", object=wanted, within_s=8.0)
    bench.run()
    return bench.of(Looked)[-1].fulfilled is True


@pytest.mark.parametrize(
    ("offered", "wanted"),
    sample(
        # Each once where it is wanted, and once where another one is.
        [
            *zip(OF_ONE_COLOR, OF_ONE_COLOR, strict=True),
            *pairwise((*OF_ONE_COLOR, next(iter(OF_ONE_COLOR)))),
        ],
        list(product(OF_ONE_COLOR, OF_ONE_COLOR)),
    ),
)
def test_of_parts_of_one_colour_only_the_right_one_is_taken(
    monkeypatch: pytest.MonkeyPatch, wanted: str, offered: str
) -> None:
    bench = bench_with(monkeypatch, GREEN)
    bench.body.hold_out(offered)
    assert takes(bench, wanted) is (wanted == offered)
