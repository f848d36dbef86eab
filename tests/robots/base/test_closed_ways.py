"""What a base has found of ways itself comes before what it was told, until it is told anew."""

from hypothesis import given
from hypothesis import strategies as st

from mend.robots.base.closed_ways import KEPT_S, ClosedWays

AB, BC = frozenset("ab"), frozenset("bc")


def test_what_it_is_told_counts_until_then_and_in_the_place_of_what_it_was_told_before() -> None:
    ways = ClosedWays()
    ways.tell({AB: 10.0})
    assert ways.at(9.0) == {AB: None}
    assert not ways.at(10.0)
    ways.tell({BC: 20.0})
    assert ways.at(9.0) == {BC: None}


def test_what_it_finds_barred_it_remembers_with_where_it_came_from() -> None:
    ways = ClosedWays()
    ways.tell({AB: 10.0})
    ways.bar(AB, "b", 5.0)
    assert ways.at(6.0) == {AB: "b"}
    assert ways.at(5.0 + KEPT_S - 1.0) == {AB: "b"}
    assert not ways.at(5.0 + KEPT_S)


def test_what_it_sees_free_is_free_to_it_and_in_doubt_until_it_has_passed() -> None:
    ways = ClosedWays()
    ways.bar(AB, "a", 0.0)
    ways.tell({AB: 10.0})
    ways.free(AB)
    assert not ways.at(1.0)
    assert ways.doubtful(1.0) == {AB: "a"}
    ways.passed(AB)
    assert not ways.at(1.0)
    assert not ways.doubtful(1.0), "it is said once"


def test_what_is_told_again_after_it_was_open_is_closed_again() -> None:
    ways = ClosedWays()
    ways.tell({AB: 10.0})
    ways.passed(AB)
    ways.tell({})
    ways.tell({AB: 20.0})
    assert ways.at(1.0) == ways.doubtful(1.0) == {AB: None}


def test_what_others_have_seen_open_it_need_not_remember_as_barred() -> None:
    ways = ClosedWays()
    ways.bar(AB, "a", 0.0)
    ways.tell({AB: 10.0})
    ways.tell({})
    assert not ways.at(1.0)


Call = tuple[str, object]
calls = st.one_of(
    st.tuples(st.just("tell"), st.dictionaries(st.sampled_from([AB, BC]), st.floats(0.0, 50.0))),
    st.tuples(st.sampled_from(["bar", "free", "passed"]), st.sampled_from([AB, BC])),
)


@given(st.lists(calls), st.floats(0.0, 50.0))
def test_what_counts_as_closed_is_in_doubt_too(made: list[Call], now_s: float) -> None:
    """So whoever passes there says so."""
    ways = ClosedWays()
    for name, argument in made:
        if name == "bar":
            assert isinstance(argument, frozenset)
            ways.bar(argument, min(argument), now_s)
        else:
            getattr(ways, name)(argument)
    assert ways.at(now_s).keys() <= ways.doubtful(now_s).keys()
