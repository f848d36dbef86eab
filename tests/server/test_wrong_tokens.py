"""How long an address waits after wrong tokens, by a clock that the test moves."""

import pytest

from mend.server.access.wrong_tokens import MOST_ADDRESSES, WrongTokens


class Guesser:
    def __init__(self, free: int = 2) -> None:
        self.now = 1000.0
        self.wrong = WrongTokens(free, lambda: self.now)
        self._next = 0

    def guess(self, address: str = "10.0.0.1") -> float:
        """Show one more wrong token; how long to wait then."""
        self._next += 1
        self.wrong.add(address, b"guess %d" % self._next)
        return self.wrong.wait_s(address)


def test_waits_double_up_to_the_longest() -> None:
    guesser = Guesser(free=2)
    assert [guesser.guess() for _ in range(9)] == [0, 0, 1, 2, 4, 8, 16, 30, 30]


def test_many_guesses_wait_no_longer_than_that() -> None:
    guesser = Guesser()
    for _ in range(5000):
        guesser.guess()
    assert guesser.guess() == 30


def test_a_wait_passes() -> None:
    guesser = Guesser(free=1)
    guesser.guess()
    assert guesser.guess() == 1
    guesser.now += 0.75
    assert guesser.wrong.wait_s("10.0.0.1") == 0.25
    guesser.now += 0.25
    assert guesser.wrong.wait_s("10.0.0.1") == 0
    assert guesser.guess() == 2


def test_addresses_do_not_wait_for_each_other() -> None:
    guesser = Guesser(free=1)
    assert [guesser.guess(), guesser.guess()] == [0, 1]
    assert guesser.wrong.wait_s("10.0.0.2") == 0


def test_the_same_wrong_token_is_no_other_guess() -> None:
    guesser = Guesser(free=1)
    for _ in range(100):
        guesser.wrong.add("10.0.0.1", b"outdated")
    assert guesser.wrong.wait_s("10.0.0.1") == 0
    assert guesser.wrong.is_known("10.0.0.1", b"outdated")
    assert not guesser.wrong.is_known("10.0.0.2", b"outdated")


def test_all_is_forgotten_after_a_quarter_of_an_hour() -> None:
    guesser = Guesser(free=1)
    assert [guesser.guess() for _ in range(3)] == [0, 1, 2]
    guesser.now += 15 * 60 + 1
    assert guesser.guess() == 0


@pytest.mark.parametrize("jump_s", [-3600.0, -1.0])
def test_a_clock_that_is_set_back_makes_nobody_wait_longer(jump_s: float) -> None:
    guesser = Guesser(free=1)
    assert [guesser.guess() for _ in range(3)][-1] == 2
    guesser.now += jump_s
    assert guesser.wrong.wait_s("10.0.0.1") == 2
    guesser.now += 2
    assert guesser.wrong.wait_s("10.0.0.1") == 0


def test_only_so_many_addresses_are_remembered() -> None:
    guesser = Guesser(free=1)
    for _ in range(2):
        guesser.guess("first")
    for number in range(MOST_ADDRESSES):
        guesser.guess(str(number))
    assert guesser.wrong.wait_s("first") == 0
    assert len(guesser.wrong._addresses) == MOST_ADDRESSES
