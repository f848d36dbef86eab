"""Whoever has misspelt a name reads the ones that it may have been."""

from mend.documents.near_names import names_near

NAMES = ["F1/kitchen", "F1/101", "F2/kitchen", "hall"]


def test_those_near_in_spelling_are_told_the_nearest_first() -> None:
    assert names_near("F1/kichen", NAMES) == "'F1/kitchen', 'F2/kitchen'"


def test_capitals_make_no_other_name() -> None:
    assert names_near("HALL", NAMES) == "'hall'"


def test_where_none_is_near_all_are_told() -> None:
    assert names_near("xyz", NAMES) == "'F1/101', 'F1/kitchen', 'F2/kitchen', 'hall'"
    assert names_near("xyz", [f"room{n}" for n in range(50)]).endswith("(50 in all)")
