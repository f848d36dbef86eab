"""`undone`: when it speaks, and when the robot can place the object again by itself."""

from dataclasses import replace
from typing import Any

import pytest
from drawn_scene import TABLE_Z
from monitor_view import BLOB, SEEN, VIEW

from mend.robots.arm.monitors.missing import Missing
from mend.robots.arm.monitors.undone import Undone
from mend.robots.execution.monitor import AnyMonitor, Reaction
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import Location
from mend.robots.vision.presence import Presence
from mend.tasks.plugins import load_plugins

BEFORE = replace(VIEW, was_done="gone")
AFTER = replace(
    BEFORE, step=8, phase=Phase.CONFIRM, was_done=None, placed=SEEN, presence=Presence.GONE
)


def test_it_watches_before_the_first_step_and_after_the_last_of_any_behavior() -> None:
    assert load_plugins("mend.monitors")["undone"] is Undone
    monitor: AnyMonitor = Undone.create({})
    assert [phase for phase in Phase if monitor.watches("push", phase)] == [
        Phase.PREPARE,
        Phase.CONFIRM,
    ]
    assert monitor.reaction is Reaction.STOP_IN_PLACE


@pytest.mark.parametrize("was_done", ["gone", "there"])
def test_what_was_done_and_is_nowhere_is_undone_and_not_missing(was_done: Any) -> None:
    view = replace(BEFORE, sighting=None, was_done=was_done)
    monitor = Undone.create({})
    detection = monitor.check(view)
    assert detection is not None
    assert "pink_bar is no longer at its place and nowhere" in detection.explanation
    assert monitor.interrupts
    assert Missing.create({}).check(view) is None


def test_what_was_done_and_stands_elsewhere_in_reach_is_told_while_it_goes_on() -> None:
    monitor = Undone.create({})
    detection = monitor.check(BEFORE)
    assert detection is not None
    assert detection.explanation == "pink_bar is no longer at its place: it is at (0.50, -0.20)"
    assert detection.center == BLOB.center
    assert not monitor.interrupts


@pytest.mark.parametrize(
    ("target", "differs"),
    [
        (Location(x=0.50, y=-0.143), "it is 57 mm away from it, at (0.50, -0.20)"),
        (Location(x=0.50, y=-0.20, z=TABLE_Z + 0.057), "it stands 57 mm too low there"),
        (Location(x=0.49, y=-0.20, z=TABLE_Z - 0.02), "it stands 20 mm too high there"),
        (Location(x=0.49, y=-0.20, yaw=1.92), "it is turned by 70 degrees there"),
    ],
)
def test_it_says_in_what_the_object_differs_from_what_was_placed(
    target: Location, differs: str
) -> None:
    before = Undone.create({}).check(replace(BEFORE, target=target))
    assert before is not None
    assert before.explanation == f"pink_bar is no longer at its place: {differs}"
    after = Undone.create({}).check(replace(AFTER, target=target))
    assert after is not None
    assert after.explanation == f"pink_bar was placed, but is not at its place: {differs}"


def test_what_has_toppled_over_at_its_place_is_not_said_to_be_elsewhere() -> None:
    lying = replace(SEEN, toppled=True)
    target = Location(x=lying.x, y=lying.y)
    detection = Undone.create({}).check(replace(AFTER, placed=lying, target=target))
    assert detection is not None
    assert detection.explanation.endswith(": it has toppled over, at (0.50, -0.20)")


def test_what_is_at_its_place_and_only_placed_better_is_not_said_to_be_gone() -> None:
    view = replace(BEFORE, target=Location(x=SEEN.x + 0.01, y=SEEN.y))
    assert Undone.create({}).check(view) is None


def test_what_hangs_on_others_is_asked_about_though_it_is_seen() -> None:
    monitor = Undone.create({})
    assert monitor.check(replace(BEFORE, sighting=replace(SEEN, z=TABLE_Z + 0.05))) is not None
    assert monitor.interrupts


def test_once_somebody_was_asked_and_it_is_there_nothing_more_is_said() -> None:
    monitor = Undone.create({})
    assert monitor.check(replace(BEFORE, sighting=None)) is not None
    assert monitor.check(BEFORE) is None


@pytest.mark.parametrize(
    "changed",
    [
        {"was_done": None},
        {"part": None},
        {"sighting": replace(SEEN, toppled=True)},
        {"refusal": "the arm finds no path for it"},
    ],
)
def test_it_is_silent_where_nothing_was_done_or_another_monitor_says_what_is_wrong(
    changed: dict[str, Any],
) -> None:
    assert Undone.create({}).check(replace(BEFORE, **changed)) is None


@pytest.mark.parametrize("presence", [Presence.THERE, Presence.HIDDEN, None])
def test_after_the_last_step_only_what_is_seen_gone_is_undone(presence: Any) -> None:
    assert Undone.create({}).check(replace(AFTER, presence=presence)) is None


@pytest.mark.parametrize("again", [0, 1, 3])
def test_what_was_placed_in_vain_is_placed_again_so_often_and_then_asked_about(again: int) -> None:
    monitor = Undone.create({"again": again})
    for left in range(again, -1, -1):
        detection = monitor.check(AFTER)
        assert detection is not None
        assert "was placed, but is not at its place" in detection.explanation
        assert monitor.interrupts is (left == 0)


@pytest.mark.parametrize("placed", [None, replace(SEEN, x=0.95), replace(SEEN, z=TABLE_Z + 0.05)])
def test_what_it_cannot_take_again_is_asked_about_at_once(placed: Any) -> None:
    monitor = Undone.create({})
    assert monitor.check(replace(AFTER, placed=placed)) is not None
    assert monitor.interrupts
