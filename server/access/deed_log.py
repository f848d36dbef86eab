"""Journals what people do to the service itself; sign-ins are counted, so that none floods it."""

import asyncio
import logging
from collections.abc import Callable, Iterator, Sequence, Set
from contextlib import contextmanager, suppress
from datetime import datetime, timedelta
from uuid import UUID

from mend.server.access.principal import Caller, Principal
from mend.server.access.principals_file import KEPT_CHANGES, PrincipalChange
from mend.server.access.roles import Role
from mend.server.access.sessions import Session, Sessions
from mend.server.access.tally import Tally
from mend.server.journal import events as ev
from mend.server.journal.journal import (
    Entry,
    Journal,
    JournalClosedError,
    JournalReadError,
    JournalWriteError,
    UnreadableEvent,
)

log = logging.getLogger(__name__)

TOLD_EVERY = timedelta(minutes=1)
"""Sign-ins of one principal, and failed ones of everybody, make one event in so long."""

LAST_WORDS_S = 2.0
"""So long a service that stops waits for its journal to take what was told."""

PAGE = 1000


class ToldLaterError(JournalWriteError):
    """Something was done that the journal is told of only later; who asks again does it twice."""


class DeedLog:
    """The deeds of principals as events of the journal, that belong to no run."""

    def __init__(self, journal: Journal, utc_now: Callable[[], datetime]) -> None:
        self._journal = journal
        self._utc_now = utc_now
        self._sign_ins: dict[tuple[str, Role], Tally] = {}
        self._failed = Tally()
        self._told: dict[tuple[str, Role] | None, datetime] = {}
        self._journaled: dict[UUID, None] = {}
        self._ending: dict[str, asyncio.Task[list[ev.Event]]] = {}
        self._writing: set[asyncio.Task[None]] = set()
        self._unreadable: list[str] = []

    # --- What is done -------------------------------------------------------------------------

    @contextmanager
    def changing(self, change: UUID) -> Iterator[None]:
        """Whoever makes a change of this id journals it, and `take_changes` need not.

        If that fails it is taken from the file after all, should it be there.
        """
        self._journaled[change] = None
        try:
            yield
        except BaseException:
            self._journaled.pop(change, None)
            raise

    async def access_changed(self, change: PrincipalChange, author: ev.Author) -> None:
        """Somebody was given access or lost it, through the API; returns once it is journaled.

        Raises `ToldLaterError` where it cannot be now: it is as soon as it can be.
        """
        event = _access_changed(change, author)
        try:
            await self._journal.append(Entry(events=[event]))
        except JournalWriteError as error:
            self._add_later(event)
            raise ToldLaterError(
                "it is done, but the journal has yet to be told; a token or code that was made is "
                f"shown to nobody, so make another: {error}"
            ) from error

    async def signed_out(self, session: Session, caller: Caller, end: Callable[[], None]) -> None:
        """Journal that a session is over, and `end` it; who comes meanwhile waits for the same.

        Raises `JournalWriteError`: the session then lasts.
        """
        if session.id not in self._ending:
            event = ev.SignedOut(
                wall_time=self._utc_now(),
                session=session.id,
                expires=session.expires,
                author=caller.author,
            )
            appended = self._journal.append(Entry(events=[event]), lambda _: end())
            task = self._ending[session.id] = asyncio.create_task(appended)
            task.add_done_callback(lambda _: self._ending.pop(session.id))
        # Whoever goes away takes nothing from the others.
        await asyncio.shield(self._ending[session.id])

    def signed_in(self, principal: Principal, address: str | None) -> None:
        """Somebody has shown a right token to begin a session."""
        who = principal.name, principal.role
        self._sign_ins.setdefault(who, Tally()).add(address)
        self.tell_due()

    def failed(self, address: str | None) -> None:
        """Somebody has shown a wrong token or code."""
        self._failed.add(address)
        self.tell_due()

    # --- What is told together ----------------------------------------------------------------

    def tell_due(self) -> None:
        """Journal what was counted, where the last event about it is long enough ago."""
        now = self._utc_now()
        # A clock that was set back must keep nothing from being told.
        self._told = {who: at for who, at in self._told.items() if abs(now - at) < TOLD_EVERY}
        for who in [each for each in self._sign_ins if each not in self._told]:
            tally = self._sign_ins.pop(who)
            self._add_later(
                ev.SignedIn(principal=who[0], role=who[1], **self._of_tally(tally, who))
            )
        if self._failed.times and None not in self._told:
            tally, self._failed = self._failed, Tally()
            self._add_later(ev.SignInFailed(**self._of_tally(tally, None)))

    def _of_tally(self, tally: Tally, who: tuple[str, Role] | None) -> dict[str, object]:
        self._told[who] = now = self._utc_now()
        return {
            "wall_time": now,
            "times": tally.times,
            "addresses": tally.addresses,
            "elsewhere": tally.elsewhere,
        }

    # --- What the file of principals tells ------------------------------------------------------

    async def recover(self, sessions: Sessions) -> None:
        """Read what was journaled before: which sessions have ended, which changes are known.

        What cannot be read is left out, and told in `unreadable`.
        """
        after = 0
        try:
            while events := await self._journal.read_readable(after, PAGE, ev.NO_RUN):
                for event in events:
                    self._recall(event, sessions)
                after = events[-1].seq
        except JournalReadError as error:
            self._cannot_read(f"what belongs to no run cannot be read after event {after}: {error}")

    def _recall(self, event: ev.Event | UnreadableEvent, sessions: Sessions) -> None:
        match event:
            case UnreadableEvent(why=why):
                self._cannot_read(why)
            case ev.SignedOut(session=number, expires=expires):
                sessions.end(number, expires)
            case ev.AccessChanged(change=UUID() as change):
                self._journaled[change] = None

    def _cannot_read(self, why: str) -> None:
        log.error("%s", why)
        self._unreadable.append(why)

    @property
    def unreadable(self) -> Sequence[str]:
        """A sentence for each event that belongs to no run and could not be read."""
        return tuple(self._unreadable)

    def take_changes(self, changes: Sequence[PrincipalChange]) -> None:
        """Journal what was done to the file and is not in the journal, each change once.

        That is what was done on this machine, and what a kill kept the service from journaling.
        """
        for change in changes:
            if change.id not in self._journaled:
                self._journaled[change.id] = None
                by = ev.Author(principal=change.by, role=change.by_role, address=change.address)
                self._add_later(_access_changed(change, by))
        if len(self._journaled) > 2 * KEPT_CHANGES:
            self._forget_old({each.id for each in changes})

    def _forget_old(self, there: Set[UUID]) -> None:
        """Of what the file has no longer the latest is remembered: an older file may come back."""
        gone = [each for each in self._journaled if each not in there]
        for change in gone[:-KEPT_CHANGES]:
            del self._journaled[change]

    # --- Writing ------------------------------------------------------------------------------

    def _add_later(self, event: ev.Event) -> None:
        """Journal it as soon as that is possible; nobody waits for it."""
        task = asyncio.create_task(self._add_patiently(event))
        self._writing.add(task)
        task.add_done_callback(self._writing.discard)

    async def _add_patiently(self, event: ev.Event) -> None:
        with suppress(JournalClosedError):
            await self._journal.append(Entry(events=[event]), patient=True)

    async def written(self) -> None:
        """Wait until what was told is journaled."""
        await asyncio.gather(*self._writing)

    async def close(self) -> None:
        """Journal what was only counted so far, if that is possible now."""
        self._told.clear()
        self.tell_due()
        if self._writing:
            await asyncio.wait(self._writing, timeout=LAST_WORDS_S)
        for task in self._writing:
            task.cancel()
        await asyncio.gather(*self._writing, return_exceptions=True)


def _access_changed(change: PrincipalChange, author: ev.Author) -> ev.AccessChanged:
    return ev.AccessChanged(
        wall_time=change.when,
        what=change.what,
        principal=change.name,
        role=change.role,
        author=author,
        change=change.id,
    )
