"""Whatever happens, nothing waits for ever, is lost, brought twice or too much for a robot."""

import pytest
from dispatch_ordeal import DispatchOrdeal
from languages_of_console import half_told
from sampled import sample


@pytest.mark.parametrize("seed", sample([11], [11, 12, 13]))
def test_everything_comes_to_an_end(seed: int) -> None:
    ordeal = DispatchOrdeal(seed)
    ordeal.happen(40)
    ended = ordeal.come_to_rest()
    assert ended["done"] > 5
    assert ordeal.killed > 0


@pytest.mark.parametrize("seed", sample([14, 15], range(14, 34)))
def test_people_can_read_each_reason_in_their_language(seed: int) -> None:
    ordeal = DispatchOrdeal(seed)
    ordeal.happen(30)
    ordeal.come_to_rest()
    reasons = {each.reason for each in ordeal.dispatcher.views() if each.reason is not None}
    for change in ordeal.dispatcher.log:
        reasons |= {change.reason, *change.said.values()}
    assert len(reasons) > 5
    assert half_told(sorted(reasons), typed="its battery is empty") == []


def test_same_seed_gives_the_same_events() -> None:
    def happened() -> list[str]:
        ordeal = DispatchOrdeal(5)
        ordeal.happen(15)
        return ordeal.events

    assert happened() == happened()
