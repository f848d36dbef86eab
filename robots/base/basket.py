"""The basket of a base: people put things in and take them out, and it feels what that weighs."""

from dataclasses import dataclass, field
from typing import Protocol

from mend.robots.link.messages import FeltLoad

FELT_KG = 0.1
"""What weighs less than this is nothing that a robot is asked to carry."""
UNSURE_KG = 0.03
"""What a load cell shows may change by so much although nothing has been put in or taken out."""
MISSED_KG = FELT_KG / 2.0
"""A basket that is lighter by this lacks something: half of the lightest thing there may be."""


@dataclass(slots=True)
class BasketMemory:
    """What a robot remembers of its basket, also when it is switched off.

    `items`: what it was given, with what each weighed when it felt that (kg). `expected_kg`: what
    the load cell showed after that; None before its first look. `offered`: what it has offered, and
    at which place, since it got there; `asked`: what it asks for, and at which place.
    `handed_over`: where it last handed over what it no longer has.
    """

    items: dict[str, float] = field(default_factory=dict)
    expected_kg: float | None = None
    offered: tuple[str, str] | None = None
    asked: tuple[str, str] | None = None
    handed_over: dict[str, str] = field(default_factory=dict)

    def offers(self, item: str, place: str) -> bool:
        """Whether it has offered this at this place since it got there."""
        return self.offered == (item, place)

    def note_given(self, item: str, load_kg: float) -> None:
        """Something was put in, and the load cell now shows this."""
        self.items[item] = load_kg - (self.expected_kg or 0.0)
        self.expected_kg = load_kg
        self.asked = None
        self.handed_over.pop(item, None)

    def note_taken(self, item: str, place: str, load_kg: float) -> None:
        """Something was taken out at a place, and the load cell now shows this."""
        self.items.pop(item, None)
        self.expected_kg = load_kg
        self.offered = None
        self.handed_over[item] = place

    def forget(self, item: str) -> None:
        """Something was taken out for another robot, so that the basket weighs less by it."""
        weight_kg = self.items.pop(item, 0.0)
        if self.expected_kg is not None:
            self.expected_kg -= weight_kg
        if self.offered is not None and self.offered[0] == item:
            self.offered = None


class Basket(Protocol):
    """The basket of a body. Whoever helps reads on the robot what it asks for."""

    @property
    def capacity_kg(self) -> float:
        """So much it may hold."""
        ...

    @property
    def most_items(self) -> int:
        """So many things it has room for."""
        ...

    @property
    def memory(self) -> BasketMemory: ...

    def load_kg(self) -> float:
        """What its load cell shows: about what is in it, and always off by a little."""
        ...

    def ask_for(self, item: str, place: str) -> None:
        """Ask for something that is to be put in; asking again changes nothing."""
        ...

    def offer(self, item: str, place: str) -> None:
        """Have people take something out; offering again changes nothing."""
        ...

    def withdraw(self) -> None:
        """Ask for nothing and offer nothing any more."""
        ...


class NoBasket:
    """Where a body has none."""

    capacity_kg = 0.0
    most_items = 0

    def __init__(self) -> None:
        self.memory = BasketMemory()

    def load_kg(self) -> float:
        """Nothing."""
        return 0.0

    def ask_for(self, item: str, place: str) -> None:
        """Nobody reads it."""

    def offer(self, item: str, place: str) -> None:
        """Nobody reads it."""

    def withdraw(self) -> None:
        """Nothing."""


class LoadSense:
    """What a robot makes of what its load cell shows."""

    def __init__(self, basket: Basket) -> None:
        self._basket = basket

    def change_kg(self) -> float:
        """How much more there is in the basket than it remembers; less is negative."""
        memory, load_kg = self._basket.memory, self._basket.load_kg()
        if memory.expected_kg is None:
            memory.expected_kg = load_kg
        return load_kg - memory.expected_kg

    def given(self) -> FeltLoad | None:
        """What keeps the basket from holding something new; None where it does."""
        change_kg, load_kg = self.change_kg(), self._basket.load_kg()
        if change_kg >= FELT_KG:
            return "too_much" if load_kg > self._basket.capacity_kg else None
        if change_kg < -UNSURE_KG:
            return "lighter"
        return "too_little" if change_kg > UNSURE_KG else "nothing"

    def taken(self, weight_kg: float) -> FeltLoad | None:
        """What keeps the basket from being lighter by this; None where it is."""
        change_kg = self.change_kg()
        # A light thing that is still there must not pass for one that is gone.
        if abs(change_kg + weight_kg) < min(FELT_KG, weight_kg / 2.0):
            return None
        if abs(change_kg) <= UNSURE_KG:
            return "nothing"
        return "heavier" if change_kg > 0.0 else "another"

    def as_asked(self) -> FeltLoad | None:
        """What keeps the basket from holding what was asked for, or else all that was given."""
        return self.as_remembered() if self._basket.memory.asked is None else self.given()

    def as_offered(self) -> FeltLoad | None:
        """What keeps the basket from being lighter by what was offered; None where it is."""
        memory = self._basket.memory
        if memory.offered is None:
            return "nothing"
        return self.taken(memory.items.get(memory.offered[0], 0.0))

    def as_remembered(self) -> FeltLoad | None:
        """What keeps the basket from holding all that was given; None where it does."""
        return None if self.change_kg() > -MISSED_KG else "lighter"
