"""The forearm camera: a held part is where it must be, and a lost one is noticed at once."""

import math

import numpy as np
import pytest
from drawn_scene import PARTS, DrawnScene
from hypothesis import given, settings
from hypothesis import strategies as st
from scripted_body import GRIPPER, forearm_pose, part_in_tool, tool_matrix, trained_model

from robots.body import ToolPose
from robots.grasp import grasp_of
from robots.vision.forearm import GripReading, GripState, GripWatch, steady

MODEL = trained_model()


class Hand:
    """A tool at a pose, with a part in it that may be somewhere else."""

    def __init__(self, name: str, period_s: float = 1 / 30, noise: float = 0.0) -> None:
        self.part = PARTS[name]
        self.watch = GripWatch(self.part, grasp_of(self.part, GRIPPER), MODEL, period_s=period_s)
        self.tool = tool_matrix(ToolPose(0.5, -0.2, 0.95, 0.3))
        self.noise, self.light, self.seed = noise, 1.0, 0

    def read(self, shift=(0.0, 0.0, 0.0), there: bool = True, opening_m: float | None = None):
        where = part_in_tool(self.part.name)
        where[:3, 3] += shift
        self.seed += 1
        scene = DrawnScene(
            {self.part.name: self.tool @ where} if there else {},
            noise=self.noise,
            light=self.light,
            seed=self.seed,
        )
        image = scene.picture(forearm_pose(self.tool), 160, 120, 80.0, with_depth=False)
        width = grasp_of(self.part, GRIPPER).width_m
        return self.watch.update(image, self.tool, width if opening_m is None else opening_m)


@pytest.mark.parametrize("name", sorted(PARTS))
def test_two_good_pictures_confirm_a_grasp(name: str) -> None:
    hand = Hand(name)
    assert hand.read().state is GripState.UNDECIDED
    assert hand.read().state is GripState.HELD


@pytest.mark.parametrize("name", sorted(PARTS))
def test_nothing_between_the_fingers_was_never_there(name: str) -> None:
    hand = Hand(name)
    assert hand.read(there=False).state is GripState.UNDECIDED
    reading = hand.read(there=False)
    assert reading.state is GripState.ABSENT
    assert reading.blob is None


def test_fingers_that_met_hold_nothing_whatever_is_seen() -> None:
    hand = Hand("pink_bar")
    hand.read(opening_m=0.0)
    assert hand.read(opening_m=0.0).state is GripState.ABSENT


def test_fingers_that_spread_have_let_go() -> None:
    hand = Hand("pink_bar")
    for opening_m in (0.03, 0.03, 0.04, 0.04):
        state = hand.read(opening_m=opening_m).state
    assert state is GripState.LOST


def test_a_part_that_vanishes_is_lost_after_two_pictures() -> None:
    hand = Hand("pink_bar")
    hand.read()
    hand.read()
    assert hand.read(there=False).state is GripState.HELD
    assert hand.read(there=False).state is GripState.LOST


def test_one_bad_picture_loses_nothing() -> None:
    hand = Hand("pink_bar")
    for there in (True, True, False, True, False, True):
        state = hand.read(there=there).state
    assert state is GripState.HELD


def test_slow_pictures_need_no_second_one() -> None:
    hand = Hand("pink_bar", period_s=0.1)
    assert hand.read().state is GripState.HELD
    assert hand.read(there=False).state is GripState.LOST


@pytest.mark.parametrize("name", sorted(PARTS))
@pytest.mark.parametrize("toward", [(1, 0, 0), (0.3, 0, 1), (0.3, 1, 0), (0.3, 0, -1)])
def test_a_part_pulled_or_fallen_out_is_lost(name: str, toward) -> None:
    hand = Hand(name)
    hand.read()
    hand.read()
    direction = np.array(toward) / np.linalg.norm(toward)
    for centimetres in range(1, 25):
        state = hand.read(shift=direction * centimetres / 100).state
        if state is GripState.LOST:
            break
    assert state is GripState.LOST
    assert centimetres >= 2


@settings(deadline=None, max_examples=30)
@given(
    name=st.sampled_from(sorted(PARTS)),
    poses=st.lists(
        st.tuples(st.floats(0.4, 0.7), st.floats(-0.5, 0.2), st.floats(0.8, 1.0), st.floats(-3, 3)),
        min_size=4,
        max_size=8,
    ),
    light=st.floats(0.7, 1.2),
    slip_mm=st.floats(-3, 3),
)
def test_a_held_part_is_never_lost_wherever_the_arm_goes(name, poses, light, slip_mm) -> None:
    hand = Hand(name, noise=4.0)
    for pose in poses:
        hand.tool, hand.light = tool_matrix(ToolPose(*pose)), light
        reading = hand.read(shift=(slip_mm / 1000, 0, 0))
    assert reading.state is GripState.HELD


def test_what_it_learned_of_a_grasp_is_expected_afterwards() -> None:
    hand = Hand("pink_bar")
    uneven = (0.0, 0.03, 0.0)
    first = hand.read(shift=uneven)
    hand.read(shift=uneven)
    later = hand.read(shift=uneven)
    assert first.overhang_px is not None
    assert later.overhang_px is not None
    assert later.overhang_px < 1.0 < 3.0 < first.overhang_px


def test_measuring_comes_to_no_verdict() -> None:
    hand = Hand("pink_bar")
    reading = hand.read()
    for _ in range(4):
        hand.watch.measure(reading.image, hand.tool, 0.03)
    assert hand.watch.state is GripState.UNDECIDED


def test_contradictory_pictures_are_decided_in_the_end() -> None:
    hand = Hand("pink_bar")
    states = [hand.read(there=index % 2 == 0).state for index in range(6)]
    assert states[:5] == [GripState.UNDECIDED] * 5
    assert states[5] is GripState.ABSENT


def test_steady_means_in_place_and_still() -> None:
    hand = Hand("pink_bar")
    still: list[GripReading] = [hand.read() for _ in range(3)]
    assert steady(still, 2.0)
    moving = [hand.read(shift=(0, 0, 0.008 * index)) for index in range(4)]
    assert not steady(moving, 2.0)
    assert not steady([*still, hand.read(there=False)], 2.0)


def test_tolerances_grow_with_the_picture() -> None:
    hand = Hand("pink_bar")
    small = hand.read()
    where = {"pink_bar": hand.tool @ part_in_tool("pink_bar")}
    image = DrawnScene(where).picture(forearm_pose(hand.tool), 320, 240, 160.0, with_depth=False)
    large = hand.watch.measure(image, hand.tool, 0.03)
    assert math.isclose(large.tolerance_px, 2 * small.tolerance_px)
    assert large.in_place
