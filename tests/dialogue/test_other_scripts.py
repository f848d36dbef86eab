"""Names have Latin letters only, and are said in those in which they were written."""

import pytest

from mend.dialogue.other_scripts import in_name
from mend.dialogue.spoken import spoken

MOST = 31
MARK = "--0afba7d8"


@pytest.mark.parametrize(
    "what",
    ["3 boxes", "12345678", "ключи", "синий ящик", "3 коробки", "한국어 상자", "箱", "हिन्दी किताब"],
)
def test_what_is_carried_is_said_as_it_was_written(what: str) -> None:
    name = in_name(what, MOST)
    assert name.isascii()
    assert name[0].isalpha()
    assert len(name) <= MOST
    assert spoken(name + MARK) == what
    assert spoken(f"I have the {name}-mine{MARK}.") == f"I have the {what} mine."


def test_of_what_is_long_whole_words_of_other_scripts_are_kept() -> None:
    assert spoken(in_name("очень длинное название для коробки", MOST)) == "очень длинное"


def test_latin_letters_stay_as_names_have_them() -> None:
    assert in_name("Schlüssel für 7002", MOST) == "Schlussel_fur_7002"
    assert in_name("…", MOST) == ""


def test_what_is_no_such_word_stays() -> None:
    assert spoken("xn--99999999999") == "xn--99999999999"
