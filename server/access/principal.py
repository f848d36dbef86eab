"""A principal: somebody whom the service knows by what they show."""

from dataclasses import dataclass

from mend.server.access.roles import Role
from mend.server.journal.events import Author
from mend.server.journal.keyed_request import KeyedAuthor, KeyedRequest


@dataclass(frozen=True, slots=True)
class Principal:
    """Who it is and what they may do.

    `key` changes with the credential: what is bound to it ends with that. Without a `named` one
    whoever comes says what they are called.
    """

    name: str
    role: Role
    key: str
    named: bool = True


ANYBODY = Principal("anybody", Role.ADMIN, "", named=False)
"""Whoever can reach a service that asks for no token."""

TOKEN_NAME = "token"
"""The name of whoever shows the service's one token (`MEND_TOKEN`)."""

RESERVED = (ANYBODY.name, TOKEN_NAME)
SCRIPT = "script"
"""The helper whose answers a run was given beforehand."""


@dataclass(frozen=True, slots=True)
class Caller:
    """A principal on one connection; `session` is the cookie's, if it came by one.

    `until`: when that session expires, in seconds of 1970. `request` is the one that they make, if
    it came under an idempotency key.
    """

    principal: Principal
    address: str | None = None
    session: str | None = None
    until: float | None = None
    request: KeyedRequest | None = None

    @property
    def author(self) -> Author:
        """How the journal names them."""
        who = {
            "principal": self.principal.name,
            "role": self.principal.role,
            "address": self.address,
        }
        if self.request is None:
            return Author.model_validate(who)
        return KeyedAuthor.model_validate({**who, "request": self.request})

    def helper_name(self, declared: str | None) -> str | None:
        """What a helper is called: a principal's own name, else what they say; None without."""
        return self.principal.name if self.principal.named else declared
