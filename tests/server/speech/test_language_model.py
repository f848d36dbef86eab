"""The dictionary and language model: whole, sound, and never in doubt about a phrase's command."""

from collections import Counter
from pathlib import Path

import pytest

from mend.server.speech.commands import Command
from mend.server.speech.language_model import Weights, command_in, write_language_model
from mend.server.speech.vocabulary import AMBIGUOUS_OF, PHRASES_OF, Vocabulary, phrase_commands

WORDS = {
    word
    for vocabulary in Vocabulary
    for each in (*phrase_commands(vocabulary), *AMBIGUOUS_OF[vocabulary])
    for word in each.split()
}


@pytest.fixture(params=Vocabulary)
def vocabulary(request: pytest.FixtureRequest) -> Vocabulary:
    return Vocabulary(request.param)


@pytest.fixture
def files(tmp_path: Path, vocabulary: Vocabulary) -> tuple[list[str], list[str]]:
    """The lines of a dictionary and a language model; how the words sound does not matter."""
    dictionary = tmp_path / "words.dict"
    common = Path(write_language_model.__code__.co_filename).with_name("common_words.txt")
    words = {*WORDS, *(line.split()[0] for line in common.read_text().splitlines())}
    dictionary.write_text("".join(f"{word} AH\n{word}(2) EH\n" for word in sorted(words)))
    written = write_language_model(tmp_path, dictionary, Weights(competitors=50), vocabulary)
    first, second = (path.read_text().splitlines() for path in written)
    return first, second


def test_no_phrase_means_two_things(vocabulary: Vocabulary) -> None:
    phrases = [phrase for each in PHRASES_OF[vocabulary].values() for phrase in each]
    assert Counter([*phrases, *AMBIGUOUS_OF[vocabulary]]).most_common(1)[0][1] == 1


def test_every_phrase_is_one_word_of_the_dictionary(
    files: tuple[list[str], list[str]], vocabulary: Vocabulary
) -> None:
    words = [line.split()[0] for line in files[0]]
    assert len(set(words)) == len(words)
    assert {"c_" + phrase.replace(" ", "_") for phrase in phrase_commands(vocabulary)} <= set(words)
    assert {"x_" + phrase.replace(" ", "_") for phrase in AMBIGUOUS_OF[vocabulary]} <= set(words)


def test_the_model_has_as_many_ngrams_as_it_says(files: tuple[list[str], list[str]]) -> None:
    lines = files[1]
    first, second = lines.index("\\1-grams:"), lines.index("\\2-grams:")
    assert f"ngram 1={second - first - 2}" in lines
    assert f"ngram 2={lines.index(chr(92) + 'end' + chr(92)) - second - 2}" in lines


def test_what_is_said_of_a_promise_is_no_answer_and_the_other_way_round() -> None:
    assert command_in("c_done", Vocabulary.PROMISE) == (Command.DONE, "done")
    assert command_in("c_i_can't", Vocabulary.PROMISE) == (Command.CANNOT, "i can't")
    meant = set(phrase_commands(Vocabulary.PROMISE).values())
    assert meant.isdisjoint({Command.YES, Command.NO})
    assert {Command.DONE, Command.CANNOT}.isdisjoint(phrase_commands().values())


def test_ways_of_help_are_chosen_only_where_there_are_some() -> None:
    assert command_in("c_i'll_place_it_myself", Vocabulary.WAYS) == (
        Command.PLACE,
        "i'll place it myself",
    )
    assert command_in("c_not_now", Vocabulary.WAYS) == (Command.NOT_NOW, "not now")
    assert command_in("c_not_now") == (Command.NO, "not now")
    assert {Command.PLACE, Command.LEAVE_OUT, Command.NOT_NOW}.isdisjoint(
        phrase_commands().values()
    )


@pytest.mark.parametrize(
    ("hypothesis", "heard"),
    [
        ("c_yes_please", (Command.YES, "yes please")),
        ("c_yes_please(3)", (Command.YES, "yes please")),
        ("c_no c_no_thanks", (Command.NO, "no no thanks")),
        ("c_yes c_no", None),
        ("c_yes the", None),
        ("x_maybe", None),
        ("the weather", None),
        ("", None),
    ],
)
def test_only_a_whole_utterance_of_one_command_counts(
    hypothesis: str, heard: tuple[Command, str] | None
) -> None:
    assert command_in(hypothesis) == heard
