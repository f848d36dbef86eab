"""Monitors, each with scripted views: when it speaks, when it is silent, what it says."""

from dataclasses import replace
from itertools import pairwise
from typing import Any

import pytest
from drawn_scene import DrawnScene
from languages_of_console import untold
from monitor_view import BLOB, SEEN, VIEW
from pydantic import ValidationError

from mend.robots.arm.behaviors.contact import Contact
from mend.robots.arm.grip import GripReading, GripState
from mend.robots.arm.grip.composition import Composition
from mend.robots.arm.monitors.blocked import Blocked
from mend.robots.arm.monitors.dropped import Dropped
from mend.robots.arm.monitors.missed import Missed
from mend.robots.arm.monitors.missing import Missing
from mend.robots.arm.monitors.positioning import Positioning
from mend.robots.arm.monitors.unreachable import Unreachable
from mend.robots.execution.monitor import AnyMonitor, Reaction
from mend.robots.execution.phase import Phase
from mend.robots.vision.obstruction import Obstruction
from mend.tasks.plugins import load_plugins


def grip(state: GripState) -> GripReading:
    image = DrawnScene().picture(with_depth=False)
    held = state in (GripState.HELD, GripState.UNDECIDED)
    return GripReading(
        name="pink_bar",
        state=state,
        probability=0.999 if held else 0.0002,
        opening_m=0.03 if held else 0.003,
        width_m=0.03,
        by_knob=False,
        presses=held,
        pushed=False,
        composition=None,
        blob=BLOB,
        expected=(80.0, 60.0),
        tolerance_px=3.0,
        overhang_px=1.0,
        image=image,
    )


@pytest.mark.parametrize(
    ("kind", "phases", "reaction"),
    [
        (Missing, "prepare", Reaction.STOP_IN_PLACE),
        (Unreachable, "prepare", Reaction.STOP_IN_PLACE),
        (Missed, "approach grasp lift", Reaction.GO_TO_NEUTRAL),
        (Dropped, "lift carry", Reaction.GO_TO_NEUTRAL),
        (Positioning, "carry", Reaction.SLOW_DOWN),
        (
            Blocked,
            "prepare approach grasp lift carry place release retreat",
            Reaction.STOP_IN_PLACE,
        ),
    ],
)
def test_each_is_registered_and_watches_its_phases(kind, phases, reaction) -> None:
    assert load_plugins("mend.monitors")[kind.issue] is kind
    monitor: AnyMonitor = kind.create({})
    watched = [phase for phase in Phase if monitor.watches("pick_and_place", phase)]
    assert watched == phases.split()
    assert monitor.reaction is reaction
    assert monitor.interrupts is (kind is not Positioning)


@pytest.mark.parametrize("kind", [Missed, Dropped])
@pytest.mark.parametrize("by_knob", [False, True])
@pytest.mark.parametrize(
    "sign",
    [
        {"opening_m": 0.003},
        {"opening_m": 0.06},
        {"opening_m": 0.03, "presses": True},
        {"opening_m": 0.03, "presses": True, "composition": Composition(400, 0.1, 0.6, "blue_leg")},
    ],
)
def test_why_it_is_not_held_is_in_the_languages_of_the_console(
    kind: type[Missed | Dropped], by_knob: bool, sign: dict[str, Any]
) -> None:
    monitor = kind.create({})
    reading = replace(grip(kind.state), by_knob=by_knob, **sign)
    detection = monitor.check(replace(VIEW, grip=reading))
    assert detection is not None
    assert untold([detection.explanation]) == []


@pytest.mark.parametrize("kind", [Missed, Dropped, Positioning, Blocked])
def test_what_pick_and_place_must_not_do_is_no_fault_of_another_behavior(kind) -> None:
    monitor: AnyMonitor = kind.create({})
    assert not any(monitor.watches("push", phase) for phase in Phase)


@pytest.mark.parametrize("kind", [Missing, Unreachable])
def test_what_no_behavior_can_do_without_is_watched_before_any(kind) -> None:
    monitor: AnyMonitor = kind.create({})
    assert [phase for phase in Phase if monitor.watches("push", phase)] == [Phase.PREPARE]


@pytest.mark.parametrize("kind", [Missing, Unreachable, Missed, Dropped, Positioning, Blocked])
def test_none_speaks_when_all_is_well(kind) -> None:
    monitor: AnyMonitor = kind.create({})
    for step in range(9):
        held = grip(GripState.HELD) if step in (4, 5) else None
        assert monitor.check(replace(VIEW, step=step, grip=held, contact_forces_n=(2.0,))) is None


