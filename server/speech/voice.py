"""The robot's voice: a port, and the engines that stand behind it."""

import asyncio
import io
import shutil
import sys
import wave
from asyncio.subprocess import DEVNULL, PIPE
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Literal, Protocol

from mend.errors import MendError

RENDER_TIMEOUT_S = 20.0

VoiceChoice = Literal["auto", "flite", "espeak-ng", "piper", "none"]


class VoiceError(MendError):
    """The voice could not say a text; the message is one sentence."""


class Voice(Protocol):
    """Turns text into sound."""

    @property
    def engine(self) -> str:
        """What it is, for people."""
        ...

    async def render(self, text: str) -> bytes:
        """A text as a WAV file. Raises `VoiceError`."""
        ...


@dataclass(frozen=True, slots=True)
class CommandVoice:
    """A voice that is a program: it reads a text on its standard input and writes a WAV file.

    `arguments` is given the file that it writes.
    """

    engine: str
    program: str
    arguments: Callable[[str], Sequence[str]]

    async def render(self, text: str) -> bytes:
        try:
            # Without descriptors not even a folder can be removed.
            with TemporaryDirectory(prefix="mend-voice-", ignore_cleanup_errors=True) as folder:
                path = Path(folder) / "speech.wav"
                await self._run(text, self.arguments(str(path)))
                return _checked(path.read_bytes())
        except (OSError, EOFError, wave.Error) as error:
            raise VoiceError(f"{self.engine} wrote no sound: {error}") from error

    async def _run(self, text: str, arguments: Sequence[str]) -> None:
        try:
            process = await asyncio.create_subprocess_exec(
                self.program, *arguments, stdin=PIPE, stdout=DEVNULL, stderr=PIPE
            )
        except OSError as error:
            raise VoiceError(f"{self.engine} cannot be started: {error.strerror}") from error
        try:
            async with asyncio.timeout(RENDER_TIMEOUT_S):
                _, complaint = await process.communicate(text.encode())
        except TimeoutError:
            raise VoiceError(f"{self.engine} took longer than {RENDER_TIMEOUT_S:g} s") from None
        finally:
            if process.returncode is None:
                process.kill()
                await process.wait()
        if process.returncode != 0:
            said = complaint.decode(errors="replace").strip().splitlines() or ["nothing"]
            raise VoiceError(f"{self.engine} failed with {process.returncode}: {said[-1][:200]}")


@dataclass(frozen=True, slots=True)
class NoVoice:
    """There is no voice; `why_not` is one sentence about it."""

    why_not: str


def choose_voice(
    choice: VoiceChoice, *, flite_voice: str, piper_model: Path | None
) -> Voice | NoVoice:
    """The voice that the settings ask for, or the best that this machine has.

    A piper model that is given is preferred, then flite's recorded voices, then espeak-ng.
    """
    if choice == "none":
        return NoVoice("the setting 'speech_voice' is 'none'")
    makers: dict[str, Callable[[], Voice | NoVoice]] = {
        "piper": lambda: _piper(piper_model),
        "flite": lambda: _flite(flite_voice),
        "espeak-ng": _espeak,
    }
    if choice != "auto":
        return makers[choice]()
    if piper_model is None:
        del makers["piper"]
    found = [make() for make in makers.values()]
    for each in found:
        if not isinstance(each, NoVoice):
            return each
    return NoVoice("; ".join(each.why_not for each in found if isinstance(each, NoVoice)))


def _flite(voice: str) -> Voice | NoVoice:
    program = shutil.which("flite")
    if program is None:
        return NoVoice("flite is not installed")
    return CommandVoice(
        "flite", program, lambda path: ("-voice", voice, "-f", "/dev/stdin", "-o", path)
    )


def _espeak() -> Voice | NoVoice:
    program = shutil.which("espeak-ng")
    if program is None:
        return NoVoice("espeak-ng is not installed")
    return CommandVoice("espeak-ng", program, lambda path: ("-v", "en", "--stdin", "-w", path))


def _piper(model: Path | None) -> Voice | NoVoice:
    if model is None:
        return NoVoice("piper needs a voice file: set 'speech_piper_model'")
    if not model.is_file():
        return NoVoice(f"there is no piper voice file {model}")
    wanted = ("--model", str(model), "--output_file")
    # Debian's `piper` configures gaming mice, so the module is looked for first.
    if find_spec("piper") is not None:
        return CommandVoice("piper", sys.executable, lambda path: ("-m", "piper", *wanted, path))
    program = shutil.which("piper")
    if program is None:
        return NoVoice("piper is not installed")
    return CommandVoice("piper", program, lambda path: (*wanted, path))


def _checked(sound: bytes) -> bytes:
    """A WAV file whose header says how long it is, which those of some engines do not."""
    with wave.open(io.BytesIO(sound)) as read:
        parameters, frames = read.getparams(), read.readframes(read.getnframes())
    if not frames:
        raise wave.Error("the file is empty")
    written = io.BytesIO()
    with wave.open(written, "wb") as write:
        write.setparams(parameters._replace(nframes=0))
        write.writeframes(frames)
    return written.getvalue()
