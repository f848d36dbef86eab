"""The basket of one robot of a building: a load cell over what is really in it."""

import numpy as np

from mend.documents.strict_model import StrictModel
from mend.robots.base.basket import BasketMemory
from mend.sim.building.draws import read_draws, written_draws
from mend.sim.building.goods import CAPACITY_KG, MOST_ITEMS, Goods, Wish

_NOISE_KG = 0.005
_BIAS_KG = 0.05


class BasketSnapshot(StrictModel):
    """What a basket is rebuilt from: what its load cell is off by, and what its robot remembers."""

    bias_kg: float
    draws: str
    items: dict[str, float]
    expected_kg: float | None
    offered: tuple[str, str] | None
    handed_over: dict[str, str]
    # Older ones do not say.
    asked: tuple[str, str] | None = None


class RobotBasket:
    """Implements `mend.robots.base.basket.Basket`."""

    capacity_kg = CAPACITY_KG
    most_items = MOST_ITEMS

    def __init__(self, goods: Goods, number: int, seed: int) -> None:
        """`number`: which robot it belongs to."""
        self._goods, self._number = goods, number
        self._rng = np.random.default_rng([seed, number])
        self._bias_kg = float(self._rng.uniform(-_BIAS_KG, _BIAS_KG))
        self.memory = BasketMemory()

    def load_kg(self) -> float:
        noise_kg = float(self._rng.normal(0.0, _NOISE_KG))
        return self._goods.load_kg(self._number) + self._bias_kg + noise_kg

    def ask_for(self, item: str, place: str) -> None:
        self._goods.wish(self._number, Wish(item, place, hands_over=False))

    def offer(self, item: str, place: str) -> None:
        self._goods.wish(self._number, Wish(item, place, hands_over=True))

    def withdraw(self) -> None:
        self._goods.wishes.pop(self._number, None)

    def snapshot(self) -> BasketSnapshot:
        """What it is rebuilt from."""
        memory = self.memory
        return BasketSnapshot(
            bias_kg=self._bias_kg,
            draws=written_draws(self._rng),
            items=dict(memory.items),
            expected_kg=memory.expected_kg,
            offered=memory.offered,
            handed_over=dict(memory.handed_over),
            asked=memory.asked,
        )

    def restore(self, kept: BasketSnapshot) -> None:
        """Raises `ValueError` for draws that cannot be gone on with."""
        self._bias_kg = kept.bias_kg
        read_draws(self._rng, kept.draws)
        memory = self.memory
        memory.items, memory.expected_kg = dict(kept.items), kept.expected_kg
        memory.offered, memory.handed_over = kept.offered, dict(kept.handed_over)
        memory.asked = kept.asked
