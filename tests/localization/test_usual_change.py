"""What changes from scan to scan where nobody is carried is learned on the way."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mend.localization.enml.parameters import EnmlParameters
from mend.localization.enml.usual_change import UsualChange

ITS = EnmlParameters()
CHANGES = st.lists(st.tuples(st.floats(0.0, 2.0), st.floats(0.0, 1.0)), max_size=60)


def after(*changes: float) -> UsualChange:
    usual = UsualChange(ITS)
    for each in changes:
        usual.learn(each, 1.0)
    return usual


@given(CHANGES)
def test_it_stays_a_density_whatever_is_learned(changes: list[tuple[float, float]]) -> None:
    usual = UsualChange(ITS)
    for each in changes:
        usual.learn(*each)
    grid = np.linspace(0.0, 2.0, 2_001)
    told = [usual.log_density(float(each)) for each in grid]
    assert -18.0 < min(told) < max(told) < 3.0
    assert 0.2 < np.trapezoid(np.exp(told), grid) < 1.1


def test_at_first_it_is_what_the_parameters_say() -> None:
    usual = UsualChange(ITS)
    middle = usual.log_density(ITS.usual_change)
    assert middle > usual.log_density(ITS.usual_change + ITS.usual_spread)
    assert usual.log_density(1.2) < middle - 4.0


def test_where_much_changes_all_the_time_that_is_no_surprise() -> None:
    generator = np.random.default_rng(1)
    crowd = after(*generator.normal(0.6, 0.2, 60))
    walls = after(*generator.normal(0.1, 0.1, 60))
    assert crowd.log_density(0.9) > walls.log_density(0.9) + 2.0


def test_what_was_usual_long_ago_is_forgotten() -> None:
    long = int(5 * ITS.usual_scans)
    assert after(*[1.0] * 30, *[0.1] * long).log_density(1.0) < -3.0


def test_what_weighs_nothing_teaches_nothing() -> None:
    usual = after(0.3, 0.1)
    before = usual.log_density(0.8)
    for _ in range(10_000):
        usual.learn(2.0, 0.0)
    assert usual.log_density(0.8) == before


def test_one_outlier_is_hardly_learned_from() -> None:
    usual = [0.0, 0.1] * 30
    assert after(*usual, 1.7).log_density(1.7) == pytest.approx(
        after(*usual).log_density(1.7), abs=0.2
    )
    assert after(*usual, *[0.9] * 30).log_density(0.9) > after(*usual).log_density(0.9) + 1.0


def test_where_nothing_ever_changes_a_little_is_still_no_surprise() -> None:
    still = after(*[0.0] * 500)
    assert still.log_density(0.05) > still.log_density(0.0) - 1.0


def test_a_chair_that_is_moved_is_a_smaller_surprise_than_another_room() -> None:
    still = after(*[0.0] * 500)
    chair, room = still.log_density(0.4), still.log_density(1.4)
    assert room < chair - 3.0
    assert chair > -4.0
