"""The principals that a running service knows: the file, read again whenever it has changed."""

import asyncio
import logging
from collections.abc import Callable, Sequence
from datetime import UTC, datetime
from pathlib import Path

from mend.server.access.principal import Principal
from mend.server.access.principals_file import (
    KeptPrincipal,
    PrincipalChange,
    Principals,
    PrincipalsFileError,
    UnreadablePrincipalsError,
    read_principals,
)
from mend.server.access.roles import Role
from mend.server.access.tokens import fits, id_in

log = logging.getLogger(__name__)

Stamp = tuple[int, int, int]


class KnownPrincipals:
    """Who may come in with a token of their own.

    Raises `PrincipalsFileError` if the file has mistakes when the service starts; mistakes that
    come later are logged, and whoever was known before stays known. So do they while the file
    cannot be read, which is tried again at every look. A file that is gone means nobody.
    `expected`: there is to be a file, even if there is none yet.
    """

    def __init__(
        self, path: Path | None, wall_time_s: Callable[[], float], *, expected: bool = False
    ) -> None:
        self.path = path
        self._wall_time_s = wall_time_s
        self._expected = expected
        self._reading = asyncio.Lock()
        self._told: str | None = None
        self._stamp = self._stamp_now()
        self._take(Principals() if path is None else read_principals(path))

    @property
    def required(self) -> bool:
        """Whether principals are used here, so that nobody comes in without a token."""
        return self._expected or self._stamp is not None

    @property
    def changes(self) -> Sequence[PrincipalChange]:
        """What was done to the file on this machine, the latest ones."""
        return self._principals.changes

    def all(self) -> Sequence[KeptPrincipal]:
        """Everybody, also those whose token has expired."""
        return self._principals.principals

    async def look(self) -> bool:
        """Read the file again if it has changed, beside the event loop; says whether it had.

        Whoever looks meanwhile waits for that.
        """
        if self._stamp_now() == self._stamp:
            return False
        # Whoever has once used principals does not want an open service because the file is gone.
        self._expected = True
        async with self._reading:
            stamp = self._stamp_now()
            if stamp == self._stamp:
                return False
            assert self.path is not None, "without a path there is no stamp"
            try:
                self._take(await asyncio.to_thread(read_principals, self.path))
            except UnreadablePrincipalsError as error:
                self._tell(error)
                return False
            except PrincipalsFileError as error:
                self._tell(error)
            else:
                self._told = None
            self._stamp = stamp
        return True

    def _tell(self, error: PrincipalsFileError) -> None:
        """Say it once, however often it is found."""
        if str(error) != self._told:
            self._told = str(error)
            log.error("The principals stay as they were: %s", error)

    def of_token(self, token: str) -> Principal | None:
        """Whose token it is, if it is still good."""
        found = self._by_id.get(id_in(token) or "")
        if found is None or not fits(token, found.sha256):
            return None
        return self._principal(found)

    def of_name(self, name: str) -> Principal | None:
        """The principal of that name, if its token is still good."""
        found = self._by_name.get(name)
        return None if found is None else self._principal(found)

    def has_robot(self, name: str) -> bool:
        """Whether a robot of that name has a credential of its own, also one that has expired."""
        found = self._by_name.get(name)
        return found is not None and found.role is Role.ROBOT

    def _principal(self, kept: KeptPrincipal) -> Principal | None:
        if not kept.valid(datetime.fromtimestamp(self._wall_time_s(), UTC)):
            return None
        return Principal(kept.name, kept.role, kept.sha256)

    def _take(self, principals: Principals) -> None:
        self._principals = principals
        self._by_id = {each.id: each for each in principals.principals}
        self._by_name = {each.name: each for each in principals.principals}

    def _stamp_now(self) -> Stamp | None:
        if self.path is None:
            return None
        try:
            found = self.path.stat()
        except OSError:
            # What cannot be looked at names nobody.
            return None
        return found.st_mtime_ns, found.st_size, found.st_ino
