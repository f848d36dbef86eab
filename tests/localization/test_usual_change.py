"""What changes from scan to scan where nobody is carried is learned on the way."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mend.localization.enml.parameters import EnmlParameters
from mend.localization.enml.usual_change import UsualChange

ITS = EnmlParameters()
CHANGES = st.lists(st.tuples(st.floats(-1.0, 2.0), st.floats(0.0, 1.0)), max_size=60)


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
    grid = np.linspace(-1.0, 2.0, 3_001)
    told = [usual.log_density(float(each)) for each in grid]
    assert -18.0 < min(told) < max(told) < 3.0
    assert 0.2 < np.trapezoid(np.exp(told), grid) < 1.1


def test_at_first_it_is_what_the_parameters_say() -> None:
    usual = UsualChange(ITS)
    middle = usual.log_density(-ITS.recognized_share)
    assert middle > usual.log_density(-ITS.recognized_share + ITS.recognized_spread)
    assert usual.log_density(0.5) < middle - 4.0


def test_where_much_changes_all_the_time_that_is_no_surprise() -> None:
    generator = np.random.default_rng(1)
    crowd = after(*generator.normal(-0.2, 0.2, 60))
    walls = after(*generator.normal(-0.7, 0.1, 60))
    assert crowd.log_density(0.1) > walls.log_density(0.1) + 2.0


def test_what_was_usual_long_ago_is_forgotten() -> None:
    long = 5 * ITS.max_episode_length
    assert after(*[0.2] * 30, *[-0.7] * long).log_density(0.2) < -3.0


def test_what_weighs_nothing_teaches_nothing() -> None:
    usual = after(-0.5, -0.7)
    before = usual.log_density(0.0)
    for _ in range(10_000):
        usual.learn(2.0, 0.0)
    assert usual.log_density(0.0) == before


def test_one_outlier_is_hardly_learned_from() -> None:
    usual = [-0.8, -0.7] * 30
    assert after(*usual, 0.9).log_density(0.9) == pytest.approx(
        after(*usual).log_density(0.9), abs=0.2
    )
    assert after(*usual, *[0.1] * 30).log_density(0.1) > after(*usual).log_density(0.1) + 1.0


def test_where_nothing_ever_changes_a_little_is_still_no_surprise() -> None:
    still = after(*[-0.8] * 500)
    assert still.log_density(-0.75) > still.log_density(-0.8) - 1.0


def test_a_chair_that_is_moved_is_a_smaller_surprise_than_another_room() -> None:
    still = after(*[-0.8] * 500)
    chair, room = still.log_density(-0.4), still.log_density(0.6)
    assert room < chair - 3.0
    assert chair > -4.0
