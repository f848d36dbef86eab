"""Session cookies end when they are signed out, in time, and with the credential behind them."""

import pytest

from mend.server.access.principal import Principal
from mend.server.access.roles import Role
from mend.server.access.sessions import (
    SESSION_LIFETIME_S,
    SESSIONS_AN_HOUR,
    Sessions,
    TooManySessionsError,
)

ANNA = Principal("anna ü.", Role.HELPER, "key-1")


class Clock:
    def __init__(self) -> None:
        self.now = 1_000_000.0

    def __call__(self) -> float:
        return self.now


def test_a_cookie_is_that_of_its_principal_for_its_time() -> None:
    clock = Clock()
    sessions = Sessions(b"k" * 32, clock, clock)
    _, cookie = sessions.new(ANNA)
    session = sessions.read(cookie)
    assert session is not None
    assert session.name == "anna ü."
    assert sessions.fits(session, ANNA)
    assert not sessions.fits(session, Principal("anna ü.", Role.HELPER, "key-2"))
    assert not Sessions(b"x" * 32, clock).fits(session, ANNA)
    clock.now += SESSION_LIFETIME_S
    assert sessions.read(cookie) is None


def test_a_cookie_that_was_changed_fits_nobody() -> None:
    sessions = Sessions(b"k" * 32, Clock())
    _, cookie = sessions.new(ANNA)
    expires, rest = cookie.split(".", 1)
    later = sessions.read(f"{int(expires) + 1}.{rest}")
    assert later is not None
    assert not sessions.fits(later, ANNA)
    for wrong in ("", "forged", "9.9.9", f"{expires}.a.!.c", f"{expires}.a.YQ.c.d", "x.a.YQ.c"):
        assert sessions.read(wrong) is None


def test_a_session_that_was_ended_is_read_no_more() -> None:
    sessions = Sessions(b"k" * 32, Clock())
    session, cookie = sessions.new(ANNA)
    _, other = sessions.new(ANNA)
    sessions.end(session.id, session.expires)
    assert sessions.read(cookie) is None
    assert sessions.read(other) is not None


def test_nobody_signs_in_without_end() -> None:
    clock = Clock()
    sessions = Sessions(b"k" * 32, clock, clock)
    for _ in range(SESSIONS_AN_HOUR):
        sessions.new(ANNA)
    with pytest.raises(TooManySessionsError, match="has signed in 600 times within an hour"):
        sessions.new(ANNA)
    sessions.new(Principal("ben", Role.HELPER, "key-of-ben"))
    clock.now += 3600
    sessions.new(ANNA)


def test_a_clock_that_is_set_back_keeps_nobody_from_signing_in_for_longer() -> None:
    wall, clock = Clock(), Clock()
    sessions = Sessions(b"k" * 32, wall, clock)
    for _ in range(SESSIONS_AN_HOUR):
        sessions.new(ANNA)
    wall.now -= 24 * 3600
    with pytest.raises(TooManySessionsError):
        sessions.new(ANNA)
    clock.now += 3600
    sessions.new(ANNA)


def test_who_has_not_signed_in_for_an_hour_is_not_remembered() -> None:
    clock = Clock()
    sessions = Sessions(b"k" * 32, clock, clock)
    for number in range(100):
        sessions.new(Principal(f"robot {number}", Role.HELPER, f"key-{number}"))
        clock.now += 360
    assert len(sessions._begun) == 10
