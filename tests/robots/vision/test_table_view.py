"""The head camera: parts are found to about a millimetre, and what is hidden is admitted."""

import math

import numpy as np
import pytest
from drawn_scene import PARTS, TABLE_Z, DrawnScene, Resting, on_its_side
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from sampled import sample
from scripted_body import view_of

from mend.robots.catalogue import Part
from mend.robots.vision.head import HeadSighting


def see(name: str, scene: DrawnScene) -> HeadSighting | None:
    return view_of(scene.picture()).sightings.get(name)


def turned_by(a: float, b: float) -> float:
    return abs((a - b + math.pi / 2) % math.pi - math.pi / 2)


@pytest.mark.slow
@pytest.mark.parametrize("noise", [0.0, 5.0])
def test_parts_are_found_to_a_millimetre(noise: float) -> None:
    rng = np.random.default_rng(4)
    errors_m = []
    for index in range(sample(40, 60)):
        name = sorted(PARTS)[index % len(PARTS)]
        truth = Resting(rng.uniform(0.42, 0.7), rng.uniform(-0.5, 0.15), yaw=rng.uniform(-1.5, 1.5))
        seen = see(name, DrawnScene({name: truth}, noise=noise, seed=index))
        assert seen is not None
        errors_m.append(math.hypot(seen.x - truth.x, seen.y - truth.y))
        assert turned_by(seen.yaw, truth.yaw) < math.radians(3)
    assert np.median(errors_m) < 0.0006
    assert np.percentile(errors_m, 95) < 0.0015
    assert max(errors_m) < 0.003


@settings(deadline=None, max_examples=sample(12, 25))
@given(
    name=st.sampled_from(sorted(PARTS)),
    x=st.floats(0.42, 0.7),
    y=st.floats(-0.5, 0.15),
    yaw=st.floats(-1.5, 1.5),
    raised_m=st.sampled_from([0.0, 0.04, 0.08]),
)
def test_a_part_is_found_at_any_height(name, x, y, yaw, raised_m) -> None:
    seen = see(name, DrawnScene({name: Resting(x, y, TABLE_Z + raised_m, yaw)}))
    assert seen is not None
    assert seen.complete
    assert math.hypot(seen.x - x, seen.y - y) < 0.004
    assert abs(seen.z - TABLE_Z - raised_m) < 0.002
    assert abs(seen.top_z - seen.z - PARTS[name].size[2]) < 1e-9


def test_a_plate_on_legs_is_found() -> None:
    scene = DrawnScene(
        {
            "green_leg": Resting(0.46, -0.05),
            "blue_leg": Resting(0.61, -0.05),
            "purple_top": Resting(0.535, -0.05, TABLE_Z + 0.08),
        }
    )
    seen = see("purple_top", scene)
    assert seen is not None
    assert math.hypot(seen.x - 0.535, seen.y + 0.05) < 0.003
    assert abs(seen.z - TABLE_Z - 0.08) < 0.002


def test_a_part_that_is_not_there_is_not_seen() -> None:
    assert see("pink_bar", DrawnScene({"green_leg": Resting(0.5, -0.2)})) is None


def test_a_half_hidden_part_is_not_called_complete() -> None:
    leg = Resting(0.55, -0.2)
    hidden = DrawnScene({"green_leg": leg}, grey_boxes=[((0.45, -0.28, TABLE_Z), (0.03, 0.2, 0.3))])
    whole, half = see("green_leg", DrawnScene({"green_leg": leg})), see("green_leg", hidden)
    assert whole is not None
    assert whole.complete
    assert half is not None
    assert not half.complete


@pytest.mark.parametrize("yaw", [0.0, 0.15, -0.2])
def test_a_part_that_the_border_cuts_is_measured_from_its_other_end(yaw: float) -> None:
    leg = Resting(0.5, 0.33, yaw=yaw)
    seen = see("green_leg", DrawnScene({"green_leg": leg}))
    assert seen is not None
    assert math.hypot(seen.x - leg.x, seen.y - leg.y) < 0.004


@settings(deadline=None, max_examples=sample(20, 60))
@given(
    size=st.tuples(st.floats(0.012, 0.2), st.floats(0.012, 0.2), st.floats(0.012, 0.12)),
    about=st.sampled_from(["x", "y"]),
    x=st.floats(0.45, 0.65),
    y=st.floats(-0.4, 0.1),
    yaw=st.floats(-1.5, 1.5),
)
def test_what_lies_on_a_side_has_toppled_and_what_stands_has_not(size, about, x, y, yaw) -> None:
    # Of sides that are alike nobody can tell on which of them it stands.
    assume(abs(size[2] - size[1 if about == "x" else 0]) > 0.006)
    part = Part("green_leg", size)
    at = Resting(x, y, yaw=yaw)
    for where in (at, on_its_side(part, at, about)):
        scene = DrawnScene({"green_leg": where}, built={"green_leg": part})
        seen = view_of(scene.picture(), {"green_leg": part}).sightings.get("green_leg")
        assert seen is not None
        assert seen.toppled == (where is not at)
        assert abs(seen.z - TABLE_Z) < 0.004


def test_the_message_gives_the_yaw_of_the_long_axis() -> None:
    seen = see("green_leg", DrawnScene({"green_leg": Resting(0.5, -0.2, yaw=0.3)}))
    assert seen is not None
    assert turned_by(seen.yaw, 0.3) < 0.02
    assert turned_by(seen.to_message(PARTS["green_leg"]).yaw, 0.3 + math.pi / 2) < 0.02