def test_missing_speaks_of_what_is_nowhere_but_not_of_what_is_in_the_gripper() -> None:
    detection = Missing.create({}).check(replace(VIEW, sighting=None))
    assert detection is not None
    assert "pink_bar is nowhere" in detection.explanation
    assert Missing.create({}).check(
        replace(VIEW, sighting=None, grip=grip(GripState.HELD))
    ) is None  # fmt: skip
    assert Missing.create({}).check(replace(VIEW, sighting=None, part=None)) is None


NO_PATH = "the arm finds no path for it"


@pytest.mark.parametrize(
    ("x", "toppled", "refusal", "says"),
    [
        (0.95, False, NO_PATH, "0.97 m away; the arm grasps 0.30 to 0.80 m"),
        (0.1, False, NO_PATH, "0.22 m away"),
        (0.5, False, NO_PATH, "finds no path"),
        (0.5, True, None, "toppled over"),
    ],
)
def test_unreachable_says_why(x, toppled, refusal, says) -> None:
    sighting = replace(SEEN, x=x, toppled=toppled)
    detection = Unreachable.create({}).check(replace(VIEW, sighting=sighting, refusal=refusal))
    assert detection is not None
    assert says in detection.explanation
    assert detection.center == BLOB.center


def test_what_a_plan_was_found_for_is_not_out_of_reach() -> None:
    far = replace(VIEW, sighting=replace(SEEN, x=0.95))
    assert Unreachable.create({}).check(far) is None


def test_unreachable_keeps_its_margin() -> None:
    near_the_end = replace(VIEW, sighting=replace(SEEN, x=0.75))
    assert Unreachable.create({}).check(near_the_end) is None
    assert Unreachable.create({"margin_m": 0.1}).check(near_the_end) is not None


@pytest.mark.parametrize("state", list(GripState))
def test_missed_and_dropped_never_speak_of_the_same_grip(state: GripState) -> None:
    view = replace(VIEW, step=4, grip=grip(state))
    missed, dropped = Missed.create({}).check(view), Dropped.create({}).check(view)
    assert (missed is not None) is (state is GripState.ABSENT)
    assert (dropped is not None) is (state is GripState.LOST)
    for detection in (missed, dropped):
        if detection is not None:
            assert detection.camera == "forearm"
            assert detection.center == BLOB.center
            assert detection.expected == (80.0, 60.0)
            assert detection.probability is not None
            assert 0.9 < detection.probability < 1.0
            reading = grip(state)
            assert detection.measured == {
                "opening_m": reading.opening_m, "width_m": reading.width_m,
            }  # fmt: skip
            assert detection.explanation == (
                "the fingers closed to 3 mm where the pink bar is 30 mm wide (99 % sure)"
            )


def test_positioning_speaks_of_what_needs_help() -> None:
    assert Positioning.create({}).check(replace(VIEW, step=5, needs_help=True)) is not None


def test_blocked_says_what_was_felt_and_how_often() -> None:
    monitor = Blocked.create({})
    assert monitor.check(replace(VIEW, step=5, contact_forces_n=(300.0,) * 10)) is None
    detection = monitor.check(replace(VIEW, step=5, contact=Contact(17.2, 3)))
    assert detection is not None
    assert detection.explanation == "17 N push against the arm, felt in 3 tries, each gentler"
    assert detection.measured == {"force_n": 17.2, "tries": 3}


def test_blocked_tries_more_gently_each_time() -> None:
    tries = Blocked.create({}).tries
    assert len(tries) == 3
    for earlier, later in pairwise(tries):
        assert later.limit_n < earlier.limit_n
        assert later.speed < earlier.speed
    with pytest.raises(ValidationError, match="gentler"):
        Blocked.create({"limits_n": [10.0, 20.0], "speeds": [1.0, 0.5]})
    with pytest.raises(ValidationError, match="as many speeds"):
        Blocked.create({"limits_n": [10.0], "speeds": [1.0, 0.5]})


def test_blocked_heeds_the_path_check_before_the_first_step_only() -> None:
    in_the_way = Obstruction((0.5, -0.1, 0.9), (100.0, 80.0), 300)
    monitor = Blocked.create({})
    before = monitor.check(replace(VIEW, obstruction=in_the_way))
    assert before is not None
    assert before.center == (100.0, 80.0)
    assert monitor.check(replace(VIEW, step=5, obstruction=in_the_way)) is None


def test_wrong_parameters_are_refused() -> None:
    with pytest.raises(ValidationError, match="limits_n"):
        Blocked.create({"limits_n": [-1.0]})
    with pytest.raises(ValidationError, match="colour"):
        Missing.create({"colour": "pink"})
