"""A Moonshine model (Jeffries et al. 2024): how probable each next token of a text is.

It is run by ONNX Runtime on this machine, on one core.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol, Self

import numpy as np
import numpy.typing as npt

from mend.server.speech.speech_model import (
    SpeechModel,
    SpeechModelError,
    Tokens,
    read_tokens,
)

BEGIN, END = 1, 2
"""The tokens before a text and after it."""

Logs = npt.NDArray[np.float32]


class Texts(Protocol):
    """Several texts of one utterance that are being written, each as far as it goes."""

    @property
    def next_logs(self) -> Logs:
        """The logarithm of how probable each token is as the next: texts by tokens."""
        ...

    def grown(self, rows: Sequence[int], tokens: Sequence[int]) -> Self:
        """For each of `rows`, the text in that row with one more token."""
        ...


class TokenModel(Protocol):
    """What knows how probable a text is, given the sound of it."""

    @property
    def tokens(self) -> Tokens: ...

    def begin(self, sound: bytes) -> Texts:
        """The empty text of an utterance (PCM16, mono, 16 kHz)."""
        ...


class Moonshine:
    """Implements `TokenModel`. Raises `SpeechModelError` if the model's files cannot be read."""

    def __init__(self, model: SpeechModel) -> None:
        from onnxruntime import InferenceSession, SessionOptions

        options = SessionOptions()
        options.intra_op_num_threads = options.inter_op_num_threads = 1
        self.tokens = read_tokens(model.tokens)
        try:
            self._encoder = InferenceSession(str(model.encoder), options)
            self.decoder = InferenceSession(str(model.decoder), options)
        # ONNX Runtime has an exception of its own for each reason.
        except Exception as error:
            reason = str(error).strip().splitlines()[0]
            raise SpeechModelError(
                f"the speech model in {model.encoder.parent} cannot be read: {reason}"
            ) from error
        self._past_shapes = {
            each.name: (1, each.shape[1], 0, each.shape[3])
            for each in self.decoder.get_inputs()
            if each.name.startswith("past_key_values")
        }

    def begin(self, sound: bytes) -> "MoonshineTexts":
        samples = np.frombuffer(sound, np.int16).astype(np.float32)[None] / 32768.0
        asked = {"input_values": samples, "attention_mask": np.ones(samples.shape, np.int64)}
        heard = self._encoder.run(None, asked)[0]
        past = {name: np.zeros(shape, np.float32) for name, shape in self._past_shapes.items()}
        return self.write(heard, past, [BEGIN], begun=False)

    def write(
        self,
        heard: npt.NDArray[np.float32],
        past: Mapping[str, npt.NDArray[np.float32]],
        tokens: Sequence[int],
        *,
        begun: bool,
    ) -> "MoonshineTexts":
        """One more token to each text; `past` is what the decoder keeps of each so far."""
        rows = np.repeat(heard, len(tokens), axis=0)
        scores, *kept = self.decoder.run(
            None,
            {
                "input_ids": np.array(tokens, np.int64)[:, None],
                "encoder_hidden_states": rows,
                "encoder_attention_mask": np.ones(rows.shape[:2], np.int64),
                "use_cache_branch": np.array([begun]),
                **past,
            },
        )
        # Of the sound it keeps the same from the first token on, and then gives it out no more.
        now = {
            name: past[name] if begun and ".encoder." in name else each
            for name, each in zip(self._past_shapes, kept, strict=True)
        }
        return MoonshineTexts(self, heard, now, _logs(scores[:, -1]))


@dataclass(frozen=True, slots=True)
class MoonshineTexts:
    """Implements `Texts`."""

    model: Moonshine
    heard: npt.NDArray[np.float32]
    past: Mapping[str, npt.NDArray[np.float32]]
    next_logs: Logs

    def grown(self, rows: Sequence[int], tokens: Sequence[int]) -> "MoonshineTexts":
        past = {name: each[list(rows)] for name, each in self.past.items()}
        return self.model.write(self.heard, past, tokens, begun=True)


def _logs(scores: npt.NDArray[np.float32]) -> Logs:
    scores = scores - scores.max(axis=1, keepdims=True)
    logs: Logs = scores - np.log(np.exp(scores).sum(axis=1, keepdims=True))
    return logs
