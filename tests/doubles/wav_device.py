"""A loudspeaker and a microphone without hardware: what is played is kept, a word is said."""

import asyncio
import io
import wave
from collections.abc import AsyncIterator

import numpy as np

FRAME_BYTES = 640
FRAME_S = 0.02
HESITATION_BYTES = 16_000


class WavDevice:
    """Implements `server.cli.sound_device.SoundDevice`; says its WAV file when it is listened to.

    `tell` is what the helper tells its person: that person waits, as one does, to be listened to.
    """

    def __init__(self, says: bytes) -> None:
        self._words = bytes(HESITATION_BYTES) + pcm_of(says)
        self._unsaid = b""
        self.played: list[bytes] = []
        self.told: list[str] = []

    def tell(self, line: str) -> None:
        self.told.append(line)
        if line == "(listening)":
            self._unsaid = self._words

    async def play(self, wav: bytes) -> None:
        self.played.append(wav)

    async def microphone(self) -> AsyncIterator[bytes]:
        # At the pace of a real one: the service drops what comes while it does not listen.
        while True:
            said, self._unsaid = self._unsaid[:FRAME_BYTES], self._unsaid[FRAME_BYTES:]
            yield said.ljust(FRAME_BYTES, b"\0")
            await asyncio.sleep(FRAME_S)


def pcm_of(wav: bytes) -> bytes:
    """The samples of a WAV file as a microphone would send them."""
    # Takes long to import, and hardly any process that collects the tests needs it.
    from scipy.signal import resample_poly

    with wave.open(io.BytesIO(wav)) as sound:
        rate_hz = sound.getframerate()
        samples = np.frombuffer(sound.readframes(sound.getnframes()), np.int16)
    resampled = resample_poly(samples.astype(float), 16_000, rate_hz)
    return np.clip(resampled, -32768, 32767).astype(np.int16).tobytes()
