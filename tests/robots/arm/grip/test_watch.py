"""A held part is held whatever hides it; a lost, missed or wrong one is noticed at once."""

from dataclasses import replace

import numpy as np
import pytest
from drawn_scene import PARTS, DrawnScene
from hypothesis import given, settings
from hypothesis import strategies as st
from sampled import sample
from scripted_body import GRIPPER, forearm_pose, part_in_tool, tool_matrix, trained_model

from mend.robots.arm.body import ToolPose
from mend.robots.arm.grasp import grasp_of
from mend.robots.arm.grip.reading import GripReading, GripState
from mend.robots.arm.grip.watch import GripWatch, HandSnapshot
from mend.robots.vision.seen_box import SeenBox

MODEL = trained_model()
BIG_PLATE = np.array([[x, y, z] for x in (-0.2, -0.1) for y in (-0.2, 0.2) for z in (-0.2, 0.2)])
"""A piece of a gripper that hides everything below it from the camera."""


class ScriptedHand:
    """Fingers around a part, and what hides it or is there in its stead."""

    def __init__(self, name: str, period_s: float = 1 / 30, noise: float = 0.0) -> None:
        self.part = PARTS[name]
        self.grasp = grasp_of(self.part, GRIPPER)
        self.watch = GripWatch(self.part, self.grasp, MODEL, GRIPPER)
        self.tool = tool_matrix(ToolPose(0.5, -0.2, 0.95, 0.3))
        self.noise, self.light, self.period_s, self.read_so_far = noise, 1.0, period_s, 0

    def hand(
        self,
        shows: str | None = "itself",
        opening_m: float | None = None,
        presses: bool = True,
        shift: tuple[float, float, float] = (0.0, 0.0, 0.0),
        hidden: bool = False,
        pushed: bool = False,
        size: tuple[int, int, float] = (160, 120, 80.0),
    ) -> HandSnapshot:
        """The hand with what it `shows`: the part itself, another by name, or None."""
        self.read_so_far += 1
        name = self.part.name if shows == "itself" else shows
        parts = {}
        if name is not None:
            where = part_in_tool(name)
            where[:3, 3] += shift
            parts[name] = self.tool @ where
        scene = DrawnScene(parts, noise=self.noise, light=self.light, seed=self.read_so_far)
        width, height, focal_px = size
        image = scene.picture(
            forearm_pose(self.tool),
            width,
            height,
            focal_px,
            time=self.read_so_far * self.period_s,
            with_depth=False,
        )
        return HandSnapshot(
            image=image,
            tool=self.tool,
            contact_n=20.0 if pushed else 0.0,
            opening_m=self.grasp.width_m if opening_m is None else opening_m,
            effort_n=GRIPPER.grip_force_n if presses else 0.0,
            fingers=[BIG_PLATE] if hidden else [],
        )

    def read(self, **what: object) -> GripReading:
        return self.watch.update(self.hand(**what))  # type: ignore[arg-type]

    def hold(self) -> None:
        while self.watch.state is GripState.UNDECIDED:
            self.read()
        assert self.watch.state is GripState.HELD


@pytest.mark.parametrize("name", sorted(PARTS))
def test_a_part_that_is_seen_between_fingers_of_its_width_is_held(name: str) -> None:
    hand = ScriptedHand(name)
    states = [hand.read().state for _ in range(3)]
    assert states[-1] is GripState.HELD
    assert hand.watch.probability > 0.99


@pytest.mark.parametrize("name", sorted(PARTS))
def test_a_part_that_the_fingers_hide_is_held_all_the_same(name: str) -> None:
    hand = ScriptedHand(name)
    for _ in range(40):
        reading = hand.read(shows=None, hidden=True)
    assert reading.composition is None
    assert reading.state is GripState.HELD


@pytest.mark.parametrize("name", sorted(PARTS))
@pytest.mark.parametrize("hidden", [False, True])
def test_fingers_that_closed_on_nothing_have_missed(name: str, hidden: bool) -> None:
    hand = ScriptedHand(name)
    reading = hand.read(shows=None, opening_m=0.0005, presses=False, hidden=hidden)
    assert reading.state is GripState.ABSENT
    assert reading.probability < 0.01
    spoken = name.replace("_", " ")
    held = f"the {spoken}" if PARTS[name].knob is None else f"the knob of the {spoken}"
    assert reading.reason == (
        f"the fingers closed to 0 mm where {held} is {hand.grasp.width_m * 1e3:.0f} mm wide"
    )


def test_why_it_was_not_held_is_told_of_the_moment_of_the_reading() -> None:
    hand = ScriptedHand("pink_bar")
    for _ in range(4):
        reading = hand.read(shows=None, hidden=True, opening_m=hand.grasp.width_m + 0.02)
    assert reading.reason.startswith("the fingers were ")


