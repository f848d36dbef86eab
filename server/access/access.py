"""Who may come in: tokens, browser sessions, and the Host and Origin of a request."""

import asyncio
import ipaddress
import math
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from urllib.parse import urlsplit

from starlette.requests import HTTPConnection

from mend.server.access.admission import REFUSED, Admission
from mend.server.access.known_principals import KnownPrincipals
from mend.server.access.principal import ANYBODY, TOKEN_NAME, Caller, Principal
from mend.server.access.roles import Role
from mend.server.access.sessions import Session, Sessions, new_session_key
from mend.server.access.tokens import bytes_of, fingerprint, fits
from mend.server.access.wrong_tokens import WrongTokens
from mend.server.household import household_of
from mend.server.limits import Limits
from mend.server.pace import BURST_S, Paces, Sleep
from mend.server.refusals import Refusals
from mend.server.robots.passes import OneRobot, OwnRobots, Pass
from mend.server.visitors import visitor_of

SESSION_COOKIE = "mend_session"


class Access:
    """The rules of admission.

    Without a token and without principals everybody may come in who can reach the service.
    `failed` is told the address of whoever shows something wrong. `now` is any monotonic clock in
    seconds: by it everybody is held to their pace, and sign-ins are counted.
    """

    def __init__(
        self,
        token: str | None,
        *,
        principals: KnownPrincipals | None = None,
        session_key: bytes | None = None,
        own_robots: OwnRobots | None = None,
        failed: Callable[[str | None], None] = lambda _address: None,
        allowed_hosts: Sequence[str] = (),
        allowed_origins: Sequence[str] = (),
        limits: Limits | None = None,
        refusals: Refusals | None = None,
        wall_time_s: Callable[[], float],
        now: Callable[[], float] = time.monotonic,
        sleep: Sleep = asyncio.sleep,
    ) -> None:
        limits, refusals = limits or Limits(), refusals or Refusals()
        self.principals = principals or KnownPrincipals(None, wall_time_s)
        self.sessions = Sessions(session_key or new_session_key(), wall_time_s, now)
        self._holder = (
            None
            if token is None
            else Principal(TOKEN_NAME, Role.ADMIN, fingerprint(token), named=False)
        )
        self._own_robots = own_robots or OwnRobots()
        self._wall_time_s = wall_time_s
        self._failed = failed
        self._wrong = WrongTokens(limits.wrong_tokens, wall_time_s)
        self._refusals = refusals
        too_fast = partial(refusals.note, "requests_per_s")
        self._paces = Paces(limits.requests_per_s, now, too_fast, sleep)
        self._hosts = {"localhost", *(host.lower() for host in allowed_hosts)}
        self._origins = {origin.lower().rstrip("/") for origin in allowed_origins}
        self._watched: dict[int, tuple[Caller, asyncio.Event]] = {}

    # --- Who it is ----------------------------------------------------------------------------

    @property
    def required(self) -> bool:
        """Whether a token has to be shown."""
        return self._holder is not None or self.principals.required

    def of_token(self, token: str) -> Principal | None:
        """Whose token this is; anybody's where none is needed."""
        if not self.required:
            return ANYBODY
        if self._holder is not None and fits(token, self._holder.key):
            return self._holder
        return self.principals.of_token(token)

    def by_request(self, connection: HTTPConnection) -> Admission:
        """By what a request shows: a token as a bearer, or else a session cookie.

        A robot is let in too: its credential opens nothing but the robots' socket.
        """
        bearer = bearer_of(connection)
        if bearer:
            return self.by_token(bearer, connection)
        if not self.required:
            return _welcomed(Caller(ANYBODY, address_of(connection)), connection)
        # Signed with a key that nobody can guess, so guessing it needs no throttle.
        session = self.sessions.read(connection.cookies.get(SESSION_COOKIE, ""))
        principal = None if session is None else self.of_session(session)
        if session is not None and principal is not None:
            address = address_of(connection)
            return _welcomed(Caller(principal, address, session.id, session.expires), connection)
        if bearer is not None:
            self._failed(address_of(connection))
        return REFUSED

    def by_bearer(self, connection: HTTPConnection) -> Admission:
        """By a token as a bearer, and by nothing else."""
        bearer = bearer_of(connection)
        if bearer or not self.required:
            return self.by_token(bearer or "", connection)
        if bearer is not None:
            self._failed(address_of(connection))
        return REFUSED

    def by_token(self, shown: str, connection: HTTPConnection) -> Admission:
        """By the token that somebody shows on a connection, wherever in it.

        While an address has to wait, what it shows is not even read; else guessing would be as
        quick as before. Whoever is in already stays in, with what their connection came in with.
        """
        if self.required:
            waiting = self.waiting(shown, connection)
            if waiting.wait_s:
                return waiting
        principal = self.of_token(shown)
        if principal is None:
            self.wrong(shown, connection)
            return REFUSED
        return _welcomed(Caller(principal, address_of(connection)), connection, shown)

    def waiting(self, shown: str, connection: HTTPConnection) -> Admission:
        """Nobody, and how many seconds nothing new that this address shows is read; 0: it is now.

        What was wrong before is no other guess, and may be read again: the file of principals can
        have changed since.
        """
        household = household_of(address_of(connection))
        if self._is_in(shown, connection) or self._wrong.is_known(household, bytes_of(shown)):
            return REFUSED
        wait_s = math.ceil(self._wrong.wait_s(household))
        if wait_s == 0:
            return REFUSED
        self._refusals.note("wrong_tokens")
        too_many = f"too many wrong tokens came from this address: try again in {wait_s} s"
        return Admission(None, wait_s, too_many)

    def _is_in(self, shown: str, connection: HTTPConnection) -> bool:
        """Whether the connection, one client's alone, was admitted with this, and it is still good.

        Anything else that comes on it is a guess like any other.
        """
        visitor = visitor_of(connection.scope)
        if visitor is None or visitor.household is None or visitor.shown is None:
            return False
        return fits(shown, visitor.shown) and self.of_token(shown) is not None

    def wrong(self, shown: str, connection: HTTPConnection) -> None:
        """Somebody has shown a wrong token or code."""
        self._wrong.add(household_of(address_of(connection)), bytes_of(shown))
        self._failed(address_of(connection))

    async def in_time(self, admission: Admission) -> Admission:
        """The same as soon as they may ask for the next thing, or how long they have to wait.

        No more of theirs wait than are answered in that time, also of clients that hang up. Those
        who share the one token are not held to a share of it.
        """
        caller = admission.caller
        if caller is None or not caller.principal.named:
            return admission
        wait_s = await self._paces.of(caller.principal.key).keep(patience_s=BURST_S)
        if wait_s > BURST_S:
            too_fast = "you ask faster than 'requests_per_s' allows"
            return Admission(None, math.ceil(wait_s), too_fast)
        return admission if wait_s == 0.0 else await self._anew(caller)

    async def _anew(self, caller: Caller) -> Admission:
        """Who it is after some time, in which they may have been revoked."""
        await self.look()
        caller_now = self.renewed(caller)
        return REFUSED if caller_now is None else Admission(caller_now)

    def session(self, connection: HTTPConnection) -> Session | None:
        """The session of a connection's cookie, if it is a good one."""
        session = self.sessions.read(connection.cookies.get(SESSION_COOKIE, ""))
        return session if session is not None and self.of_session(session) else None

    def renewed(self, caller: Caller) -> Caller | None:
        """The caller with the role that they have now; None if they may come in no longer."""
        principal = self._named(caller.principal.name) if self.required else ANYBODY
        if principal is None or principal.key != caller.principal.key:
            return None
        if caller.session is not None and not self.sessions.lasts(caller.session):
            return None
        if caller.until is not None and caller.until <= self._wall_time_s():
            return None
        return replace(caller, principal=principal)

    def of_session(self, session: Session) -> Principal | None:
        """Whose session it is, if the credential that began it is still good."""
        principal = self._named(session.name)
        fit = principal is not None and self.sessions.fits(session, principal)
        return principal if fit else None

    def still(self, name: str, key: str) -> Principal | None:
        """The principal of that name as it is now, if it still has the credential of that key."""
        principal = self._named(name) if self.required else ANYBODY
        fit = principal is not None and (principal.name, principal.key) == (name, key)
        return principal if fit else None

    def _named(self, name: str) -> Principal | None:
        return self._holder if name == TOKEN_NAME else self.principals.of_name(name)

    # --- While it lasts -----------------------------------------------------------------------

    async def look(self) -> None:
        """See whether the principals have changed, and let go of those who are gone.

        Every door does so before it asks who somebody is.
        """
        if await self.principals.look():
            self.let_go()

    def let_go(self) -> None:
        """Tell the open connections of everybody who may come in no longer."""
        for caller, gone in self._watched.values():
            if self.renewed(caller) is None:
                gone.set()

    @contextmanager
    def watched(self, caller: Caller) -> Iterator[asyncio.Event]:
        """An event that is set once the caller may come in no longer."""
        gone = asyncio.Event()
        self._watched[id(gone)] = caller, gone
        try:
            yield gone
        finally:
            del self._watched[id(gone)]

    # --- Robots -------------------------------------------------------------------------------

    def own_robot(self, connection: HTTPConnection) -> OneRobot | None:
        """As which robot a process of this service's own may say hello; None for anybody else.

        Its credential is made for its time, and nobody can guess it: it never has to wait.
        """
        bearer = bearer_of(connection)
        robot = None if bearer is None else self._own_robots.of_token(bearer)
        if robot is None:
            return None
        _admit(connection)
        return OneRobot(robot)

    def robot_pass(self, caller: Caller) -> Pass | None:
        """As which robot somebody may say hello; None if as none."""
        if caller.principal.role is Role.ROBOT:
            return OneRobot(caller.principal.name)
        return None if caller.principal.named else UnboundRobot(self)

    def bound(self, robot: str) -> bool:
        """Whether a robot's name belongs to a credential."""
        return robot in self._own_robots or self.principals.has_robot(robot)

    # --- Host and Origin ----------------------------------------------------------------------

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


