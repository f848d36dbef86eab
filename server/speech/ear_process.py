"""The child process of an ear: sound on standard input, one JSON line per report on the output.

It serves one conversation after the other; only the decoder, which keeps nothing, goes on.
"""

import os
import signal
import sys
import time
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import BinaryIO

from mend.server.speech.beam_search import GreedyTranscriber
from mend.server.speech.decoding import Decoder
from mend.server.speech.ear import AFRESH, BREAK, GAP, HEADER, EarReport
from mend.server.speech.fused_decoder import FusedDecoder
from mend.server.speech.moonshine import Moonshine
from mend.server.speech.recognizer import Heard, Recognizer, SpeechBegan
from mend.server.speech.speech_model import find_speech_model
from mend.server.speech.sphinx_decoder import SphinxDecoder
from mend.server.speech.vocabulary import SpokenLanguage, Vocabulary
from mend.server.speech.written_decoder import WrittenDecoder
from mend.server.speech.written_evidence import WrittenEvidence

_VOCABULARIES = {code: vocabulary for vocabulary, code in AFRESH.items()}


def main() -> None:
    """Listen until the input ends."""
    # Ctrl-C at a terminal reaches the whole group; the service decides when this ends.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    sound, reports = sys.stdin.buffer, os.fdopen(os.dup(1), "wb", buffering=0)
    # Whatever a library prints must not come between the reports.
    os.dup2(2, 1)
    vocabulary: Vocabulary | None = Vocabulary(sys.argv[1])
    decoder_of = cache(_with_model(*sys.argv[2:]) if len(sys.argv) > 2 else SphinxDecoder)
    while vocabulary is not None:
        vocabulary = _converse(Recognizer(decoder_of(vocabulary)), sound, reports)


def _with_model(folder: str, language: str) -> Callable[[Vocabulary], Decoder]:
    """Decoders with an operator's speech model, which is read once and alone hears German."""
    moonshine = Moonshine(find_speech_model(Path(folder)))

    def decoder_of(vocabulary: Vocabulary) -> Decoder:
        if language == SpokenLanguage.GERMAN:
            return WrittenDecoder(GreedyTranscriber(moonshine), vocabulary)
        return FusedDecoder(SphinxDecoder(vocabulary), WrittenEvidence(moonshine, vocabulary))

    return decoder_of


def _converse(recognizer: Recognizer, sound: BinaryIO, reports: BinaryIO) -> Vocabulary | None:
    """Listen to one conversation; the vocabulary of the next, None if there is none."""
    _tell(reports, EarReport(kind="ready"))
    interruptions = 0
    while header := sound.read(HEADER.size):
        came_s, size = HEADER.unpack(header)
        if size in _VOCABULARIES:
            return _VOCABULARIES[size]
        if size == BREAK:
            recognizer.interrupt()
            interruptions += 1
        elif size == GAP:
            recognizer.skip()
        else:
            for heard in recognizer.feed(sound.read(size)):
                _tell(reports, report_of(heard, time.monotonic() - came_s, interruptions))
    return None


def report_of(heard: Heard, since_sound_s: float, interruptions: int) -> EarReport:
    """What a recognizer heard, `since_sound_s` after the sound that ended it came."""
    if isinstance(heard, SpeechBegan):
        return EarReport(kind="began", interruptions=interruptions)
    return EarReport(
        kind="utterance",
        command=heard.command,
        phrase=heard.phrase,
        words=heard.words,
        latency_s=heard.hangover_s + since_sound_s,
        interruptions=interruptions,
    )


def _tell(reports: BinaryIO, report: EarReport) -> None:
    reports.write(report.model_dump_json().encode() + b"\n")


if __name__ == "__main__":
    main()
