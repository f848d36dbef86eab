"""Silence is counted only while somebody is there to hear."""

from ticking_clock import TickingClock

from mend.server.robots.silence import Silence


def test_silence_adds_up_from_look_to_look_and_ends_with_what_comes() -> None:
    clock = TickingClock()
    silence = Silence(clock, 1.0)
    for _ in range(3):
        clock.now_s += 1.0
        silence.look()
    assert silence.seconds == 3.0
    clock.now_s += 1.0
    silence.hear()
    assert silence.look() == 0.0
    clock.now_s += 1.5
    assert silence.look() == 1.5


def test_a_look_that_comes_late_counts_nothing() -> None:
    clock = TickingClock()
    silence = Silence(clock, 1.0)
    clock.now_s += 1.0
    assert silence.look() == 1.0
    clock.now_s += 60.0
    assert silence.look() == 1.0
    clock.now_s += 2.0
    assert silence.look() == 3.0


def test_between_two_looks_it_is_told_without_being_counted() -> None:
    clock = TickingClock()
    silence = Silence(clock, 1.0)
    silence.look()
    clock.now_s += 1.5
    assert silence.so_far() == 1.5
    assert silence.look() == 1.5
    # Nobody was there to hear anything.
    clock.now_s += 60.0
    assert silence.so_far() == 1.5
    silence.hear()
    assert silence.so_far() == 0.0
