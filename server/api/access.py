"""Who may come in: the token, browser sessions, and the Host and Origin of a request."""

import hashlib
import hmac
import ipaddress
import math
import secrets
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from urllib.parse import urlsplit

from starlette.requests import HTTPConnection

from server.api.wrong_tokens import WrongTokens
from server.household import household_of
from server.limits import Limits
from server.refusals import Refusals
from server.visitors import visitor_of

SESSION_COOKIE = "mend_session"
SESSION_LIFETIME_S = 12 * 3600


@dataclass(frozen=True, slots=True)
class Admission:
    """Whether somebody may come in; `wait_s`: so long no token of theirs is read."""

    admitted: bool
    wait_s: int = 0

    @property
    def retry_after(self) -> dict[str, str]:
        """The headers that say so."""
        return {"Retry-After": str(self.wait_s)}

    @property
    def too_many(self) -> str:
        """The sentence that says so."""
        return f"too many wrong tokens came from this address: try again in {self.wait_s} s"


ADMITTED = Admission(admitted=True)
REFUSED = Admission(admitted=False)


class Access:
    """The rules of admission. Without a token everybody may come in who can reach the service.

    Sessions are signed with `session_key`; without one they end with this object.
    """

    def __init__(
        self,
        token: str | None,
        *,
        wall_time_s: Callable[[], float],
        allowed_hosts: Sequence[str] = (),
        allowed_origins: Sequence[str] = (),
        session_key: bytes | None = None,
        limits: Limits | None = None,
        refusals: Refusals | None = None,
    ) -> None:
        self._token = token
        self._hosts = {"localhost", *(host.lower() for host in allowed_hosts)}
        self._origins = {origin.lower().rstrip("/") for origin in allowed_origins}
        self._wall_time_s = wall_time_s
        self._session_key = session_key or secrets.token_bytes(32)
        self._wrong = WrongTokens((limits or Limits()).wrong_tokens, wall_time_s)
        self._refusals = refusals or Refusals()

    @property
    def required(self) -> bool:
        """Whether a token has to be shown."""
        return self._token is not None

    def new_session(self) -> str:
        """A cookie's value that stands for the token until it expires."""
        expires = int(self._wall_time_s()) + SESSION_LIFETIME_S
        return f"{expires}.{self._sign(expires)}"

    def session_fits(self, cookie: str) -> bool:
        expires, _, signature = cookie.partition(".")
        if not (expires.isascii() and expires.isdigit() and len(expires) < 12):
            return False
        return int(expires) > self._wall_time_s() and secrets.compare_digest(
            _bytes(signature), _bytes(self._sign(int(expires)))
        )

    def by_request(self, connection: HTTPConnection) -> Admission:
        """By what a request shows: the token as a bearer, or a session cookie."""
        if self._token is None:
            return _welcomed(connection)
        if _bearer(connection) is not None:
            return self.by_bearer(connection)
        # Signed with a key that nobody can guess, so guessing it needs no throttle.
        if self.session_fits(connection.cookies.get(SESSION_COOKIE, "")):
            return _welcomed(connection)
        return REFUSED

    def by_bearer(self, connection: HTTPConnection) -> Admission:
        """By the token as a bearer, and by nothing else."""
        if self._token is None:
            return _welcomed(connection)
        shown = _bearer(connection)
        return self.by_token(shown, connection) if shown else REFUSED

    def by_token(self, shown: str, connection: HTTPConnection) -> Admission:
        """By the token that somebody shows on a connection, wherever in it.

        While an address has to wait, what it shows is not even read; else guessing would be as
        quick as before. Whoever is in already stays in: on a connection that was admitted it is.
        """
        if self._token is None:
            return _welcomed(connection)
        address, token = _household(connection), _bytes(shown)
        if self._wrong.is_known(address, token):
            return REFUSED
        wait_s = 0.0 if _is_in(connection) else self._wrong.wait_s(address)
        if wait_s > 0.0:
            self._refusals.note("wrong_tokens")
            return Admission(admitted=False, wait_s=math.ceil(wait_s))
        # In a time that tells nothing about the token.
        if secrets.compare_digest(token, _bytes(self._token)):
            return _welcomed(connection)
        self._wrong.add(address, token)
        return REFUSED

    def host_allowed(self, connection: HTTPConnection) -> bool:
        """Whether the Host is a name of this service.

        A page elsewhere can point a name of its own at this address (DNS rebinding), but it
        cannot make an IP address its own.
        """
        try:
            name = urlsplit("//" + connection.headers.get("host", "")).hostname
        except ValueError:
            return False
        return name is not None and (name in self._hosts or _is_ip(name))

    def origin_allowed(self, connection: HTTPConnection) -> bool:
        """Whether the page that makes this request, if it is one, comes from here."""
        origin = connection.headers.get("origin")
        if origin is None:
            return True
        origin = origin.lower()
        host = connection.headers.get("host", "").lower()
        return origin in self._origins or origin in (f"http://{host}", f"https://{host}")

    def _sign(self, expires: int) -> str:
        # With another token all sessions end.
        signed = f"session:{expires}:{self._token or ''}"
        return hmac.new(self._session_key, _bytes(signed), hashlib.sha256).hexdigest()


def _bearer(connection: HTTPConnection) -> str | None:
    """What a request shows as a bearer; None if it shows nothing so."""
    scheme, _, credentials = connection.headers.get("authorization", "").partition(" ")
    return credentials.strip() if scheme.lower() == "bearer" else None


def _welcomed(connection: HTTPConnection) -> Admission:
    """Whoever made this connection is no stranger any more."""
    visitor = visitor_of(connection.scope)
    if visitor is not None:
        visitor.admit()
    return ADMITTED


def _is_in(connection: HTTPConnection) -> bool:
    """Whether the connection was admitted before, and is one client's alone."""
    visitor = visitor_of(connection.scope)
    return visitor is not None and visitor.is_admitted and visitor.household is not None


def _household(connection: HTTPConnection) -> str:
    return household_of(connection.client.host) if connection.client else ""


def _bytes(text: str) -> bytes:
    return text.encode("utf-8", "surrogatepass")


def _is_ip(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True