def test_a_known_part_between_camera_and_hand_hides_what_is_held() -> None:
    hand = ScriptedHand("pink_bar")
    eye, at = forearm_pose(hand.tool)[:3, 3], hand.tool[:3, 3]
    x, y, z = eye + 0.5 * (at - eye)
    tower = SeenBox(x, y, 0.0, (0.06, 0.06, 0.12), z - 0.06, "yellow_bar", complete=True)
    behind = replace(tower, x=x + 2 * (at - eye)[0], y=y + 2 * (at - eye)[1])
    for _ in range(20):
        shown = replace(hand.hand(shows="yellow_bar"), around=[tower, behind])
        reading = hand.watch.update(shown)
    assert reading.composition is None
    assert reading.state is GripState.HELD
    assert hand.watch.measure(replace(shown, around=[behind])).composition is not None


def test_a_part_seen_behind_fingers_that_met_is_not_held() -> None:
    hand = ScriptedHand("pink_bar")
    for _ in range(3):
        reading = hand.read(opening_m=0.0, presses=False)
    assert reading.state is GripState.ABSENT


def test_another_part_of_the_same_width_is_told_by_its_colours() -> None:
    hand = ScriptedHand("pink_bar")
    for _ in range(4):
        reading = hand.read(shows="yellow_bar")
    assert reading.state is GripState.ABSENT
    assert "had the colours of the yellow bar, not the pink bar" in reading.reason


@pytest.mark.parametrize("off_m", [-0.008, 0.02])
def test_another_part_that_the_fingers_hide_is_told_by_its_width(off_m: float) -> None:
    hand = ScriptedHand("pink_bar")
    for _ in range(4):
        reading = hand.read(shows=None, hidden=True, opening_m=hand.grasp.width_m + off_m)
    assert reading.state is GripState.ABSENT
    assert f"{hand.grasp.width_m * 1e3:.0f} mm wide" in reading.reason


def test_what_was_pushed_askew_stays_so_when_nothing_pushes_any_more() -> None:
    hand = ScriptedHand("pink_bar")
    askew_m = hand.grasp.width_m + 0.012
    while hand.watch.state is GripState.UNDECIDED:
        hand.read(opening_m=askew_m, pushed=True)
    for _ in range(60):
        reading = hand.read(opening_m=askew_m)
    assert reading.state is GripState.HELD


@pytest.mark.parametrize("shows", ["itself", "green_leg"])
def test_what_was_pushed_is_askew_where_it_can_be_grasped_anew(shows: str) -> None:
    hand = ScriptedHand("pink_bar")
    hand.watch = GripWatch(hand.part, hand.grasp, MODEL, GRIPPER, regrasp=True)
    while hand.watch.state is GripState.UNDECIDED:
        hand.read(shows=shows, opening_m=hand.grasp.width_m + 0.012, pushed=True)
    assert hand.watch.state is GripState.ASKEW


def test_what_does_not_feel_like_the_part_is_grasped_anew_before_it_is_said_to_be_missed() -> None:
    verdicts = []
    for regrasp in (True, False):
        hand = ScriptedHand("pink_bar")
        hand.watch = GripWatch(hand.part, hand.grasp, MODEL, GRIPPER, regrasp=regrasp)
        while hand.watch.state is GripState.UNDECIDED:
            hand.read(shows="green_leg", opening_m=hand.grasp.width_m + 0.012)
        verdicts.append(hand.watch.state)
    assert verdicts == [GripState.ASKEW, GripState.ABSENT]


def test_nothing_between_the_fingers_is_not_grasped_anew() -> None:
    hand = ScriptedHand("pink_bar")
    hand.watch = GripWatch(hand.part, hand.grasp, MODEL, GRIPPER, regrasp=True)
    while hand.watch.state is GripState.UNDECIDED:
        hand.read(shows=None, opening_m=0.0, presses=False)
    assert hand.watch.state is GripState.ABSENT


def test_what_is_held_as_planned_is_not_askew_however_it_was_pushed() -> None:
    hand = ScriptedHand("pink_bar")
    hand.watch = GripWatch(hand.part, hand.grasp, MODEL, GRIPPER, regrasp=True)
    while hand.watch.state is GripState.UNDECIDED:
        hand.read(pushed=True)
    assert hand.watch.state is GripState.HELD


def test_of_what_shows_the_right_colours_the_width_is_told() -> None:
    hand = ScriptedHand("pink_bar")
    wider_m = hand.grasp.width_m * 1.08
    for _ in range(30):
        reading = hand.read(opening_m=wider_m)
    assert "did not look like" not in reading.reason
    assert hand.read(shows=None).reason.endswith("did not look like the pink bar")


@pytest.mark.parametrize("period_s", [1 / 30, 0.1])
@pytest.mark.parametrize("hidden", [False, True])
def test_what_vanishes_is_lost_with_the_first_reading_of_fingers_that_closed(
    period_s: float, hidden: bool
) -> None:
    hand = ScriptedHand("pink_bar", period_s)
    hand.hold()
    reading = hand.read(shows=None, opening_m=0.001, presses=False, hidden=hidden)
    assert reading.state is GripState.LOST


