"""The class language model: each command phrase is one word, the commonest words compete with it.

A phrase that is one word of the dictionary is heard whole or not at all; what else people say is
better explained by the competing words, and so it is not taken for a command.
"""

import itertools
import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from mend.server.speech.commands import Command
from mend.server.speech.vocabulary import AMBIGUOUS_OF, Vocabulary, phrase_commands

COMMON_WORDS = Path(__file__).with_name("common_words.txt")

COMMAND_MARK = "c_"
DECOY_MARK = "x_"

MAX_PRONUNCIATIONS = 12
"""Of one phrase: with every variant of every word a long one would have hundreds."""

MORE_PRONUNCIATIONS: Mapping[str, tuple[str, ...]] = {
    "yes": ("Y IH S", "Y EH S S", "Y AE S"),
    "yeah": ("Y EH AH", "Y EH", "Y AA"),
    "yep": ("Y AE P",),
    "no": ("N AO", "N AH W", "N UH"),
    "nope": ("N AO P",),
    "nah": ("N AA", "N AE"),
    "sure": ("SH AO R", "SH ER", "SH AO"),
    "okay": ("OW K EH", "AH K EY"),
    "don't": ("D OW N", "D AO N T"),
    "can't": ("K AA N T",),
    "stop": ("S T AO P", "S T AA B", "S T AA"),
    "help": ("HH EH P", "HH AE L P", "EH L P", "HH EH W P"),
    "please": ("P L IY S",),
    "thanks": ("TH AA NG K S", "F AE NG K S"),
    "thank": ("TH AA NG K", "F AE NG K"),
    "that": ("DH AA T",),
    "pardon": ("P AA D AH N",),
    "repeat": ("R IH P IY",),
    "what": ("W AO T",),
    "not": ("N AO T",),
    "course": ("K AO S",),
    "sorry": ("S AO R IY",),
    "more": ("M AO",),
    "jose": ("HH OW Z EY",),
    "halt": ("HH OW L T", "HH AA L T"),
    "pause": ("P AA Z",),
    "ask": ("AA S K",),
}
"""Besides the dictionary's: what other accents and careless speech make of the words."""


@dataclass(frozen=True, slots=True)
class Weights:
    """How probable commands are against everything else; set by `benchmarks/speech.py`."""

    command: float = 0.98
    """Of an utterance that is the shortest of phrases."""
    per_word: float = 0.15
    """Less probable by this for each further word of a phrase, whose sounds say more already."""
    decoy: float = 0.05
    competitors: int = 1000
    end: float = 0.3
    """That an utterance ends after a competing word."""


def write_language_model(
    folder: Path,
    dictionary: Path,
    weights: Weights | None = None,
    vocabulary: Vocabulary = Vocabulary.ANSWER,
) -> tuple[Path, Path]:
    """Write a dictionary and an ARPA bigram model to a folder; returns their paths.

    `dictionary` is the acoustic model's pronouncing dictionary.
    """
    chosen = weights or Weights()
    spoken = Pronunciations(dictionary)
    known = phrase_commands(vocabulary)
    competitors = _competitors(chosen.competitors, known)
    phrases = {COMMAND_MARK + name(each): each for each in known}
    decoys = {DECOY_MARK + name(each): each for each in AMBIGUOUS_OF[vocabulary]}
    dict_path, lm_path = folder / "commands.dict", folder / "commands.lm"
    lines = [
        line
        for word, phrase in (phrases | decoys | {each: each for each in competitors}).items()
        for line in _dictionary_lines(word, spoken.of_phrase(phrase))
    ]
    dict_path.write_text("\n".join(lines) + "\n")
    lm_path.write_text(_arpa(phrases, decoys, competitors, chosen))
    return dict_path, lm_path


def name(phrase: str) -> str:
    """A phrase as one word of a dictionary."""
    return phrase.replace(" ", "_")


def command_in(
    hypothesis: str, vocabulary: Vocabulary = Vocabulary.ANSWER
) -> tuple[Command, str] | None:
    """The command and phrase of an utterance, if it is nothing but that command."""
    words = [word.partition("(")[0] for word in hypothesis.split()]
    known = phrase_commands(vocabulary)
    phrases = [word[len(COMMAND_MARK) :].replace("_", " ") for word in words]
    if not words or not all(word.startswith(COMMAND_MARK) for word in words):
        return None
    commands = {known[phrase] for phrase in phrases}
    return (commands.pop(), " ".join(phrases)) if len(commands) == 1 else None


class Pronunciations:
    """How words sound, as sequences of the acoustic model's phones."""

    def __init__(self, dictionary: Path) -> None:
        self._of_word: dict[str, list[str]] = {}
        for line in dictionary.read_text().splitlines():
            word, _, phones = line.partition(" ")
            self._of_word.setdefault(word.partition("(")[0], []).append(phones.strip())
        for word, more in MORE_PRONUNCIATIONS.items():
            known = self._of_word.setdefault(word, [])
            known.extend(each for each in more if each not in known)

    def of_phrase(self, phrase: str) -> list[str]:
        """The ways to say a phrase. Raises `KeyError` for a word that is not known."""
        ways = itertools.product(*(self._of_word[word] for word in phrase.split()))
        return [" ".join(way) for way in itertools.islice(ways, MAX_PRONUNCIATIONS)]


def _competitors(count: int, phrases: Iterable[str]) -> dict[str, float]:
    """The commonest words but `phrases`, with their probabilities, which add up to 1."""
    single = {each for each in phrases if " " not in each}
    found: dict[str, float] = {}
    for line in COMMON_WORDS.read_text().splitlines():
        word, _, log10 = line.partition(" ")
        if word not in single:
            found[word] = 10 ** float(log10)
        if len(found) == count:
            break
    total = sum(found.values())
    return {word: each / total for word, each in found.items()}


def _dictionary_lines(word: str, ways: Iterable[str]) -> Iterator[str]:
    for number, phones in enumerate(ways, 1):
        yield f"{word} {phones}" if number == 1 else f"{word}({number}) {phones}"


def _arpa(
    phrases: Mapping[str, str],
    decoys: Mapping[str, str],
    competitors: Mapping[str, float],
    weights: Weights,
) -> str:
    inside = 1e-5
    """That a command or decoy comes later in an utterance."""
    unigrams = [
        f"{_log(weights.end)} </s>",
        f"-99.0000 <s> {_log(1 - weights.command)}",
        *(f"{_log(inside)} {word} {_log(0.02)}" for word in (*phrases, *decoys)),
        *(
            f"{_log((1 - weights.end) * probability)} {word} 0.0000"
            for word, probability in competitors.items()
        ),
    ]

    def first(phrase: str, share: float) -> str:
        return _log(share / len(phrases) * weights.per_word ** phrase.count(" "))

    bigrams = sorted(
        [
            *(f"{first(phrase, weights.command)} <s> {word}" for word, phrase in phrases.items()),
            *(f"{first(phrase, weights.decoy)} <s> {word}" for word, phrase in decoys.items()),
            *(f"{_log(0.98)} {word} </s>" for word in (*phrases, *decoys)),
        ],
        key=lambda line: line.split()[1:],
    )
    return "\n".join([
        "\\data\\", f"ngram 1={len(unigrams)}", f"ngram 2={len(bigrams)}", "",
        "\\1-grams:", *unigrams, "", "\\2-grams:", *bigrams, "", "\\end\\", "",
    ])  # fmt: skip


def _log(probability: float) -> str:
    return f"{math.log10(probability):.4f}"
