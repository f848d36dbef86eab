"""An execution's states follow one another only as the table says."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mend.robots.behaviors.execution_state import (
    ExecutionState,
    ExecutionTransitionError,
    follow,
    is_over,
)

S = ExecutionState
ALLOWED = {
    (S.PREPARING, S.RUNNING),
    (S.PREPARING, S.RETREATING),
    (S.PREPARING, S.HOLDING),
    (S.PREPARING, S.FINISHED),
    (S.PREPARING, S.ENDED),
    (S.RUNNING, S.BACKING_OFF),
    (S.BACKING_OFF, S.PREPARING),
    (S.BACKING_OFF, S.RUNNING),
    (S.BACKING_OFF, S.RETREATING),
    (S.BACKING_OFF, S.HOLDING),
    (S.RUNNING, S.CONFIRMING),
    (S.CONFIRMING, S.PREPARING),
    (S.CONFIRMING, S.RETREATING),
    (S.CONFIRMING, S.HOLDING),
    (S.CONFIRMING, S.FINISHED),
    (S.RUNNING, S.RETREATING),
    (S.RUNNING, S.HOLDING),
    (S.RUNNING, S.FINISHED),
    (S.RETREATING, S.HOLDING),
    (S.RETREATING, S.ENDED),
    (S.HOLDING, S.PREPARING),
    (S.HOLDING, S.RETREATING),
    (S.HOLDING, S.ENDED),
}


@given(state=st.sampled_from(S), wanted=st.sampled_from(S))
def test_what_is_not_in_the_table_raises(state: S, wanted: S) -> None:
    if (state, wanted) in ALLOWED:
        assert follow(state, wanted) is wanted
    else:
        with pytest.raises(ExecutionTransitionError, match=f"that is {state} can become"):
            follow(state, wanted)


def test_nothing_follows_an_end() -> None:
    assert {each for each in S if is_over(each)} == {S.FINISHED, S.ENDED}
    with pytest.raises(ExecutionTransitionError, match="can become nothing more, not running"):
        follow(S.FINISHED, S.RUNNING)