def test_fingers_on_their_way_together_have_lost_it_soon() -> None:
    hand = ScriptedHand("pink_bar")
    hand.hold()
    width_m = hand.grasp.width_m
    states = [
        hand.read(shows=None, opening_m=width_m * share, presses=False).state
        for share in (0.8, 0.5)
    ]
    assert states[-1] is GripState.LOST


def test_fingers_that_spread_have_let_go() -> None:
    hand = ScriptedHand("pink_bar")
    hand.hold()
    states = [
        hand.read(opening_m=hand.grasp.width_m + wider_m, presses=False).state
        for wider_m in (0.003, 0.008, 0.013, 0.018)
    ]
    assert states[-1] is GripState.LOST


def test_one_bad_picture_loses_nothing() -> None:
    hand = ScriptedHand("pink_bar")
    hand.hold()
    for shows in (None, "itself", None, "itself", None):
        state = hand.read(shows=shows).state
    assert state is GripState.HELD


@settings(deadline=None, max_examples=sample(10, 30))
@given(
    name=st.sampled_from(sorted(PARTS)),
    poses=st.lists(
        st.tuples(st.floats(0.4, 0.7), st.floats(-0.5, 0.2), st.floats(0.8, 1.0), st.floats(-3, 3)),
        min_size=4,
        max_size=8,
    ),
    light=st.floats(0.7, 1.2),
    slip_mm=st.floats(-3, 3),
    wider_mm=st.floats(-2, 3),
    hidden=st.booleans(),
)
def test_a_held_part_is_never_lost_wherever_the_arm_goes(
    name, poses, light, slip_mm, wider_mm, hidden
) -> None:
    hand = ScriptedHand(name, noise=4.0)
    for pose in poses:
        hand.tool, hand.light = tool_matrix(ToolPose(*pose)), light
        reading = hand.read(
            shift=(slip_mm / 1000, 0, 0),
            opening_m=hand.grasp.width_m + wider_mm / 1000,
            hidden=hidden,
        )
    assert reading.state is GripState.HELD


@pytest.mark.parametrize("name", sorted(PARTS))
@pytest.mark.parametrize("pushed_at_first", [False, True])
def test_what_somebody_unknown_hides_and_pushes_askew_is_not_lost(name, pushed_at_first) -> None:
    hand = ScriptedHand(name)
    hand.hold()
    hand.read(pushed=pushed_at_first)
    for _ in range(60):
        hand.read(shows=None)
    wider_m = min(0.006, GRIPPER.max_opening_m - hand.grasp.width_m)
    for share in np.linspace(0.0, 1.0, 40):
        reading = hand.read(shows=None, opening_m=hand.grasp.width_m + share * wider_m, pushed=True)
    assert reading.state is GripState.HELD
    gone = hand.read(shows=None, opening_m=0.001, presses=False, pushed=True)
    assert gone.state is GripState.LOST


def test_an_uneven_grasp_is_expected_afterwards() -> None:
    hand = ScriptedHand("pink_bar")
    uneven = (0.0, 0.03, 0.0)
    first = hand.read(shift=uneven)
    later = [hand.read(shift=uneven) for _ in range(2)][-1]
    assert first.overhang_px is not None
    assert later.overhang_px is not None
    assert later.overhang_px < 1.0 < 3.0 < first.overhang_px


def test_measuring_comes_to_no_verdict() -> None:
    hand = ScriptedHand("pink_bar")
    for _ in range(8):
        reading = hand.watch.measure(hand.hand())
    assert reading.probability > 0.9
    assert hand.watch.state is GripState.UNDECIDED
    assert hand.watch.probability == 0.5


def test_readings_that_contradict_one_another_are_decided_in_the_end() -> None:
    hand = ScriptedHand("pink_bar")
    states = []
    for index in range(30):
        opening_m = hand.grasp.width_m + (0.0 if index % 2 else 0.005)
        shows = "yellow_bar" if index % 4 == 3 else "itself"
        states.append(hand.read(shows=shows, opening_m=opening_m).state)
    assert states[-1] is not GripState.UNDECIDED
    assert not hand.watch.in_doubt


def test_a_doubt_that_no_reading_ends_does_not_last() -> None:
    hand = ScriptedHand("pink_bar")
    hand.hold()
    doubts = []
    for _ in range(40):
        opening_m = hand.grasp.width_m + 0.0043
        hand.read(shows=None, hidden=True, opening_m=opening_m)
        doubts.append(hand.watch.in_doubt)
    assert not doubts[-1]


def test_tolerances_grow_with_the_picture() -> None:
    hand = ScriptedHand("pink_bar")
    small = hand.watch.measure(hand.hand())
    large = hand.watch.measure(hand.hand(size=(320, 240, 160.0)))
    assert large.tolerance_px == 2 * small.tolerance_px
    assert large.composition is not None
    assert small.composition is not None
    assert large.composition.own == pytest.approx(small.composition.own, abs=0.1)
