"""Browser sessions: a signed cookie that ends when it is signed out, or with its principal."""

import base64
import hashlib
import hmac
import secrets
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

from mend.errors import ConflictError
from mend.server.access.principal import Principal
from mend.server.access.tokens import bytes_of

SESSION_LIFETIME_S = 12 * 3600
KEY_BYTES = 32
HOUR_S = 3600
SESSIONS_AN_HOUR = 600
"""So many may be begun with one credential: each that is signed out leaves an event."""


class TooManySessionsError(ConflictError):
    """Somebody signs in again and again; in `wait_s` they may once more."""

    def __init__(self, message: str, wait_s: float) -> None:
        super().__init__(message)
        self.wait_s = wait_s


@dataclass(frozen=True, slots=True)
class Session:
    """What a cookie says, before it is known whether that is true. `expires`: seconds of 1970."""

    id: str
    name: str
    expires: int
    signature: str


class Sessions:
    """Signs and reads cookies with a `key` that survives a restart, and knows which have ended.

    A signature holds the principal's key too, so that a session ends with the credential that
    began it. `now` is any monotonic clock in seconds: by it sign-ins are counted.
    """

    def __init__(
        self,
        key: bytes,
        wall_time_s: Callable[[], float],
        now: Callable[[], float] = time.monotonic,
    ) -> None:
        self._key = key
        self._wall_time_s = wall_time_s
        self._now = now
        self._ended: dict[str, int] = {}
        self._begun: dict[str, deque[float]] = {}

    def new(self, principal: Principal) -> tuple[Session, str]:
        """A session of a principal, and the cookie that stands for it.

        Raises `TooManySessionsError`.
        """
        self._count(principal)
        expires = int(self._wall_time_s()) + SESSION_LIFETIME_S
        number = secrets.token_hex(16)
        signature = self._sign(number, principal, expires)
        name = base64.urlsafe_b64encode(principal.name.encode()).decode().rstrip("=")
        cookie = f"{expires}.{number}.{name}.{signature}"
        return Session(number, principal.name, expires, signature), cookie

    def read(self, cookie: str) -> Session | None:
        """What a cookie says; None if it is none, has expired or was signed out."""
        parts = cookie.split(".")
        if len(parts) != 4:
            return None
        expires, number, name, signature = parts
        if not (expires.isascii() and expires.isdigit() and len(expires) < 12):
            return None
        try:
            padded = name + "=" * (-len(name) % 4)
            called = base64.b64decode(padded, altchars=b"-_", validate=True).decode()
        except ValueError:
            return None
        session = Session(number, called, int(expires), signature)
        return session if self.lasts(number) and session.expires > self._wall_time_s() else None

    def fits(self, session: Session, principal: Principal) -> bool:
        """Whether a session was begun here, with the credential that the principal has now."""
        right = self._sign(session.id, principal, session.expires)
        return secrets.compare_digest(bytes_of(session.signature), bytes_of(right))

    def lasts(self, number: str) -> bool:
        """Whether a session was not signed out."""
        return number not in self._ended

    def end(self, number: str, expires: int) -> None:
        """Let a session be over; it is remembered for as long as its cookie could still come."""
        now = self._wall_time_s()
        self._ended = {each: until for each, until in self._ended.items() if until > now}
        if expires > now:
            self._ended[number] = expires

    def _count(self, principal: Principal) -> None:
        now = self._now()
        self._begun = {key: each for key, each in self._begun.items() if now - each[-1] < HOUR_S}
        begun = self._begun.get(principal.key, deque(maxlen=SESSIONS_AN_HOUR))
        if len(begun) == SESSIONS_AN_HOUR and now - begun[0] < HOUR_S:
            raise TooManySessionsError(
                f"'{principal.name}' has signed in {SESSIONS_AN_HOUR} times within an hour: wait, "
                "or show the token with each request",
                begun[0] + HOUR_S - now,
            )
        begun.append(now)
        self._begun[principal.key] = begun

    def _sign(self, number: str, principal: Principal, expires: int) -> str:
        signed = "\n".join((str(expires), number, principal.key, principal.name))
        return hmac.new(self._key, bytes_of(signed), hashlib.sha256).hexdigest()


def new_session_key() -> bytes:
    """A key for a service whose sessions need not survive it."""
    return secrets.token_bytes(KEY_BYTES)
