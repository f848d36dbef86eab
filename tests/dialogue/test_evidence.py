"""What is seen puts an issue right only if it has come to be so since the question was put."""

from collections.abc import Sequence
from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st

from mend.dialogue.evidence import (
    MOVED_M,
    Change,
    LookOutcome,
    PutRight,
    brought_before,
    change_between,
    change_since,
    contradiction,
    known_before,
    known_when_raised,
    put_right,
)
from mend.dialogue.script import Expectation

LOST = (Expectation.AT_PLACE, Expectation.IN_REACH)
HERE, THERE = (0.5, 0.1, 0.7), (0.5, 0.3, 0.7)


def look(*fulfilled: Expectation, at: tuple[float, float, float] | None = HERE) -> LookOutcome:
    return LookOutcome(frozenset(fulfilled), at)


def test_a_part_that_never_left_puts_nothing_right() -> None:
    seen = look(Expectation.IN_REACH)
    assert put_right(LOST, seen, seen) is None
    assert change_between(seen, seen) is Change.NONE


def test_a_part_that_moved_since_the_question_has_though_not_since_the_last_look() -> None:
    asked, later = look(Expectation.IN_REACH), look(at=THERE)
    assert change_since([asked, later], look(Expectation.IN_REACH, at=THERE)) is Change.MOVED
    assert change_since([asked, later], look(Expectation.IN_REACH)) is Change.MOVED
    assert change_since([asked], look(Expectation.IN_REACH)) is Change.NONE
    assert change_since([], look(Expectation.IN_REACH)) is Change.UNKNOWN


def test_what_is_seen_after_the_dark_was_perhaps_there_all_the_time() -> None:
    dark, now = LookOutcome(frozenset(), None, blind=True), look(Expectation.AT_PLACE)
    assert change_between(dark, now) is Change.UNKNOWN
    assert put_right(LOST, dark, now) == PutRight(Expectation.AT_PLACE, Change.UNKNOWN)
    assert change_between(dark, look(Expectation.VIEW_CLEAR)) is Change.CLEARED


def test_a_part_that_is_set_upright_where_it_lay_has_moved() -> None:
    # What lies is seen as far below the table as it is lower than when it stands.
    lying, upright = look(at=(0.5, 0.1, 0.684)), look(Expectation.IN_REACH, at=(0.505, 0.1, 0.701))
    assert change_between(lying, upright) is Change.MOVED
    assert put_right(LOST, lying, upright) == PutRight(Expectation.IN_REACH, Change.MOVED)
    assert change_between(upright, lying) is Change.MOVED


def test_a_part_that_came_back_does() -> None:
    first, now = look(at=None), look(Expectation.IN_REACH)
    assert put_right(LOST, first, now) == PutRight(Expectation.IN_REACH, Change.APPEARED)


def test_a_part_that_was_moved_does_though_it_was_within_reach_before() -> None:
    first, now = look(Expectation.IN_REACH), look(Expectation.IN_REACH, at=THERE)
    assert put_right(LOST, first, now) == PutRight(Expectation.IN_REACH, Change.MOVED)


def test_at_its_place_tells_more_than_within_reach() -> None:
    first = look(Expectation.IN_REACH)
    now = look(Expectation.IN_REACH, Expectation.AT_PLACE, at=THERE)
    assert put_right(LOST, first, now) == PutRight(Expectation.AT_PLACE, Change.MOVED)


def test_a_way_that_was_seen_to_become_clear_does_but_maybe_by_itself() -> None:
    watched = (Expectation.WAY_CLEAR,)
    found = put_right(watched, look(), look(Expectation.WAY_CLEAR))
    assert found == PutRight(Expectation.WAY_CLEAR, Change.NONE)
    assert change_between(look(), look(Expectation.WAY_CLEAR)) is Change.CLEARED


def test_a_first_look_that_contradicts_the_issue_thanks_nobody() -> None:
    first = look(Expectation.IN_REACH)
    assert contradiction(LOST, frozenset(LOST), first) == PutRight(
        Expectation.IN_REACH, Change.NONE
    )
    assert contradiction(LOST, frozenset(), first) is None
    assert not Change.NONE.by_a_person


def test_what_a_robot_feels_it_has_not_been_wrong_about() -> None:
    loaded = LookOutcome(frozenset({Expectation.LOADED}), None)
    found = contradiction([Expectation.LOADED], frozenset({Expectation.LOADED}), loaded)
    assert found == PutRight(Expectation.LOADED, Change.LOADED)


def test_what_an_issue_denies_was_not_so_when_it_was_raised() -> None:
    denied = frozenset({Expectation.WAY_CLEAR})
    then = known_when_raised(Expectation.WAY_CLEAR, denied, None)
    assert change_between(then, look(Expectation.WAY_CLEAR)) is Change.CLEARED
    assert known_when_raised(Expectation.IN_REACH, denied, None) is None
    lay = known_when_raised(Expectation.IN_REACH, denied, THERE)
    assert change_between(lay, look(Expectation.IN_REACH)) is Change.MOVED
    dark = known_when_raised(Expectation.VIEW_CLEAR, frozenset({Expectation.VIEW_CLEAR}), HERE)
    assert change_between(dark, look(Expectation.VIEW_CLEAR)) is Change.CLEARED


def test_what_was_seen_elsewhere_before_the_first_look_is_put_right_and_thanked_for() -> None:
    first = look(Expectation.IN_REACH)
    found = PutRight(Expectation.IN_REACH, Change.APPEARED)
    assert brought_before(LOST, replace(first, brought=True)) == found
    assert brought_before(LOST, replace(look(), brought=True)) is None
    assert brought_before(LOST, replace(first, brought=False)) is None
    assert brought_before(LOST, first) is None
    assert known_before(first) is None


def test_where_nobody_looked_before_nothing_can_have_changed() -> None:
    assert change_between(None, look()) is Change.UNKNOWN
    assert not Change.UNKNOWN.by_a_person


positions = st.none() | st.tuples(*[st.floats(-1.0, 1.0)] * 3)
looks = st.builds(LookOutcome, st.frozensets(st.sampled_from(Expectation)), positions)
watched_for = st.lists(st.sampled_from(Expectation), unique=True)


@given(watched=watched_for, seen=looks, shift=st.floats(0.0, MOVED_M / 2))
def test_a_state_that_was_already_so_never_counts(
    watched: Sequence[Expectation], seen: LookOutcome, shift: float
) -> None:
    at = seen.position
    shaken = LookOutcome(seen.fulfilled, at and (at[0] + shift, at[1], at[2]))
    assert put_right(watched, seen, shaken) is None


@given(watched=watched_for, first=looks, now=looks)
def test_what_puts_it_right_is_so_now_and_is_new(
    watched: Sequence[Expectation], first: LookOutcome, now: LookOutcome
) -> None:
    found = put_right(watched, first, now)
    if found is not None:
        assert found.seen in watched
        assert found.seen in now.fulfilled
        assert found.change.by_a_person or found.seen not in first.fulfilled


def test_a_camera_that_sees_again_thanks_nobody_who_has_not_promised_it() -> None:
    dark, light = (
        LookOutcome(frozenset(), None),
        LookOutcome(frozenset({Expectation.VIEW_CLEAR}), (0.4, 0.0, 0.7)),
    )
    found = put_right([Expectation.VIEW_CLEAR], dark, light)
    assert found == PutRight(Expectation.VIEW_CLEAR, Change.NONE)
    assert put_right([Expectation.VIEW_CLEAR], replace(light, position=None), light) is None
    assert change_between(dark, light) is Change.CLEARED
