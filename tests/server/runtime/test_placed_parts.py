"""Which parts are told to be missing when a task is done."""

import pytest
from recorded_service import recorded_events

from dialogue.registry import load_scripts
from robots.link.messages import Sighting
from server.journal import events as ev
from server.runtime.placed_parts import PlacedParts
from server.runtime.run_state import RunState


@pytest.fixture
def state() -> RunState:
    """The EKET base is built: the purple top rests on the legs."""
    started, *events = recorded_events()
    assert isinstance(started, ev.RunStarted)
    state = RunState(started, load_scripts())
    for event in events:
        state.fold(event)
    return state


def all_seen(state: RunState) -> dict[str, Sighting]:
    height_m = state.scene.table.height
    return {
        name: Sighting(
            x=place.pose.x,
            y=place.pose.y,
            z=height_m if place.pose.z is None else place.pose.z,
            yaw=0.0,
            time=0.0,
        )
        for name, place in state.scene.places.items()
    }


def told(state: RunState, seen: dict[str, Sighting]) -> list[str]:
    return [each.object for each in PlacedParts().missing(state, seen)]


def test_nothing_is_missing_where_all_is_seen_at_its_place(state: RunState) -> None:
    assert told(state, all_seen(state)) == []


def test_a_part_that_is_seen_elsewhere_is_missing(state: RunState) -> None:
    seen = all_seen(state)
    seen["green_leg"] = seen["green_leg"].model_copy(update={"y": -0.6})
    assert told(state, seen) == ["green_leg"]


def test_a_part_under_another_one_need_not_be_seen(state: RunState) -> None:
    seen = all_seen(state)
    del seen["green_leg"]
    assert told(state, seen) == []


def test_what_is_hidden_by_something_that_hangs_down_is_missing_too(state: RunState) -> None:
    seen = all_seen(state)
    del seen["green_leg"]
    seen["purple_top"] = seen["purple_top"].model_copy(update={"z": 0.7})
    assert told(state, seen) == ["green_leg", "purple_top"]


def test_a_part_that_was_missed_before_it_was_covered_is_missing(state: RunState) -> None:
    placed, seen = PlacedParts(), all_seen(state)
    uncovered = seen | {"purple_top": seen["purple_top"].model_copy(update={"y": -0.6})}
    del seen["green_leg"], uncovered["green_leg"]
    placed.note(state, uncovered)
    assert [each.object for each in placed.missing(state, seen)] == ["green_leg"]


def test_a_part_that_was_seen_at_its_place_is_believed_to_be_there(state: RunState) -> None:
    placed, seen = PlacedParts(), all_seen(state)
    placed.note(state, seen)
    del seen["green_leg"]
    placed.note(state, seen)
    assert placed.missing(state, seen) == []
