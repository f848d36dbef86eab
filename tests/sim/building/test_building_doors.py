"""Doors: open for who comes, shut behind them, and never on anybody."""

from mend.maps.building.building import Door, DoorOpening
from mend.sim.building.door import WorldDoor

POSTS = ((0.0, 0.0), (1.0, 0.0))


def door(opens: DoorOpening, *, is_shut: bool = True, **plan: object) -> WorldDoor:
    return WorldDoor("F1/d", Door.model_validate({"posts": POSTS, "opens": opens, **plan}), is_shut)


def test_it_opens_itself_for_who_comes_and_shuts_after_they_are_gone() -> None:
    automatic = door(DoorOpening.ITSELF)
    automatic.let_pass(0.0, somebody=False)
    assert automatic.is_shut
    automatic.let_pass(1.0, somebody=True)
    assert not automatic.is_shut
    automatic.let_pass(3.0, somebody=False)
    assert not automatic.is_shut
    automatic.let_pass(6.0, somebody=False)
    assert automatic.is_shut


def test_it_does_not_shut_on_who_stands_in_it() -> None:
    automatic = door(DoorOpening.ITSELF)
    for second in range(60):
        automatic.let_pass(float(second), somebody=True)
    assert not automatic.is_shut


def test_what_people_open_stays_shut_for_robots_and_falls_shut_after_it_was_held() -> None:
    by_hand = door(DoorOpening.PEOPLE)
    by_hand.let_pass(1.0, somebody=True)
    assert by_hand.is_shut
    by_hand.hold_open(10.0)
    by_hand.let_pass(12.0, somebody=True)
    assert not by_hand.is_shut
    by_hand.let_pass(13.0, somebody=False)
    assert by_hand.is_shut


def test_what_somebody_left_open_stays_open() -> None:
    by_hand = door(DoorOpening.PEOPLE, is_shut=False)
    by_hand.let_pass(1e6, somebody=False)
    assert not by_hand.is_shut


def test_beyond_its_hours_it_is_locked_once_nobody_is_in_it() -> None:
    shop = door(DoorOpening.ITSELF, open_s=((10.0, 20.0),))
    shop.let_pass(15.0, somebody=True)
    assert not shop.is_shut
    shop.let_pass(21.0, somebody=True)
    assert not shop.is_shut
    shop.let_pass(22.0, somebody=False)
    assert shop.is_shut
    shop.let_pass(23.0, somebody=True)
    assert shop.is_shut
