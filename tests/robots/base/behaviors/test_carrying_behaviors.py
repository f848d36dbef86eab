"""The steps of carrying things and telling messages, and what is refused before any of them."""

import pytest
from pydantic import ValidationError

from mend.robots.base.basket import NoBasket
from mend.robots.base.behaviors.behavior import BaseSituation
from mend.robots.base.behaviors.charge import Charge, ChargeParameters
from mend.robots.base.behaviors.collect_item import CollectItem, ItemParameters
from mend.robots.base.behaviors.deliver_message import DeliverMessage, MessageParameters
from mend.robots.base.behaviors.hand_over_item import HandOverItem
from mend.robots.base.body import BasePose
from mend.robots.base.ways import StraightWays
from mend.robots.execution.command_error import CommandError

HERE, THERE = BasePose(0.0, 0.0, 0.0), BasePose(3.0, 0.0, 0.0)
MAIL = ItemParameters(place="office", item="mail")


class Basket(NoBasket):
    """One with room for two things."""

    most_items = 2


def situation(basket: NoBasket | None = None, target: BasePose | None = THERE) -> BaseSituation:
    return BaseSituation(HERE, {"office": THERE}, target, StraightWays(), basket or Basket())


def test_it_goes_there_and_then_waits_for_people() -> None:
    basket = Basket()
    names = [each.name for each in CollectItem().steps(MAIL, situation(basket))]
    assert names == ["go to office", "collect mail"]
    names = [each.name for each in HandOverItem().steps(MAIL, situation(basket))]
    assert names == ["go to office", "hand over mail"]
    told = MessageParameters(place="office", message="Lunch is here.")
    names = [each.name for each in DeliverMessage().steps(told, situation())]
    assert names == ["go to office", "tell the message"]
    charged = ChargeParameters(place="office")
    assert [e.name for e in Charge().steps(charged, situation())] == ["go to office", "charge"]


def test_what_is_done_already_takes_no_step() -> None:
    basket = Basket()
    basket.memory.note_given("mail", 0.5)
    assert CollectItem().steps(MAIL, situation(basket)) == []
    basket.memory.note_taken("mail", "office", 0.0)
    assert HandOverItem().steps(MAIL, situation(basket)) == []


def test_a_full_basket_is_said() -> None:
    basket = Basket()
    basket.memory.note_given("keys", 0.5)
    basket.memory.note_given("book", 1.0)
    with pytest.raises(CommandError, match="room for 2 items, and holds keys, book"):
        CollectItem().steps(MAIL, situation(basket))


def test_a_place_that_nobody_knows_is_said() -> None:
    with pytest.raises(CommandError, match="it is not known where 'office' is"):
        CollectItem().steps(MAIL, situation(target=None))


@pytest.mark.parametrize(
    "message", ["", " now", "now ", "a\nb", "a\u202eb", "He said “no”.", 'a "b"', "x" * 301]
)
def test_messages_that_could_not_be_shown_as_they_are_get_refused(message: str) -> None:
    with pytest.raises(ValidationError):
        MessageParameters(place="office", message=message)


@pytest.mark.parametrize("message", ["x" * 300, "Grüße an 北京!", "It's {me}, 100 % _sure_."])
def test_any_other_message_is_told_word_for_word(message: str) -> None:
    assert MessageParameters(place="office", message=message).message == message


@pytest.mark.parametrize("item", ["", "two words", "a" * 65, "{item}", "1st"])
def test_items_are_called_by_names(item: str) -> None:
    with pytest.raises(ValidationError):
        ItemParameters(place="office", item=item)
