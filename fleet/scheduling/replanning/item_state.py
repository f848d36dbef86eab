"""Where an item of a fleet at work is, and which states may follow one another."""

from dataclasses import dataclass, field, replace
from enum import StrEnum
from math import inf

from mend.fleet.scheduling.problem import Item, Visit, Window
from mend.fleet.scheduling.schedule import Action


class ItemState(StrEnum):
    """How far an item has come."""

    WAITING = "waiting"
    ABOARD = "aboard"
    LEFT = "left"
    DELIVERED = "delivered"
    CANCELLED = "cancelled"
    REFUSED = "refused"
    LOST = "lost"
    STRANDED = "stranded"


_NEXT = {
    ItemState.WAITING: {ItemState.ABOARD, ItemState.CANCELLED, ItemState.REFUSED},
    ItemState.ABOARD: {
        ItemState.LEFT,
        ItemState.DELIVERED,
        ItemState.CANCELLED,
        ItemState.LOST,
        ItemState.STRANDED,
    },
    ItemState.LEFT: {
        ItemState.ABOARD,
        ItemState.CANCELLED,
        ItemState.LOST,
        ItemState.STRANDED,
    },
    ItemState.STRANDED: {ItemState.CANCELLED},
}
"""Nothing follows the others."""


class ItemStateError(Exception):
    """An item was to go where it cannot go from its state; says from where to where."""


@dataclass(slots=True)
class TrackedItem:
    """An item with its state.

    `robot` has it while it is aboard; `place` and `ready_s` say where it lies since when while it
    is left; `loaded_s` is the end of its pickup. `returns`: it was cancelled on its way and goes
    back; `overdue`: it goes on although its times cannot be kept; `put_off`: why it is in no plan;
    `withdrawn`: it was cancelled while a robot is about to pick it up, and ends with that stop.
    `held_by`: where it lies is the basket of that robot, which works no more. `taken_from`: the
    robots that may still think that they have it, as it was taken out of their baskets for others.
    """

    item: Item
    state: ItemState = ItemState.WAITING
    robot: int | None = None
    place: int | None = None
    ready_s: float = 0.0
    loaded_s: float | None = None
    returns: bool = False
    overdue: bool = False
    put_off: str | None = None
    withdrawn: bool = False
    held_by: int | None = None
    taken_from: set[int] = field(default_factory=set)

    @property
    def under_way(self) -> bool:
        """Whether it has been picked up, but not been delivered."""
        return self.state in (ItemState.ABOARD, ItemState.LEFT)

    @property
    def open(self) -> bool:
        """Whether anything remains to be done with it."""
        return self.under_way or (self.state is ItemState.WAITING and not self.withdrawn)

    def copy(self) -> "TrackedItem":
        """The same by itself."""
        return replace(self, taken_from=set(self.taken_from))

    def load(self, robot: int, done_s: float) -> None:
        """A robot has it from now on. Raises `ItemStateError`."""
        if self.state is ItemState.WAITING:
            self.loaded_s = done_s
        self._become(ItemState.ABOARD)
        self._leave_basket()
        self.robot, self.place = robot, None
        self.taken_from.discard(robot)

    def leave(self, place: int, ready_s: float) -> None:
        """It lies somewhere for another robot. Raises `ItemStateError`."""
        self._become(ItemState.LEFT)
        self.robot, self.place, self.ready_s = None, place, ready_s

    def stand_with(self, place: int, since_s: float) -> None:
        """Its robot works no more, and stands there with it. Raises `ItemStateError`.

        Who is escorted is in no basket: whoever leads them on meets them first.
        """
        held_by = None if self.item.direct else self.robot
        self.leave(place, since_s)
        self.held_by = held_by

    def stand_elsewhere(self, place: int) -> None:
        """The robot that it stands with is at another place now."""
        assert self.held_by is not None, "it stands with a robot"
        self.place = place

    def go_on_with(self) -> None:
        """The robot that it stands with works again, and has it. Raises `ItemStateError`."""
        robot, self.held_by = self.held_by, None
        if self.state is not ItemState.STRANDED:
            self._become(ItemState.ABOARD)
        self.robot, self.place = robot, None

    def change_baskets(self, robot: int) -> None:
        """People took it out of one robot's basket and put it into that of another."""
        assert self.state is ItemState.ABOARD, "it is in a basket"
        assert self.robot is not None, "it is in a basket"
        self.taken_from.add(self.robot)
        self.robot = robot
        self.taken_from.discard(robot)

    def close(self, state: ItemState) -> None:
        """Nothing remains to be done. Raises `ItemStateError`."""
        self._become(state)
        self._leave_basket()
        self.robot = self.place = self.put_off = None

    def strand(self) -> None:
        """It stays where it is, aboard or at a place, until a person takes it.

        Raises `ItemStateError`.
        """
        self._become(ItemState.STRANDED)
        self.put_off = None

    def try_again(self, action: Action, again_s: float) -> None:
        """What was to be done with it may be tried again at `again_s`; late if need be."""
        item = self.item
        if self.state is ItemState.LEFT:
            self.ready_s = max(self.ready_s, again_s)
        elif self.state is ItemState.WAITING:
            window = replace(item.pickup.window, earliest_s=again_s)
            self.item = replace(item, pickup=replace(item.pickup, window=window))
        elif action is Action.DROP:
            window = item.delivery.window
            self.overdue = self.overdue or again_s > window.latest_s
            window = Window(again_s, max(again_s, window.latest_s))
            self.item = replace(item, delivery=replace(item.delivery, window=window))

    def send_back(self) -> None:
        """Bring it back to where it was picked up, whenever that is possible."""
        self.returns = self.overdue = True
        back = Visit(self.item.pickup.place, service_s=self.item.pickup.service_s)
        self.item = replace(self.item, delivery=back, max_on_board_s=inf)

    def residual(self, robot: int | None, handling_s: float) -> Item:
        """What remains to be done as an item by itself; `robot`: the number of whoever has it."""
        item = without_deadline(self.item) if self.overdue else self.item
        if not self.under_way:
            return item
        assert self.loaded_s is not None, "what is under way was picked up"
        window = item.delivery.window
        latest_s = min(window.latest_s, self.loaded_s + item.max_on_board_s)
        delivery = replace(item.delivery, window=Window(min(window.earliest_s, latest_s), latest_s))
        if self.state is ItemState.ABOARD:
            return replace(item, delivery=delivery, max_on_board_s=inf, aboard=robot)
        assert self.place is not None, "what is left lies somewhere"
        pickup = Visit(self.place, Window(self.ready_s), service_s=handling_s)
        return replace(item, pickup=pickup, delivery=delivery, max_on_board_s=inf)

    def _leave_basket(self) -> None:
        """It stands with no robot that works no more."""
        if self.held_by is not None:
            self.taken_from.add(self.held_by)
            self.held_by = None

    def _become(self, state: ItemState) -> None:
        if state not in _NEXT.get(self.state, ()):
            raise ItemStateError(
                f"item '{self.item.name}' is {self.state}; it cannot become {state} from there"
            )
        self.state = state


def without_deadline(item: Item) -> Item:
    """The same item; what had to be in time is now better in time."""
    delivery, pickup = item.delivery, item.pickup
    pickup = replace(pickup, window=Window(pickup.window.earliest_s))
    late = replace(
        delivery,
        window=Window(delivery.window.earliest_s),
        due_s=min(delivery.due_s, delivery.window.latest_s),
    )
    return replace(item, pickup=pickup, delivery=late, max_on_board_s=inf)
