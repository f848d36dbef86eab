"""Folders with an operator's speech model, and what is said of those that cannot be used."""

import asyncio
import os
import shutil
from pathlib import Path

import pytest
from wav_device import pcm_of

from mend.server.speech import speech_model
from mend.server.speech.commands import Command
from mend.server.speech.ear import NoEars, choose_ears
from mend.server.speech.meaning import meaning_of
from mend.server.speech.speech_model import (
    SherpaTranscriber,
    SpeechModelError,
    find_speech_model,
)
from mend.server.speech.voice import CommandVoice, choose_voice

FILES = ("encoder_model.ort", "decoder_model_merged.ort", "tokens.txt")
OWN_MODEL = "TEST_SPEECH_MODEL"
"""The environment variable that says where a model is, for tests that need a real one."""


def folder_with(folder: Path, *names: str) -> Path:
    for name in names:
        (folder / name).write_bytes(b"\x01a\x02bc")
    return folder


def test_a_model_is_found_by_the_names_of_its_files(tmp_path: Path) -> None:
    model = find_speech_model(folder_with(tmp_path, *FILES))
    assert [model.encoder.name, model.decoder.name, model.tokens.name] == [*FILES]


@pytest.mark.parametrize("missing", FILES)
def test_a_file_that_is_missing_is_told(tmp_path: Path, missing: str) -> None:
    folder_with(tmp_path, *(each for each in FILES if each != missing))
    with pytest.raises(SpeechModelError, match=f"has no .*{missing}"):
        find_speech_model(tmp_path)


def test_a_folder_that_there_is_not_is_told(tmp_path: Path) -> None:
    with pytest.raises(SpeechModelError, match="there is no folder"):
        find_speech_model(tmp_path / "nowhere")


def test_a_library_that_is_missing_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(speech_model, "find_spec", lambda _: None)
    with pytest.raises(SpeechModelError, match=r"pip install 'mend-robots\[speech-model\]'"):
        find_speech_model(tmp_path)


def test_without_a_model_that_was_asked_for_nothing_is_recognized(tmp_path: Path) -> None:
    pytest.importorskip("pocketsphinx")
    ears = choose_ears(True, 1, tmp_path / "nowhere")
    assert isinstance(ears, NoEars)
    assert "there is no folder" in ears.why_not
    chosen = choose_ears(True, 1, folder_with(tmp_path, *FILES))
    assert not isinstance(chosen, NoEars)
    assert chosen.engine == "pocketsphinx and moonshine"


def test_a_tokenizer_that_ends_within_a_token_is_told(tmp_path: Path) -> None:
    folder_with(tmp_path, *FILES[:2])
    (tmp_path / "tokenizer.bin").write_bytes(b"\x01a\x82\x01b")
    with pytest.raises(SpeechModelError, match="ends within a token"):
        SherpaTranscriber(find_speech_model(tmp_path))


def own_model() -> SherpaTranscriber:
    if OWN_MODEL not in os.environ:
        pytest.skip(f"no speech model is there: {OWN_MODEL} says where one is")
    return SherpaTranscriber(find_speech_model(Path(os.environ[OWN_MODEL])))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("said", "meant"),
    [("yes, please", Command.YES), ("no thank you", Command.NO), ("I will be late", None)],
)
def test_a_real_model_writes_down_what_is_said(said: str, meant: Command | None) -> None:
    transcriber = own_model()
    if shutil.which("flite") is None:
        pytest.skip("flite is not installed, and nobody else can speak here")
    person = choose_voice("flite", flite_voice="slt", piper_model=None)
    assert isinstance(person, CommandVoice)
    sound = bytes(12_800) + pcm_of(asyncio.run(person.render(said))) + bytes(9_600)
    assert meaning_of(transcriber.text_of(sound))[0] is meant
    assert transcriber.text_of(bytes(32_000)) == ""
