"""An operator's own speech model: a folder of Moonshine's files, and the tokens that it writes."""

import base64
import binascii
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from mend.errors import WrongInputError

_SUFFIXES = (".ort", ".onnx")
_ENCODER, _DECODER = "encoder_model", "decoder_model_merged"
_TOKENS, _TOKENIZER = "tokens.txt", "tokenizer.bin"


class SpeechModelError(WrongInputError):
    """A folder is no speech model that can be used here; the message is one sentence."""


@dataclass(frozen=True, slots=True)
class SpeechModel:
    """The files of a model; `tokens` is a list (`tokens.txt`) or Moonshine's `tokenizer.bin`."""

    encoder: Path
    decoder: Path
    tokens: Path


def find_speech_model(folder: Path) -> SpeechModel:
    """The model in a folder. Raises `SpeechModelError` if it cannot be used."""
    if find_spec("onnxruntime") is None:
        raise SpeechModelError(
            "onnxruntime is not installed: pip install 'mend-robots[speech-model]'"
        )
    if not folder.is_dir():
        raise SpeechModelError(f"there is no folder {folder} with a speech model")
    return SpeechModel(
        _one_of(folder, [_ENCODER + each for each in _SUFFIXES]),
        _one_of(folder, [_DECODER + each for each in _SUFFIXES]),
        _one_of(folder, [_TOKENS, _TOKENIZER]),
    )


class Tokens:
    """The pieces of words that a model writes, each of which is a number to it.

    A piece that begins a word begins with the mark of SentencePiece (Kudo and Richardson 2018).
    """

    _WORD = "\N{LOWER ONE EIGHTH BLOCK}"

    def __init__(self, pieces: Sequence[bytes]) -> None:
        self._pieces = pieces
        # The last of equal ones: the first are single bytes, which other scripts are spelled with.
        self._numbers = {piece: number for number, piece in enumerate(pieces)}

    def __len__(self) -> int:
        return len(self._pieces)

    def text_of(self, numbers: Sequence[int]) -> str:
        """What tokens spell."""
        spelled = b"".join(self._pieces[each] for each in numbers)
        return spelled.decode("utf-8", "replace").replace(self._WORD, " ").strip()

    def spelling_of(self, text: str) -> tuple[int, ...]:
        """The tokens of a text, merged in the order that they were learned in, which is that of
        their numbers. Raises `SpeechModelError` for a letter that is none.
        """
        letters = self._WORD + text.replace(" ", self._WORD)
        parts = [each.encode() for each in letters]
        while pairs := [
            (self._numbers[pair], at)
            for at in range(len(parts) - 1)
            if (pair := parts[at] + parts[at + 1]) in self._numbers
        ]:
            _, at = min(pairs)
            parts[at : at + 2] = [parts[at] + parts[at + 1]]
        return tuple(self.number_of(each) for each in parts)

    def number_of(self, piece: bytes) -> int:
        """Raises `SpeechModelError` where the model has no such token."""
        if piece not in self._numbers:
            raise SpeechModelError(f"the speech model has no token {piece.decode()!r}")
        return self._numbers[piece]


def read_tokens(path: Path) -> Tokens:
    """The tokens of a model. Raises `SpeechModelError` where the file cannot be read."""
    return Tokens(_listed_in(path) if path.name == _TOKENS else [*_tokens_in(path)])


def _one_of(folder: Path, names: list[str]) -> Path:
    for name in names:
        if (folder / name).is_file():
            return folder / name
    raise SpeechModelError(f"the speech model in {folder} has no {' or '.join(names)}")


def _listed_in(tokens: Path) -> list[bytes]:
    """Each line is a token in base64 and its number."""
    found: dict[int, bytes] = {}
    for count, line in enumerate(tokens.read_bytes().splitlines(), 1):
        token, _, number = line.rpartition(b" ")
        try:
            found[int(number)] = base64.b64decode(token, validate=True)
        except (ValueError, binascii.Error):
            raise SpeechModelError(
                f"line {count} of {tokens} is not a token in base64 and its number"
            ) from None
    if sorted(found) != list(range(len(found))):
        raise SpeechModelError(f"{tokens} does not number its tokens from 0 on")
    return [found[number] for number in range(len(found))]


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
