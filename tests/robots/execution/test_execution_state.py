"""An execution's states follow one another only as the table says."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mend.errors import IllegalTransitionError
from mend.robots.execution.execution_state import (
    EXECUTION,
    ExecutionState,
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
        assert EXECUTION.require(state, wanted) is wanted
    else:
        with pytest.raises(IllegalTransitionError, match=f"the execution is {state}: expected"):
            EXECUTION.require(state, wanted)


def test_nothing_follows_an_end() -> None:
    assert {each for each in S if EXECUTION.is_last(each)} == {S.FINISHED, S.ENDED}
    with pytest.raises(IllegalTransitionError, match="expected nothing more, but running came"):
        EXECUTION.require(S.FINISHED, S.RUNNING)
