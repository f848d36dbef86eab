"""What a robot makes of its load cell: how much was put in or taken out, and never what."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mend.robots.base.basket import FELT_KG, UNSURE_KG, BasketMemory, LoadSense, NoBasket


class Scales(NoBasket):
    """A basket whose load cell shows what a test says."""

    capacity_kg = 8.0
    most_items = 4

    def __init__(self) -> None:
        super().__init__()
        self.shows_kg = 0.04

    def load_kg(self) -> float:
        return self.shows_kg


def sense() -> tuple[Scales, LoadSense]:
    scales = Scales()
    load = LoadSense(scales)
    load.change_kg()
    return scales, load


@pytest.mark.parametrize(
    ("more_kg", "felt"),
    [
        (0.0, "nothing"),
        (0.02, "nothing"),
        (0.06, "too_little"),
        (0.5, None),
        (9.0, "too_much"),
        (-0.5, "lighter"),
    ],
)
def test_what_is_put_in_is_felt_by_its_weight(more_kg: float, felt: str | None) -> None:
    scales, load = sense()
    scales.shows_kg += more_kg
    assert load.given() == felt


@pytest.mark.parametrize(
    ("less_kg", "felt"),
    [
        (0.0, "nothing"),
        (0.5, None),
        (0.45, None),
        (0.3, "another"),
        (0.8, "another"),
        (-0.3, "heavier"),
    ],
)
def test_what_is_taken_out_has_to_weigh_what_was_put_in(less_kg: float, felt: str | None) -> None:
    scales, load = sense()
    scales.shows_kg += 0.5
    scales.memory.note_given("mail", scales.load_kg())
    scales.shows_kg -= less_kg
    assert load.taken(scales.memory.items["mail"]) == felt


OFF_KG = st.floats(-UNSURE_KG / 2.0, UNSURE_KG / 2.0)


@given(st.floats(FELT_KG, 2.0), OFF_KG, OFF_KG, OFF_KG)
def test_the_lightest_thing_is_felt_as_there_and_as_gone(
    weighs_kg: float, off_before_kg: float, off_given_kg: float, off_now_kg: float
) -> None:
    scales = Scales()
    load = LoadSense(scales)
    scales.shows_kg = off_before_kg
    load.change_kg()
    scales.shows_kg = weighs_kg + off_given_kg
    scales.memory.note_given("mail", scales.load_kg())
    scales.shows_kg = weighs_kg + off_now_kg
    assert load.taken(scales.memory.items["mail"]) == "nothing"
    assert load.as_remembered() is None
    scales.shows_kg = off_now_kg
    assert load.taken(scales.memory.items["mail"]) is None
    assert load.as_remembered() == "lighter"


def test_what_an_empty_basket_shows_counts_for_nothing() -> None:
    scales = Scales()
    scales.shows_kg = 0.3
    assert LoadSense(scales).given() == "nothing"


def test_what_is_missing_is_felt_until_it_is_back() -> None:
    scales, load = sense()
    scales.shows_kg += 0.5
    scales.memory.note_given("mail", scales.load_kg())
    assert load.as_remembered() is None
    scales.shows_kg -= 0.5
    assert load.as_remembered() == "lighter"


def test_it_remembers_what_it_has_and_where_it_handed_things_over() -> None:
    memory = BasketMemory(expected_kg=0.0)
    memory.note_given("mail", 0.5)
    memory.note_given("keys", 0.8)
    memory.note_taken("mail", "F1-101", 0.3)
    assert memory.items == {"keys": pytest.approx(0.3)}
    assert memory.handed_over == {"mail": "F1-101"}
    memory.note_given("mail", 0.8)
    assert memory.handed_over == {}


def test_what_was_taken_out_for_another_robot_is_not_missed() -> None:
    scales, load = sense()
    for item, weighs_kg in (("mail", 0.5), ("keys", 0.2)):
        scales.shows_kg += weighs_kg
        scales.memory.note_given(item, scales.load_kg())
    scales.memory.offered = ("mail", "office")
    scales.shows_kg -= 0.5
    assert load.as_remembered() == "lighter"
    scales.memory.forget("mail")
    scales.memory.forget("nothing of the kind")
    assert load.as_remembered() is None
    assert scales.memory.offered is None
    assert [*scales.memory.items] == ["keys"]
    scales.shows_kg -= 0.2
    assert load.as_remembered() == "lighter"


def test_what_is_forgotten_before_the_first_look_at_the_load_cell_is_forgotten() -> None:
    memory = BasketMemory()
    memory.forget("mail")
    assert memory == BasketMemory()
