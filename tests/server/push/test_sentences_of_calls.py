"""What a call tells of how its text is made, so that a device may say it in another language."""

from mend.server.journal.events import WordedSentence, Wording
from mend.server.push.messages import MOST_BYTES_OF_SENTENCES, sentences_with_room

SENTENCES = [WordedSentence(key="I missed the {object}.", args={"object": "cup"})]
WORDINGS = [
    Wording(text="Put it back", sentences=[WordedSentence(key="put {it} back")]),
    Wording(text="I missed the cup.", sentences=SENTENCES),
]


def test_it_is_that_of_the_text_that_is_shown() -> None:
    assert sentences_with_room("I missed the cup.", WORDINGS) == SENTENCES


def test_a_text_of_which_nothing_is_told_goes_alone() -> None:
    assert sentences_with_room("It squeaks.", WORDINGS) == []
    assert sentences_with_room("It squeaks.", []) == []


def test_what_has_no_room_in_a_message_is_left_out() -> None:
    text = "ü" * MOST_BYTES_OF_SENTENCES
    assert sentences_with_room(text, [Wording(text=text, sentences=SENTENCES)]) == []
