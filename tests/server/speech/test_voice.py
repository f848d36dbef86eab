"""The robot's voice: which engine is taken, what it renders, and what is kept."""

import asyncio
import errno
import io
import os
import shutil
import sys
import tempfile
import wave
from pathlib import Path

import pytest
from scripted_ears import ToneVoice

from mend.server.speech.rendering import SpokenTexts
from mend.server.speech.voice import CommandVoice, NoVoice, VoiceChoice, VoiceError, choose_voice


def choose(choice: VoiceChoice = "auto", piper_model: Path | None = None) -> object:
    return choose_voice(choice, flite_voice="slt", piper_model=piper_model)


def program(folder: Path, name: str, script: str) -> None:
    """Put a program on a path of its own."""
    path = folder / name
    path.write_text(f"#!{sys.executable}\n{script}")
    path.chmod(0o755)


SPEAKS = """
import sys, wave
with wave.open(sys.argv[-1], "wb") as sound:
    sound.setparams((1, 2, 16000, 0, "NONE", ""))
    sound.writeframes(b"\\0\\1" * len(sys.stdin.read()))
"""


@pytest.fixture
def bin_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The only folder in which programs are looked for."""
    monkeypatch.setenv("PATH", str(tmp_path))
    return tmp_path


def test_without_a_program_there_is_no_voice_and_it_is_said_why(bin_folder: Path) -> None:
    del bin_folder
    found = choose()
    assert isinstance(found, NoVoice)
    assert found.why_not == "flite is not installed; espeak-ng is not installed"


def test_flite_is_preferred_to_espeak(bin_folder: Path) -> None:
    program(bin_folder, "espeak-ng", SPEAKS)
    assert getattr(choose(), "engine", None) == "espeak-ng"
    program(bin_folder, "flite", SPEAKS)
    assert getattr(choose(), "engine", None) == "flite"


def test_piper_is_taken_where_a_voice_file_is_given(bin_folder: Path) -> None:
    program(bin_folder, "flite", SPEAKS)
    program(bin_folder, "piper", SPEAKS)
    model = bin_folder / "voice.onnx"
    assert isinstance(choose("piper"), NoVoice)
    assert isinstance(choose("piper", model), NoVoice)
    model.touch()
    assert getattr(choose("auto", model), "engine", None) == "piper"


def test_no_voice_is_a_choice() -> None:
    assert isinstance(choose("none"), NoVoice)


async def test_a_program_renders_what_it_reads(bin_folder: Path) -> None:
    program(bin_folder, "speak", SPEAKS)
    voice = CommandVoice("speak", str(bin_folder / "speak"), lambda path: (path,))
    with wave.open(io.BytesIO(await voice.render("Shall I?"))) as sound:
        assert sound.getnframes() == len("Shall I?")


@pytest.mark.parametrize(
    ("script", "sentence"),
    [
        ("import sys; sys.exit('no such voice')", "speak failed with 1: no such voice"),
        ("", "speak wrote no sound"),
        ("import sys; open(sys.argv[-1], 'w').write('noise')", "speak wrote no sound"),
    ],
)
async def test_a_program_that_fails_is_one_sentence(
    bin_folder: Path, script: str, sentence: str
) -> None:
    program(bin_folder, "speak", script)
    voice = CommandVoice("speak", str(bin_folder / "speak"), lambda path: (path,))
    with pytest.raises(VoiceError, match=sentence):
        await voice.render("Shall I?")


async def test_a_folder_that_cannot_be_made_is_one_sentence(
    bin_folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    program(bin_folder, "speak", "")
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "nowhere"))
    with pytest.raises(VoiceError, match=r"speak wrote no sound: .* No such file or directory"):
        await CommandVoice("speak", "speak", lambda path: (path,)).render("hello")


async def test_a_folder_that_cannot_be_removed_just_then_takes_no_sound_away(
    bin_folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    program(bin_folder, "speak", SPEAKS)
    voice = CommandVoice("speak", str(bin_folder / "speak"), lambda path: (path,))

    def no_descriptor(*_: object, **__: object) -> None:
        raise OSError(errno.EMFILE, "Too many open files")

    monkeypatch.setattr(tempfile, "tempdir", str(bin_folder))
    with monkeypatch.context() as patched:
        patched.setattr(os, "scandir", no_descriptor)
        sound = await voice.render("Shall I?")
    assert sound.startswith(b"RIFF")


async def test_a_program_that_is_gone_is_one_sentence(tmp_path: Path) -> None:
    voice = CommandVoice("speak", str(tmp_path / "speak"), lambda path: (path,))
    with pytest.raises(VoiceError, match="speak cannot be started"):
        await voice.render("Shall I?")


@pytest.mark.parametrize("engine", ["flite", "espeak-ng"])
async def test_the_real_engines_speak(engine: VoiceChoice) -> None:
    if shutil.which(engine) is None:
        pytest.skip(f"{engine} is not installed")
    voice = choose(engine)
    assert isinstance(voice, CommandVoice)
    with wave.open(io.BytesIO(await voice.render("I dropped the pink bar."))) as sound:
        assert sound.getnframes() / sound.getframerate() > 0.8


async def test_a_text_is_rendered_once_however_many_want_it() -> None:
    voice = ToneVoice()
    texts = SpokenTexts(voice)
    sounds = await asyncio.gather(*(texts.wav("Shall I?") for _ in range(5)))
    assert await texts.wav("Shall I?") == sounds[0]
    assert voice.rendered == ["Shall I?"]


async def test_what_was_not_wanted_for_longest_makes_room() -> None:
    voice = ToneVoice()
    size = len(await voice.render("a"))
    voice.rendered.clear()
    texts = SpokenTexts(voice, max_kept_bytes=2 * size)
    for text in ("a", "b", "a", "c", "a", "b"):
        await texts.wav(text)
    assert voice.rendered == ["a", "b", "c", "b"]


async def test_a_failure_is_not_kept() -> None:
    voice = ToneVoice(broken=True)
    texts = SpokenTexts(voice)
    with pytest.raises(VoiceError):
        await texts.wav("Shall I?")
    voice.broken = False
    assert await texts.wav("Shall I?")
