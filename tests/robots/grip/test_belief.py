"""The filter: evidence adds up, time makes it doubt, and it can always be convinced otherwise."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robots.grip.belief import Belief

RATIOS = st.lists(st.floats(-30.0, 30.0), max_size=30)


def test_it_starts_at_even_odds_and_adds_log_ratios() -> None:
    belief = Belief()
    assert belief.probability == 0.5
    belief.update(math.log(3.0))
    assert belief.probability == pytest.approx(0.75)
    belief.update(-math.log(3.0))
    assert belief.probability == pytest.approx(0.5)


@given(ratios=RATIOS, elapsed_s=st.floats(0.0, 1000.0))
def test_time_only_takes_certainty_of_holding_away(ratios, elapsed_s) -> None:
    belief = Belief()
    for ratio in ratios:
        belief.update(ratio)
    before = belief.probability
    belief.predict(elapsed_s)
    assert 0.0 < belief.probability <= before + 1e-12


@given(ratios=RATIOS)
def test_no_history_is_stronger_than_one_clear_reading(ratios) -> None:
    belief = Belief()
    for ratio in ratios:
        belief.update(ratio)
    belief.update(-12.0)
    assert belief.probability < 0.01
