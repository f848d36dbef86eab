"""Whatever happens, nothing waits for ever, is lost, brought twice or too much for a robot."""

import pytest
from dispatch_ordeal import DispatchOrdeal
from sampled import sample


@pytest.mark.parametrize("seed", sample([11], [11, 12, 13]))
def test_everything_comes_to_an_end(seed: int) -> None:
    ordeal = DispatchOrdeal(seed)
    ordeal.happen(40)
    ended = ordeal.come_to_rest()
    assert ended["done"] > 5
    assert ordeal.killed > 0


def test_same_seed_gives_the_same_events() -> None:
    def happened() -> list[str]:
        ordeal = DispatchOrdeal(5)
        ordeal.happen(15)
        return ordeal.events

    assert happened() == happened()
