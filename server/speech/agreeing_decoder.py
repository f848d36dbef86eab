"""Two recognizers that err differently: what both hear is sooner believed than what one hears.

A vote of recognizers, as ROVER takes it over words (Fiscus 1997), here over whole commands.
"""

import math
from dataclasses import replace

from mend.server.speech.decoding import Decoder, Hypothesis
from mend.server.speech.meaning import meaning_of
from mend.server.speech.speech_model import Transcriber
from mend.server.speech.vocabulary import Vocabulary

ALONE_MARGIN = 0.02
"""So much surer the decoder has to be of a command where the text is none.

Set with the tuned voices and phrases of `benchmarks/speech.py`, as is:"""
ALONE_WORDS = 2
"""So many words a text needs that is a command to which the decoder hears no other: noise and
breath are written down as short words now and then."""


class AgreeingDecoder:
    """Implements `Decoder`: one that listens for commands, and a transcriber that knows of none."""

    def __init__(
        self,
        decoder: Decoder,
        transcriber: Transcriber,
        vocabulary: Vocabulary = Vocabulary.ANSWER,
    ) -> None:
        self._decoder = decoder
        self._transcriber = transcriber
        self._vocabulary = vocabulary
        self._taken: list[bytes] = []

    def begin(self) -> None:
        self._taken = []
        self._decoder.begin()

    def take(self, sound: bytes) -> None:
        self._taken.append(sound)
        self._decoder.take(sound)

    def end(self) -> Hypothesis:
        heard = self._decoder.end()
        text = self._transcriber.text_of(b"".join(self._taken))
        self._taken = []
        command, phrase = meaning_of(text, self._vocabulary)
        if command is None:
            return replace(heard, margin=heard.margin - ALONE_MARGIN)
        if heard.command not in (None, command):
            return Hypothesis(text)
        if heard.command is None and len(text.split()) < ALONE_WORDS:
            return Hypothesis(text)
        return Hypothesis(text, command, phrase, math.inf)
