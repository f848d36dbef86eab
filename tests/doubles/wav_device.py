"""A loudspeaker and a microphone without hardware: what is played is kept, a word is said."""

import asyncio
import io
import wave
from collections.abc import AsyncIterator

import numpy as np
from scipy.signal import resample_poly

FRAME_BYTES = 640
FRAME_S = 0.02


class WavDevice:
    """Implements `server.cli.sound_device.SoundDevice`; says its WAV file again and again."""

    def __init__(self, says: bytes, pause_s: float = 1.5) -> None:
        self._sound = bytes(16_000) + pcm_of(says) + bytes(int(pause_s * 32_000))
        self.played: list[bytes] = []

    async def play(self, wav: bytes) -> None:
        self.played.append(wav)

    async def microphone(self) -> AsyncIterator[bytes]:
        # At the pace of a real one: the service drops what comes while it does not listen.
        while True:
            for start in range(0, len(self._sound) - FRAME_BYTES, FRAME_BYTES):
                yield self._sound[start : start + FRAME_BYTES]
                await asyncio.sleep(FRAME_S)


def pcm_of(wav: bytes) -> bytes:
    """The samples of a WAV file as a microphone would send them."""
    with wave.open(io.BytesIO(wav)) as sound:
        rate_hz = sound.getframerate()
        samples = np.frombuffer(sound.readframes(sound.getnframes()), np.int16)
    resampled = resample_poly(samples.astype(float), 16_000, rate_hz)
    return np.clip(resampled, -32768, 32767).astype(np.int16).tobytes()
