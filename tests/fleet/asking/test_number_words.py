"""Numbers as people say them."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mend.fleet.asking.number_words import in_digits, ordinal

BELOW_TWENTY = (
    "zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten",
    "eleven", "twelve", "thirteen", "fourteen", "fifteen", "sixteen", "seventeen", "eighteen",
    "nineteen",
)  # fmt: skip
TENS = (
    "", "ten", "twenty", "thirty", "forty", "fifty", "sixty", "seventy", "eighty", "ninety"
)  # fmt: skip


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("seven thousand two", "7002"),
        ("seven thousand and two", "7002"),
        ("seventy oh two", "7002"),
        ("three oh five", "305"),
        ("three zero five", "305"),
        ("three o five", "305"),
        ("one oh one", "101"),
        ("one hundred and one", "101"),
        ("two hundred three", "203"),
        ("three twelve", "312"),
        ("twelve fifteen", "1215"),
        ("twelve hundred five", "1205"),
        ("thirty two", "32"),
        ("3 oh 5", "305"),
        ("f two two oh three", "f 2203"),
        ("oh kitchen", "oh kitchen"),
        ("hall and lift", "hall and lift"),
        ("one and hall", "1 and hall"),
    ],
)
def test_numbers_are_written_in_digits(said: str, meant: str) -> None:
    assert " ".join(in_digits(said.split())) == meant


@given(st.integers(1, 99_999), st.booleans())
def test_every_cardinal_is_that_number(number: int, says_and: bool) -> None:
    assert in_digits(cardinal(number, says_and)) == [str(number)]


@given(st.text("0123456789", min_size=1, max_size=6))
def test_digits_said_one_by_one_are_those_digits(digits: str) -> None:
    assert in_digits([BELOW_TWENTY[int(each)] for each in digits]) == [digits]


@given(st.lists(st.text("abcdefghijklmnp", min_size=1), max_size=6))
def test_words_that_are_no_numbers_stay(words: list[str]) -> None:
    assert in_digits([f"x{each}" for each in words]) == [f"x{each}" for each in words]


def test_ordinals_are_read_in_words_and_digits() -> None:
    assert [ordinal(each) for each in ("first", "3rd", "tenth", "hall", "21st")] == [
        "1", "3", "10", None, "21",
    ]  # fmt: skip


def cardinal(number: int, says_and: bool) -> list[str]:
    """How a number below 100000 is said."""
    if number < 20:
        return [BELOW_TWENTY[number]]
    if number < 100:
        return [TENS[number // 10], *(cardinal(number % 10, False) if number % 10 else [])]
    for factor, name in ((1000, "thousand"), (100, "hundred")):
        if number >= factor:
            many, rest = divmod(number, factor)
            joined = ["and"] if says_and and 0 < rest < 100 else []
            return [
                *cardinal(many, False), name, *joined, *(cardinal(rest, says_and) if rest else [])
            ]  # fmt: skip
    raise AssertionError(number)
