"""Every connection to the service: how many there may be, and how long each may take for what."""

import logging
from collections.abc import Callable, Container
from dataclasses import dataclass
from enum import StrEnum
from typing import Protocol

from starlette.types import Scope

from mend.server.background import Endless
from mend.server.household import household_of
from mend.server.limits import LimitName, Limits
from mend.server.rare_log import RareLog
from mend.server.refusals import Refusals

log = logging.getLogger(__name__)

STATE_KEY = "visitor"
"""Under this name a scope's state has the visitor whose request it is."""


class ConnectionPhase(StrEnum):
    """What a connection is waiting for."""

    HEAD = "head"
    """The head of a request, or the TLS handshake before the first."""
    BODY = "body"
    """The body of a request whose head has come."""
    SERVICE = "service"
    """Nothing that its client owes."""


class Connection(Protocol):
    """Of a transport, what shows whether its client reads."""

    def get_write_buffer_size(self) -> int: ...


@dataclass(frozen=True, slots=True)
class Beyond:
    """Why a connection is not taken, or ended: the limit, and one sentence."""

    limit: LimitName
    sentence: str


End = Callable[[Beyond], None]


class Visitor:
    """One connection. It is a stranger until it is admitted; `end` ends it.

    `shown` is the fingerprint of the token that it was admitted with last, if it was one.
    """

    def __init__(self, visitors: "Visitors", household: str | None, end: End) -> None:
        self.household = household
        self.end = end
        self.is_admitted = False
        self.principal: str | None = None
        self.shown: str | None = None
        self.phase = ConnectionPhase.HEAD
        self.since = visitors.now()
        self._visitors = visitors
        self._connection: Connection | None = None
        self._unread = 0
        self._read_at = self.since

    def connected(self, connection: Connection, end: End) -> None:
        """Its connection is made; `end` is how to end it from now on."""
        self._connection = connection
        self.end = end

    def enter(self, phase: ConnectionPhase) -> None:
        """Something else is waited for; for the same again it gets no more time."""
        if phase is not self.phase:
            self.phase, self.since = phase, self._visitors.now()

    def admit(self, principal: str | None = None, shown: str | None = None) -> None:
        """It is no stranger any more, but whoever `principal` stands for, if they have a share."""
        self.is_admitted, self.shown = True, shown
        self._visitors.no_stranger(self)
        self._visitors.belongs(self, principal)

    def note(self, beyond: Beyond) -> None:
        """Something that came on it was beyond a limit."""
        self._visitors.note(beyond)

    def leave(self) -> None:
        """The connection is gone. Saying so twice does nothing."""
        self._visitors.leave(self)

    def stuck_for_s(self) -> float:
        """How long its client has taken nothing of what waits for it; 0 if nothing waits."""
        now = self._visitors.now()
        unread = 0 if self._connection is None else self._connection.get_write_buffer_size()
        if unread == 0 or unread < self._unread:
            self._read_at = now
        self._unread = unread
        return now - self._read_at


