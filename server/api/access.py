"""Who may come in: the token, browser sessions, and the Host and Origin of a request."""

import hashlib
import hmac
import ipaddress
import secrets
from collections.abc import Callable, Sequence
from urllib.parse import urlsplit

from starlette.requests import HTTPConnection

from server.visitors import visitor_of

SESSION_COOKIE = "mend_session"
SESSION_LIFETIME_S = 12 * 3600


class Access:
    """The rules of admission. Without a token everybody may come in who can reach the service."""

    def __init__(
        self,
        token: str | None,
        *,
        allowed_hosts: Sequence[str] = (),
        allowed_origins: Sequence[str] = (),
        wall_time_s: Callable[[], float],
    ) -> None:
        self._token = token
        self._hosts = {"localhost", *(host.lower() for host in allowed_hosts)}
        self._origins = {origin.lower().rstrip("/") for origin in allowed_origins}
        self._wall_time_s = wall_time_s

    @property
    def required(self) -> bool:
        """Whether a token has to be shown."""
        return self._token is not None

    def token_fits(self, token: str) -> bool:
        """Compare with the token, in a time that tells nothing about it."""
        if self._token is None:
            return True
        return secrets.compare_digest(_bytes(token), _bytes(self._token))

    def new_session(self) -> str:
        """A cookie's value that stands for the token until it expires; survives a restart."""
        expires = int(self._wall_time_s()) + SESSION_LIFETIME_S
        return f"{expires}.{self._sign(expires)}"

    def session_fits(self, cookie: str) -> bool:
        expires, _, signature = cookie.partition(".")
        if not (expires.isascii() and expires.isdigit() and len(expires) < 12):
            return False
        return int(expires) > self._wall_time_s() and secrets.compare_digest(
            _bytes(signature), _bytes(self._sign(int(expires)))
        )

    def admits(self, connection: HTTPConnection) -> bool:
        """Whether a connection shows the token, as a bearer or by its session cookie."""
        shown = self._shown(connection)
        if shown:
            welcome(connection)
        return shown

    def _shown(self, connection: HTTPConnection) -> bool:
        if self._token is None:
            return True
        scheme, _, credentials = connection.headers.get("authorization", "").partition(" ")
        if scheme.lower() == "bearer":
            return self.token_fits(credentials.strip())
        return self.session_fits(connection.cookies.get(SESSION_COOKIE, ""))

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
        key = _bytes(self._token or "")
        return hmac.new(key, f"session:{expires}".encode(), hashlib.sha256).hexdigest()


def welcome(connection: HTTPConnection) -> None:
    """Whoever made this connection is no stranger any more."""
    visitor = visitor_of(connection.scope)
    if visitor is not None:
        visitor.admit()


def _bytes(text: str) -> bytes:
    return text.encode("utf-8", "surrogatepass")


def _is_ip(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True
