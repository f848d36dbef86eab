"""What people say of leaves: which words take one, which give one back, and which do neither."""

import pytest

from mend.errors import WrongInputError
from mend.server.runtime.leaf_words import LeafDeed, Said, understood


@pytest.mark.parametrize(
    "words",
    ["I do the saucer", "i'll do the saucer", "I’ll do the saucer!", "  I will do the  Saucer. "],
)
def test_these_take_it(words: str) -> None:
    assert understood(words) == Said(LeafDeed.TAKE, "saucer")


@pytest.mark.parametrize(
    "words",
    [
        "I give the saucer back",
        "I'll give the saucer back.",
        "I don't do the saucer",
        "I do not do the saucer",
    ],
)
def test_these_give_it_back(words: str) -> None:
    assert understood(words) == Said(LeafDeed.GIVE_BACK, "saucer")


@pytest.mark.parametrize(
    "words", ["", "I do ", "saucer", "the robot does the saucer", "I give back"]
)
def test_of_others_it_is_said_what_would_be_right(words: str) -> None:
    with pytest.raises(WrongInputError, match=r"say 'I do the \.\.\.'"):
        understood(words)
