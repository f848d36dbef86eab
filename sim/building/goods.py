"""What robots carry for people: each thing is with somebody or in a basket, and never twice."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from mend.documents.strict_model import StrictModel

LIGHTEST_KG, HEAVIEST_KG = 0.2, 2.0
_LIGHTEST_OTHER_KG = 0.02
MOST_ITEMS = 4
"""So many things a basket has room for."""
CAPACITY_KG = MOST_ITEMS * HEAVIEST_KG


class ItemSnapshot(StrictModel):
    """An item as it is kept; see `Item`."""

    weight_kg: float
    place: str | None
    robot: int | None
    taken: bool
    delivered: bool


@dataclass(slots=True)
class Item:
    """A thing: with a person at a `place`, or in the basket of a `robot`, by its number.

    `taken`: somebody has taken it out of that basket on the way, and has it; out of none that
    misses it, where it was handed over just then: they keep it. `delivered`: a robot
    has brought it to its place.
    """

    weight_kg: float
    place: str | None
    robot: int | None = None
    taken: bool = False
    delivered: bool = False

    def put_in(self, robot: int) -> None:
        """It is in a basket now."""
        self.place, self.robot, self.taken, self.delivered = None, robot, False, False

    def give_to(self, place: str, *, delivered: bool) -> None:
        """Somebody at a place has it now."""
        self.place, self.robot, self.taken, self.delivered = place, None, False, delivered


class WishSnapshot(StrictModel):
    """A wish as it is kept; see `Wish`."""

    item: str
    place: str
    hands_over: bool
    mistaken: str | None


@dataclass(slots=True)
class Wish:
    """What a robot shows to who stands before it: that it asks for an item, or hands it over.

    `mistaken`: what somebody put in, or took out, instead.
    """

    item: str
    place: str
    hands_over: bool
    mistaken: str | None = None


class Goods:
    """All items, and what robots, by their numbers, ask people to do with them."""

    def __init__(self, seed: int, forgetful: float, rng: np.random.Generator) -> None:
        """`forgetful`: how often people forget what they said, or take something else."""
        self.seed = seed
        self.forgetful = forgetful
        self._rng = rng
        self.items: dict[str, Item] = {}
        self.wishes: dict[int, Wish] = {}

    def load_kg(self, robot: int) -> float:
        """What the things in a basket weigh."""
        return sum(each.weight_kg for each in self._in_basket(robot).values())

    def wish(self, robot: int, wish: Wish) -> None:
        """A robot asks for something, or hands it over."""
        known = self.wishes.get(robot)
        if known is None or (known.item, known.place, known.hands_over) != (
            wish.item,
            wish.place,
            wish.hands_over,
        ):
            self.wishes[robot] = wish

    def _in_basket(self, robot: int) -> dict[str, Item]:
        return {n: each for n, each in self.items.items() if each.robot == robot and not each.taken}

    def _item(self, name: str, place: str) -> Item:
        """An item; one that nobody has asked for yet is with somebody at the place."""
        if name not in self.items:
            drawn = np.random.default_rng([self.seed, *name.encode()])
            weight_kg = float(drawn.uniform(LIGHTEST_KG, HEAVIEST_KG))
            self.items[name] = Item(weight_kg, place)
        return self.items[name]

    # --- What people do -----------------------------------------------------------------------

    def put_in(
        self,
        name: str | None,
        stands_at: Callable[[int, str | None], bool],
        is_at_hand: Callable[[int, int], bool],
    ) -> str:
        """Somebody puts in what a robot asks for, or what they took out of its basket before.

        `stands_at`: whether a robot stands, and at a place where one is named; `is_at_hand`:
        whether what another robot has can be brought to it. Returns why it cannot be done, or
        nothing.
        """
        back = self._put_back(stands_at)
        if back:
            others = name is not None and name not in back
            return f"somebody put back '{back[0]}', which was taken out before" if others else ""
        robot = self._who_wishes(name, stands_at, hands_over=False)
        if robot is None:
            return f"no robot asks for {_called(name)} where it stands"
        wish = self.wishes[robot]
        if wish.mistaken is not None:
            self.items[wish.mistaken].give_to(wish.place, delivered=False)
            wish.mistaken = None
        if len(self._in_basket(robot)) >= MOST_ITEMS:
            return "the robot's basket is full"
        forgets, takes_another = self._forgets()
        if takes_another:
            wish.mistaken = self._put_in_another(robot, wish.place)
            return "somebody put something else into the basket"
        if forgets:
            return f"somebody forgot to put '{wish.item}' into the basket"
        item = self._item(wish.item, wish.place)
        other = item.robot
        from_other = other is not None and not item.taken and is_at_hand(robot, other)
        if item.place != wish.place and not from_other:
            return f"nobody at '{wish.place}' has '{wish.item}': it is {self._told(item)}"
        item.put_in(robot)
        return ""

    def take_out(self, name: str | None, stands_at: Callable[[int, str | None], bool]) -> str:
        """Somebody takes out what a robot hands over; returns why they cannot, or nothing."""
        robot = self._who_wishes(name, stands_at, hands_over=True)
        if robot is None:
            return f"no robot hands over {_called(name)} where it stands"
        wish = self.wishes[robot]
        if wish.mistaken is not None:
            self.items[wish.mistaken].put_in(robot)
            wish.mistaken = None
        there = self._in_basket(robot)
        others = [each for each in there if each != wish.item]
        forgets, takes_another = self._forgets()
        if takes_another and others:
            wish.mistaken = others[int(self._rng.integers(len(others)))]
            there[wish.mistaken].give_to(wish.place, delivered=False)
            return "somebody took something else out of the basket"
        if forgets:
            return f"somebody forgot to take '{wish.item}' out of the basket"
        if wish.item not in there:
            return f"'{wish.item}' is not in the robot's basket"
        there[wish.item].give_to(wish.place, delivered=True)
        return ""

    def steal(self, name: str | None) -> str:
        """Somebody takes a thing out of a basket whom it is not for; returns why they cannot."""
        item = self.items.get(name or "")
        if item is None or item.robot is None or item.taken:
            return f"'{name}' is in no robot's basket"
        item.taken = True
        wish = self.wishes.get(item.robot)
        if wish is not None and wish.hands_over and wish.item == name:
            item.robot = None
        return ""

    def _put_back(self, stands_at: Callable[[int, str | None], bool]) -> list[str]:
        """Put what was taken on the way back into the baskets of robots that stand; what it was."""
        back = []
        for name, item in self.items.items():
            if item.taken and item.robot is not None and stands_at(item.robot, None):
                item.put_in(item.robot)
                back.append(name)
        return back

    def _who_wishes(
        self,
        name: str | None,
        stands_at: Callable[[int, str | None], bool],
        *,
        hands_over: bool,
    ) -> int | None:
        for robot, wish in self.wishes.items():
            meant = wish.hands_over is hands_over and name in (None, wish.item)
            if meant and stands_at(robot, wish.place):
                return robot
        return None

    def _forgets(self) -> tuple[bool, bool]:
        """Whether somebody does not do what they said, and whether they do something else."""
        if self.forgetful <= 0.0:
            return False, False
        forgets, another = self._rng.random(2)
        return bool(forgets < self.forgetful), bool(forgets < self.forgetful and another < 0.5)

    def _put_in_another(self, robot: int, place: str) -> str:
        """Somebody puts in something that nobody has asked for; what it is called."""
        name = f"something else {len(self.items) + 1}"
        item = Item(float(self._rng.uniform(_LIGHTEST_OTHER_KG, HEAVIEST_KG)), place)
        item.put_in(robot)
        self.items[name] = item
        return name

    @staticmethod
    def _told(item: Item) -> str:
        if item.place is not None:
            return f"with somebody at '{item.place}'"
        return "with who took it out of a basket" if item.taken else "in a robot's basket"

    # --- What they are rebuilt from -------------------------------------------------------------

    def snapshot(self) -> tuple[dict[str, ItemSnapshot], dict[int, WishSnapshot]]:
        """Where everything is, and what robots ask for."""
        items = {
            name: ItemSnapshot(
                weight_kg=each.weight_kg,
                place=each.place,
                robot=each.robot,
                taken=each.taken,
                delivered=each.delivered,
            )
            for name, each in self.items.items()
        }
        wishes = {
            robot: WishSnapshot(
                item=each.item,
                place=each.place,
                hands_over=each.hands_over,
                mistaken=each.mistaken,
            )
            for robot, each in self.wishes.items()
        }
        return items, wishes

    def restore(
        self, items: Mapping[str, ItemSnapshot], wishes: Mapping[int, WishSnapshot]
    ) -> None:
        """Have everything where it was."""
        self.items = {
            name: Item(each.weight_kg, each.place, each.robot, each.taken, each.delivered)
            for name, each in items.items()
        }
        self.wishes = {
            robot: Wish(each.item, each.place, each.hands_over, each.mistaken)
            for robot, each in wishes.items()
        }


def _called(name: str | None) -> str:
    return "anything" if name is None else f"'{name}'"