class UnboundRobot:
    """The pass of whoever shows the service's own token, or need not show any."""

    def __init__(self, access: Access) -> None:
        self._access = access

    def why_not(self, robot: str) -> str | None:
        if not self._access.bound(robot):
            return None
        return (
            f"the robot '{robot}' has a credential of its own: nobody can be it with the "
            "service's token, or without one"
        )


def bearer_of(connection: HTTPConnection) -> str | None:
    """What a connection shows as a bearer; empty for what is no bearer, None without a header."""
    header = connection.headers.get("authorization")
    if header is None:
        return None
    scheme, _, credentials = header.partition(" ")
    return credentials.strip() if scheme.lower() == "bearer" else ""


def address_of(connection: HTTPConnection) -> str | None:
    """Where a connection comes from; None where it is not known, as by a proxy that makes it up."""
    host = None if connection.client is None else connection.client.host
    return host if host is not None and _is_ip(host) else None


def _welcomed(caller: Caller, connection: HTTPConnection, token: str | None = None) -> Admission:
    principal = caller.principal
    shown = None if token is None else fingerprint(token)
    _admit(connection, principal.key if principal.named else None, shown)
    return Admission(caller)


def _admit(
    connection: HTTPConnection, principal: str | None = None, shown: str | None = None
) -> None:
    """Whoever made this connection is no stranger any more; who has one token has no share."""
    visitor = visitor_of(connection.scope)
    if visitor is not None:
        visitor.admit(principal, shown)


def _is_ip(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True
