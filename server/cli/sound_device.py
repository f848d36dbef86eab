"""A terminal's loudspeaker and microphone."""

import asyncio
import io
import wave
from collections.abc import AsyncIterator
from types import ModuleType
from typing import Any, Protocol

from mend.server.cli.failures import CommandLineError

SAMPLE_RATE_HZ = 16_000
FRAME_SAMPLES = 320
WAITING_FRAMES = 250
"""Five seconds: what nobody takes by then is dropped."""
GAP = b""
"""Instead of a frame: sound is missing here."""


class SoundDevice(Protocol):
    """What a helper hears with and speaks into."""

    async def play(self, wav: bytes) -> None:
        """Play a WAV file; returns at its end."""
        ...

    def microphone(self) -> AsyncIterator[bytes]:
        """Sound as it comes: PCM16, mono, 16 kHz; an empty frame where some is missing."""
        ...


class WaitingSound:
    """What a microphone gave and nobody has taken yet; where that is too much, a gap."""

    def __init__(self) -> None:
        self._frames: asyncio.Queue[bytes] = asyncio.Queue()

    def keep(self, frame: bytes) -> None:
        """Put a frame, or a gap, behind the others."""
        waiting = self._frames.qsize()
        if waiting <= WAITING_FRAMES:
            self._frames.put_nowait(frame if waiting < WAITING_FRAMES else GAP)

    async def take(self) -> bytes:
        """The next frame, or a gap, once there is one."""
        return await self._frames.get()


class PortAudioDevice:
    """The default devices of this machine, or those of one name or number.

    Raises `CommandLineError` where there are none.
    """

    def __init__(self, device: str | None = None) -> None:
        self._audio = _sounddevice()
        self._device: str | int | None = (
            int(device) if device is not None and device.isdigit() else device
        )
        try:
            for kind in ("input", "output"):
                self._audio.query_devices(self._device, kind)
        except (ValueError, self._audio.PortAudioError) as error:
            raise CommandLineError(
                f"no sound device can be used here ({error}); "
                "answer in the console, or name another one with --device"
            ) from error

    async def play(self, wav: bytes) -> None:
        with wave.open(io.BytesIO(wav)) as sound:
            rate_hz, channels = sound.getframerate(), sound.getnchannels()
            frames = sound.readframes(sound.getnframes())
        await asyncio.to_thread(self._play, frames, rate_hz, channels)

    def _play(self, frames: bytes, rate_hz: int, channels: int) -> None:
        with (
            self._told_plainly(),
            self._audio.RawOutputStream(
                samplerate=rate_hz, channels=channels, dtype="int16", device=self._device
            ) as stream,
        ):
            stream.write(frames)

    async def microphone(self) -> AsyncIterator[bytes]:
        loop = asyncio.get_running_loop()
        waiting = WaitingSound()

        def came(data: Any, _frames: int, _time: Any, status: Any) -> None:
            if status.input_overflow:
                loop.call_soon_threadsafe(waiting.keep, GAP)
            loop.call_soon_threadsafe(waiting.keep, bytes(data))

        with (
            self._told_plainly(),
            self._audio.RawInputStream(
                samplerate=SAMPLE_RATE_HZ,
                channels=1,
                dtype="int16",
                blocksize=FRAME_SAMPLES,
                device=self._device,
                callback=came,
            ),
        ):
            while True:
                yield await waiting.take()

    def _told_plainly(self) -> "_ToldPlainly":
        return _ToldPlainly(self._audio.PortAudioError)


class _ToldPlainly:
    """Turns PortAudio's complaints into sentences."""

    def __init__(self, complaint: type[Exception]) -> None:
        self._complaint = complaint

    def __enter__(self) -> None:
        pass

    def __exit__(self, _kind: object, error: BaseException | None, _trace: object) -> None:
        if isinstance(error, self._complaint):
            raise CommandLineError(f"the sound device failed: {error}") from error


def _sounddevice() -> ModuleType:
    try:
        import sounddevice
    except ImportError as error:
        raise CommandLineError(
            "sounddevice is not installed: pip install 'mend-robots[talk]'"
        ) from error
    except OSError as error:
        # The package is there, but the library that it wraps is not.
        raise CommandLineError(
            "PortAudio is not installed (on Debian: apt-get install libportaudio2); "
            "answer in the console instead"
        ) from error
    module: ModuleType = sounddevice
    return module
