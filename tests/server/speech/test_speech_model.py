"""Folders with an operator's speech model, and what is said of those that cannot be used."""

import asyncio
import os
import shutil
from base64 import b64encode
from pathlib import Path

import pytest
from wav_device import pcm_of

from mend.server.speech import speech_model
from mend.server.speech.beam_search import GreedyTranscriber
from mend.server.speech.commands import Command
from mend.server.speech.ear import NoEars, choose_ears
from mend.server.speech.meaning import meaning_of
from mend.server.speech.moonshine import Moonshine
from mend.server.speech.speech_model import (
    SpeechModel,
    SpeechModelError,
    Tokens,
    find_speech_model,
    read_tokens,
)
from mend.server.speech.voice import CommandVoice, choose_voice
from mend.server.speech.written_evidence import WrittenEvidence

FILES = ("encoder_model.ort", "decoder_model_merged.ort", "tokens.txt")
PIECES = [
    *enumerate(each.encode() for each in ("\u2581", "n", "o", "g", "\u2581n", "\u2581no", "on"))
]
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
    (tmp_path / "tokenizer.bin").write_bytes(b"\x01a\x82\x01b")
    with pytest.raises(SpeechModelError, match="ends within a token"):
        read_tokens(tmp_path / "tokenizer.bin")


def test_tokens_may_be_listed_or_as_moonshine_has_them(tmp_path: Path) -> None:
    listed, own = tmp_path / "tokens.txt", tmp_path / "tokenizer.bin"
    listed.write_bytes(b"".join(b"%s %d\n" % (b64encode(each), at) for at, each in PIECES))
    own.write_bytes(b"".join(bytes([len(each)]) + each for _, each in PIECES))
    for path in (listed, own):
        tokens = read_tokens(path)
        assert tokens.text_of(tokens.spelling_of("no go")) == "no go"


def test_tokens_are_merged_in_the_order_they_were_learned_in() -> None:
    tokens = Tokens([each for _, each in PIECES])
    assert tokens.spelling_of("no") == (tokens.number_of("\u2581no".encode()),)
    assert tokens.spelling_of("on") == tuple(
        tokens.number_of(each.encode()) for each in ("\u2581", "on")
    )


@pytest.mark.parametrize("content", [b"not base64! 0\n", b"YQ== one\n", b"YQ== 1\n"])
def test_a_list_of_tokens_that_is_none_is_told(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "tokens.txt").write_bytes(content)
    with pytest.raises(SpeechModelError, match=r"tokens\.txt"):
        read_tokens(tmp_path / "tokens.txt")


def test_files_that_are_no_model_are_told(tmp_path: Path) -> None:
    pytest.importorskip("onnxruntime", reason="onnxruntime is not installed")
    (tmp_path / "tokens.txt").write_bytes(b"YQ== 0\n")
    files = [tmp_path / name for name in FILES]
    for each in files[:2]:
        each.write_bytes(b"no model")
    with pytest.raises(SpeechModelError, match="cannot be read"):
        Moonshine(SpeechModel(*files))


def own_model() -> Moonshine:
    if OWN_MODEL not in os.environ:
        pytest.skip(f"no speech model is there: {OWN_MODEL} says where one is")
    return Moonshine(find_speech_model(Path(os.environ[OWN_MODEL])))


def said(text: str) -> bytes:
    """A sentence by flite, in a quiet room."""
    if shutil.which("flite") is None:
        pytest.skip("flite is not installed, and nobody else can speak here")
    person = choose_voice("flite", flite_voice="slt", piper_model=None)
    assert isinstance(person, CommandVoice)
    return bytes(12_800) + pcm_of(asyncio.run(person.render(text))) + bytes(9_600)


@pytest.mark.slow
def test_a_real_model_writes_down_what_is_said_and_hears_no_command_in_silence() -> None:
    transcriber = GreedyTranscriber(own_model())
    assert meaning_of(transcriber.text_of(said("yes, please")))[0] is Command.YES
    assert meaning_of(transcriber.text_of(said("I will be late")))[0] is None
    assert meaning_of(transcriber.text_of(bytes(32_000)))[0] is None


@pytest.mark.slow
def test_a_real_model_holds_a_phrase_for_probable_that_is_said_and_no_other_for_more() -> None:
    evidence = WrittenEvidence(own_model())
    for text, meant in (("no thank you", Command.NO), ("could you repeat that", Command.REPEAT)):
        best = max(evidence.of(said(text))[1], key=lambda each: each.ahead)
        assert (best.command, best.phrase) == (meant, text)
        assert best.ahead > 0
    unrelated = evidence.of(said("the meeting is on the third floor"))[1]
    assert all(each.ahead < 0 for each in unrelated)
