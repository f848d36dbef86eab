"""The episode rule: nothing that is seen from both sides lies across its boundary."""

from hypothesis import given
from hypothesis import strategies as st

from mend.localization.enml.episodes import episode_start

COUNTS = st.integers(1, 40)


@st.composite
def ties_of(draw: st.DrawFn, count: int) -> list[tuple[int, int]]:
    pose = st.integers(0, count - 1)
    drawn = draw(st.lists(st.tuples(pose, pose), max_size=30))
    return [(min(pair), max(pair)) for pair in drawn if pair[0] != pair[1]]


@given(data=st.data(), count=COUNTS, shortest=st.integers(1, 12), spare=st.integers(0, 20))
def test_no_tie_crosses_the_boundary_unless_the_episode_is_as_long_as_it_may_be(
    data: st.DataObject, count: int, shortest: int, spare: int
) -> None:
    longest = shortest + spare
    ties = data.draw(ties_of(count))
    start = episode_start(count, ties, shortest, longest)
    crossing = [tie for tie in ties if tie[0] < start <= tie[1]]
    assert not crossing or count - start == longest
    assert min(shortest, count) <= count - start <= longest


@given(data=st.data(), count=COUNTS, shortest=st.integers(1, 12), spare=st.integers(0, 20))
def test_no_later_boundary_would_do(
    data: st.DataObject, count: int, shortest: int, spare: int
) -> None:
    ties = data.draw(ties_of(count))
    start = episode_start(count, ties, shortest, shortest + spare)
    for later in range(start + 1, count - shortest + 1):
        assert any(earlier < later <= end for earlier, end in ties)


def test_without_ties_only_the_fewest_poses_stay() -> None:
    assert episode_start(30, [], 10, 25) == 20


def test_a_chain_of_ties_keeps_the_episode_whole() -> None:
    chain = [(index, index + 1) for index in range(19)]
    assert episode_start(20, chain, 5, 25) == 0
    assert episode_start(20, [tie for tie in chain if tie != (7, 8)], 5, 25) == 8
