"""Where utterances begin and end, on made-up sound."""

from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mend.server.speech.endpointing import FRAME_S, FRAME_SAMPLES, SAMPLE_RATE_HZ, Edge, Endpointer

QUIET, LOUD = 30.0, 3000.0


def sound(*pieces: tuple[float, float], seed: int = 0) -> list[bytes]:
    """Frames of white noise: each piece is its duration in seconds and its level."""
    random = np.random.default_rng(seed)
    levels = np.concatenate(
        [np.full(round(duration_s * SAMPLE_RATE_HZ), level) for duration_s, level in pieces]
    )
    samples = np.clip(random.normal(0, 1, len(levels)) * levels, -32768, 32767).astype(np.int16)
    whole = len(samples) // FRAME_SAMPLES * FRAME_SAMPLES
    return [samples[i : i + FRAME_SAMPLES].tobytes() for i in range(0, whole, FRAME_SAMPLES)]


def edges(
    frames: Sequence[bytes], endpointer: Endpointer | None = None
) -> list[tuple[Edge, float]]:
    """Every edge with its time in seconds."""
    listening = endpointer or Endpointer()
    found = [(listening.take(frame), number * FRAME_S) for number, frame in enumerate(frames)]
    return [(edge, time_s) for edge, time_s in found if edge is not None]


def test_an_utterance_begins_and_ends_soon_after_its_sound() -> None:
    (began, begin_s), (ended, end_s) = edges(sound((1.0, QUIET), (0.5, LOUD), (1.0, QUIET)))
    assert (began, ended) == (Edge.BEGAN, Edge.ENDED)
    assert 1.0 < begin_s < 1.2
    assert 1.7 < end_s < 1.9


def test_a_short_word_counts_and_a_click_does_not() -> None:
    assert len(edges(sound((1.0, QUIET), (0.16, LOUD), (1.0, QUIET)))) == 2
    assert edges(sound((1.0, QUIET), (0.04, LOUD), (1.0, QUIET))) == []


def test_a_short_pause_does_not_end_it() -> None:
    spoken = sound((1.0, QUIET), (0.4, LOUD), (0.2, QUIET), (0.4, LOUD), (1.0, QUIET))
    assert [edge for edge, _ in edges(spoken)] == [Edge.BEGAN, Edge.ENDED]


@pytest.mark.parametrize("level", [0.0, 30.0, 1000.0, 10_000.0])
def test_steady_noise_is_no_speech_however_loud(level: float) -> None:
    assert edges(sound((5.0, level))) == []


def test_speech_is_found_above_steady_noise() -> None:
    spoken = sound((2.0, 500.0), (0.5, 5000.0), (1.0, 500.0))
    assert [edge for edge, _ in edges(spoken)] == [Edge.BEGAN, Edge.ENDED]


def test_an_interrupted_utterance_is_forgotten() -> None:
    endpointer = Endpointer()
    assert len(edges(sound((1.0, QUIET), (0.3, LOUD)), endpointer)) == 1
    endpointer.interrupt()
    assert edges(sound((1.0, QUIET)), endpointer) == []


@settings(deadline=None, max_examples=30)
@given(
    st.lists(st.tuples(st.floats(0.02, 1.0), st.floats(0.0, 20_000.0)), min_size=1, max_size=12),
    st.integers(0, 100),
)
def test_beginnings_and_ends_alternate(pieces: list[tuple[float, float]], seed: int) -> None:
    found = [edge for edge, _ in edges(sound(*pieces, seed=seed))]
    assert all(edge is Edge.BEGAN for edge in found[::2])
    assert all(edge is Edge.ENDED for edge in found[1::2])
