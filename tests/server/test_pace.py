"""How fast somebody is listened to, and each of many for themselves."""

from ticking_clock import TickingClock

from mend.server.pace import BURST_S, CHARS_OF_ONE, Pace, Paces


def test_so_many_at_once_and_then_one_after_the_other() -> None:
    clock = TickingClock()
    pace = Pace(2, clock)
    assert [pace.take() for _ in range(int(2 * BURST_S))] == [0.0] * 8
    assert [pace.take() for _ in range(3)] == [0.5, 1.0, 1.5]
    clock.now_s += 1.5
    assert pace.take() == 0.5
    # However long nothing came, no more than that may come at once.
    clock.now_s += 1000.0
    assert pace.take(CHARS_OF_ONE * 7) == 0.0
    assert pace.take() == 0.5


def test_what_would_wait_too_long_is_not_taken_and_makes_nobody_wait_longer() -> None:
    pace = Pace(1, TickingClock())
    waits = [pace.take(patience_s=2.0) for _ in range(10)]
    assert waits == [0.0] * 4 + [1.0, 2.0] + [3.0] * 4


def test_each_has_a_pace_and_those_heard_last_are_kept() -> None:
    paces = Paces(1, TickingClock(), most=2)
    for name in ("anna", "ben"):
        assert [paces.of(name).take() for _ in range(5)] == [0.0] * 4 + [1.0]
    assert paces.of("anna").take() == 2.0
    assert paces.of("cleo").take() == 0.0
    # Of the three it was Ben who was heard longest ago.
    assert paces.of("anna").take() == 3.0
    assert paces.of("ben").take() == 0.0