class Visitors:
    """All connections of one service, within its limits. `now` is any monotonic clock in seconds.

    Who comes from one of `proxies` is not counted by address: many come from the same.
    """

    def __init__(
        self,
        limits: Limits,
        refusals: Refusals,
        now: Callable[[], float],
        proxies: Container[str] = (),
    ) -> None:
        self.now = now
        self._limits = limits
        self._refusals = refusals
        self._proxies = proxies
        self._rare_log = RareLog(log, now)
        self._ending = Endless("ending a connection", now)
        # All in the order in which they came.
        self._here: dict[Visitor, None] = {}
        self._strangers: dict[Visitor, None] = {}
        self._by_household: dict[str, dict[Visitor, None]] = {}
        self._by_principal: dict[str, dict[Visitor, None]] = {}

    def __len__(self) -> int:
        return len(self._here)

    def come(self, address: str, end: End) -> Visitor | Beyond:
        """Somebody has connected: a stranger, unless there is no room.

        Where there are as many strangers as there may be, in all or of one household, the one of
        them who has been here longest is ended: so whoever shows the token at once comes in,
        however many others only wait.
        """
        most = self._limits.connections
        if len(self._here) >= most:
            beyond = Beyond("connections", f"the service has {most} connections and takes no more")
            self.note(beyond)
            return beyond
        household = None if address in self._proxies else household_of(address)
        self._make_room(household)
        visitor = Visitor(self, household, end)
        self._here[visitor] = self._strangers[visitor] = None
        if household is not None:
            self._by_household.setdefault(household, {})[visitor] = None
        return visitor

    def _make_room(self, household: str | None) -> None:
        """Let there be room for one more stranger of this household."""
        most = self._limits.strangers_per_address
        neighbours = () if household is None else self._by_household.get(household, ())
        if len(neighbours) >= most:
            sentence = (
                f"more than {most} connections from {household} had not shown the token: the "
                "oldest was ended"
            )
            self._end(next(iter(neighbours)), Beyond("strangers_per_address", sentence))
        most = self._limits.strangers
        if len(self._strangers) >= most:
            sentence = f"more than {most} connections had not shown the token: the oldest was ended"
            self._end(next(iter(self._strangers)), Beyond("strangers", sentence))

    def no_stranger(self, visitor: Visitor) -> None:
        """It is not counted as one any more."""
        if visitor not in self._strangers:
            return
        del self._strangers[visitor]
        if visitor.household is not None:
            neighbours = self._by_household[visitor.household]
            del neighbours[visitor]
            if not neighbours:
                del self._by_household[visitor.household]

    def belongs(self, visitor: Visitor, principal: str | None) -> None:
        """It is this principal's; of too many of theirs the one that has been here longest ends.

        A proxy's connection is everybody's.
        """
        if visitor.principal == principal or visitor.household is None:
            return
        self._belongs_to_nobody(visitor)
        if principal is None or visitor not in self._here:
            return
        theirs = self._by_principal.setdefault(principal, {})
        visitor.principal, most = principal, self._limits.connections_per_principal
        theirs[visitor] = None
        if len(theirs) > most:
            oldest = next(iter(theirs))
            self._belongs_to_nobody(oldest)
            sentence = f"somebody had more than {most} connections: the oldest was ended"
            self._end(oldest, Beyond("connections_per_principal", sentence))

    def _belongs_to_nobody(self, visitor: Visitor) -> None:
        if visitor.principal is None:
            return
        theirs = self._by_principal[visitor.principal]
        del theirs[visitor]
        if not theirs:
            del self._by_principal[visitor.principal]
        visitor.principal = None

    def leave(self, visitor: Visitor) -> None:
        """Its connection is gone."""
        self._here.pop(visitor, None)
        self.no_stranger(visitor)
        self._belongs_to_nobody(visitor)

    def end_overdue(self) -> None:
        """End every connection whose client has taken too long for what it owes."""
        for visitor in tuple(self._here):
            beyond = self._overdue(visitor)
            if beyond is not None:
                self._end(visitor, beyond)

    def _overdue(self, visitor: Visitor) -> Beyond | None:
        limits, waited_s = self._limits, self.now() - visitor.since
        if visitor.stuck_for_s() >= limits.stuck_client_s:
            sentence = (
                f"the client took nothing of what it was sent for {limits.stuck_client_s:g} s"
            )
            return Beyond("stuck_client_s", sentence)
        if visitor.phase is ConnectionPhase.HEAD and waited_s >= limits.head_s:
            return Beyond("head_s", f"no request came within {limits.head_s:g} s")
        if visitor.phase is ConnectionPhase.BODY and waited_s >= limits.body_s:
            return Beyond("body_s", f"the request's body did not come within {limits.body_s:g} s")
        return None

    def _end(self, visitor: Visitor, beyond: Beyond) -> None:
        self.note(beyond)
        # So that it is ended once.
        visitor.enter(ConnectionPhase.SERVICE)
        self.no_stranger(visitor)
        # One that cannot be ended must cost no other its end, or its place.
        with self._ending.one_pass():
            visitor.end(beyond)

    def note(self, beyond: Beyond) -> None:
        """Count what was beyond a limit, and say so now and then."""
        self._refusals.note(beyond.limit)
        self._rare_log.warn(beyond.limit, f"{beyond.limit}: {beyond.sentence}")


def visitor_of(scope: Scope) -> Visitor | None:
    """Whose request it is; None where there is no connection, as in a test of the application."""
    visitor = scope.get("state", {}).get(STATE_KEY)
    assert visitor is None or isinstance(visitor, Visitor)
    return visitor
