"""An operator's own speech model: a folder of Moonshine's files, and the transcriber that reads it.

Moonshine (Jeffries et al. 2024) is run by sherpa-onnx, on this machine.
"""

import base64
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Protocol

import numpy as np

from mend.errors import WrongInputError

RATE_HZ = 16_000
_SUFFIXES = (".ort", ".onnx")
_ENCODER, _DECODER = "encoder_model", "decoder_model_merged"
_TOKENS, _TOKENIZER = "tokens.txt", "tokenizer.bin"


class SpeechModelError(WrongInputError):
    """A folder is no speech model that can be used here; the message is one sentence."""


class Transcriber(Protocol):
    """What writes down what is said."""

    def text_of(self, sound: bytes) -> str:
        """The text of an utterance (PCM16, mono, 16 kHz); empty where there is none."""
        ...


@dataclass(frozen=True, slots=True)
class SpeechModel:
    """The files of a model; `tokens` is a list (`tokens.txt`) or Moonshine's `tokenizer.bin`."""

    encoder: Path
    decoder: Path
    tokens: Path


def find_speech_model(folder: Path) -> SpeechModel:
    """The model in a folder. Raises `SpeechModelError` if it cannot be used."""
    if find_spec("sherpa_onnx") is None:
        raise SpeechModelError(
            "sherpa-onnx is not installed: pip install 'mend-robots[speech-model]'"
        )
    if not folder.is_dir():
        raise SpeechModelError(f"there is no folder {folder} with a speech model")
    return SpeechModel(
        _one_of(folder, [_ENCODER + each for each in _SUFFIXES]),
        _one_of(folder, [_DECODER + each for each in _SUFFIXES]),
        _one_of(folder, [_TOKENS, _TOKENIZER]),
    )


class SherpaTranscriber:
    """A Moonshine model in sherpa-onnx, on one core.

    Raises `SpeechModelError` if its files cannot be read.
    """

    def __init__(self, model: SpeechModel) -> None:
        from sherpa_onnx import OfflineRecognizer

        with TemporaryDirectory(prefix="mend-speech-") as folder:
            tokens = _listed(model.tokens, Path(folder))
            try:
                self._recognizer = OfflineRecognizer.from_moonshine_v2(
                    encoder=str(model.encoder), decoder=str(model.decoder), tokens=str(tokens)
                )
            except RuntimeError as error:
                reason = str(error).strip().splitlines()[0]
                raise SpeechModelError(
                    f"the speech model in {model.encoder.parent} cannot be read: {reason}"
                ) from error

    def text_of(self, sound: bytes) -> str:
        stream = self._recognizer.create_stream()
        samples = np.frombuffer(sound, np.int16).astype(np.float32) / 32768.0
        stream.accept_waveform(RATE_HZ, samples)
        self._recognizer.decode_stream(stream)
        return str(stream.result.text)


def _one_of(folder: Path, names: list[str]) -> Path:
    for name in names:
        if (folder / name).is_file():
            return folder / name
    raise SpeechModelError(f"the speech model in {folder} has no {' or '.join(names)}")


def _listed(tokens: Path, folder: Path) -> Path:
    """The tokens as the list that sherpa-onnx reads, written to `folder` if need be."""
    if tokens.name == _TOKENS:
        return tokens
    lines = [
        f"{base64.b64encode(token).decode()} {number}\n"
        for number, token in enumerate(_tokens_in(tokens))
    ]
    listed = folder / _TOKENS
    listed.write_text("".join(lines), "utf-8")
    return listed


def _tokens_in(tokenizer: Path) -> Iterator[bytes]:
    """Each token after its length: one byte, or from 128 on two, of which the first is the rest.

    Raises `SpeechModelError` where the file ends within a token.
    """
    content, at = tokenizer.read_bytes(), 0
    while at < len(content):
        length, head = content[at], 1
        if length >= 128 and at + 1 < len(content):
            length, head = length - 128 + 128 * content[at + 1], 2
        at += head + length
        if at > len(content):
            raise SpeechModelError(f"{tokenizer} ends within a token")
        yield content[at - length : at]
