"""Names and counts as people say them."""

import pytest
from languages_of_console import untold

from mend.dialogue.spoken import called, count_of, spoken
from mend.dialogue.worded import sentences_of


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("robot2-0afba7d8", "robot2"),
        ("robot_2", "robot 2"),
        ("robot2-0afba7d8 has failed, and stands there", "robot2 has failed, and stands there"),
        ("the deadbeef-12", "the deadbeef 12"),
    ],
)
def test_robots_of_a_site_are_called_by_the_names_of_their_scene(name: str, said: str) -> None:
    assert called(name) == said


def test_what_people_have_only_pointed_at_is_spoken_of_in_words_of_each_language() -> None:
    nameless = spoken("thing_to_be_brought--0afba7d8")
    assert nameless == "thing to be brought"
    assert [each.key for each in sentences_of(nameless)] == ["thing to be brought"]


def test_where_a_nameless_thing_is_fetched_is_said_within_a_sentence_too() -> None:
    name = "thing_to_be_brought-AHGM_n8--8cdc1683"
    assert spoken(name) == "thing to be brought from AHGM n8"
    told = called(f"I have come to AHGM-n8 to collect the {name}")
    assert told == "I have come to AHGM n8 to collect the thing to be brought from AHGM n8"
    assert untold([told]) == []


def test_identifiers_are_said_as_words() -> None:
    assert spoken("sugar_bowl") == "sugar bowl"
    assert spoken("part-12345678") == "part 12345678"
    assert spoken("a cup_of_tea--0afba7d8, please") == "a cup of tea, please"
    assert [count_of(each) for each in (0, 1, 2, 3, 12)] == [
        "never",
        "once",
        "twice",
        "three times",
        "12 times",
    ]
