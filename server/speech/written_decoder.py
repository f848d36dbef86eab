"""What a transcriber alone makes of an utterance, in German, which PocketSphinx does not know."""

import math

from mend.server.speech.beam_search import Transcriber
from mend.server.speech.decoding import Hypothesis
from mend.server.speech.german import meaning_in_german
from mend.server.speech.vocabulary import Vocabulary


class WrittenDecoder:
    """Implements `Decoder`: what is written down counts as German, and only as a whole phrase."""

    def __init__(
        self, transcriber: Transcriber, vocabulary: Vocabulary = Vocabulary.ANSWER
    ) -> None:
        self._transcriber = transcriber
        self._vocabulary = vocabulary
        self._taken: list[bytes] = []

    def begin(self) -> None:
        self._taken = []

    def take(self, sound: bytes) -> None:
        self._taken.append(sound)

    def end(self) -> Hypothesis:
        text = self._transcriber.text_of(b"".join(self._taken))
        self._taken = []
        command, phrase = meaning_in_german(text, self._vocabulary)
        return Hypothesis(text, command, phrase, 0.0 if command is None else math.inf)
