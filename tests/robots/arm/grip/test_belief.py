"""The filter: evidence adds up, time makes it doubt, and it can always be convinced otherwise."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mend.robots.arm.grip.belief import Belief, Between

LOGS = st.fixed_dictionaries({each: st.floats(-30.0, 30.0) for each in Between})
HISTORIES = st.lists(LOGS, max_size=30)


def likelihoods(straight: float, turned: float, other: float, nothing: float):
    return {
        Between.STRAIGHT: straight,
        Between.TURNED: turned,
        Between.OTHER: other,
        Between.NOTHING: nothing,
    }


def believing(history) -> Belief:
    belief = Belief()
    for each in history:
        belief.update(each)
    return belief


def test_it_starts_at_even_odds_and_what_says_nothing_changes_nothing() -> None:
    belief = Belief()
    assert belief.probability == pytest.approx(0.5)
    belief.update(likelihoods(-3.0, -3.0, -3.0, -3.0))
    assert belief.probability == pytest.approx(0.5)


@given(history=HISTORIES, elapsed_s=st.floats(0.0, 1000.0))
def test_time_only_takes_certainty_of_holding_away(history, elapsed_s) -> None:
    belief = believing(history)
    before = belief.probability
    belief.predict(elapsed_s)
    assert 0.0 <= belief.probability <= before + 1e-12


@given(history=HISTORIES, held=st.booleans())
def test_no_history_is_stronger_than_one_clear_reading(history, held) -> None:
    belief = believing(history)
    belief.update(likelihoods(0.0, 0.0, 12.0, 12.0) if held else likelihoods(12.0, 0.0, 0.0, 0.0))
    assert (belief.probability < 0.01) if held else (belief.probability > 0.99)


def test_many_readings_of_a_turned_part_never_make_a_stranger_of_it() -> None:
    """Each alone would speak against it, since few parts are turned."""
    belief = Belief()
    for _ in range(100):
        belief.predict(1 / 30)
        belief.update(likelihoods(-8.0, 1.0, 0.0, -8.0))
    assert belief.probability > 0.9


def test_a_part_may_turn_while_it_is_held() -> None:
    belief = believing([likelihoods(5.0, 0.0, 0.0, 0.0)] * 10)
    for _ in range(30):
        belief.predict(1 / 30)
        belief.update(likelihoods(-8.0, 1.0, 0.0, -8.0))
    assert belief.probability > 0.9


def test_what_is_pushed_may_well_be_turned() -> None:
    calm, pushed = Belief(), Belief()
    pushed.push()
    assert pushed.probability == pytest.approx(calm.probability)
    for belief in (calm, pushed):
        belief.update(likelihoods(-20.0, 0.0, 0.0, -20.0))
    assert calm.probability < 0.1
    assert pushed.probability > 0.5
