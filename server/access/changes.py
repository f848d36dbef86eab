"""What is done to the file of principals: adding, rotating, revoking, and enrolling robots."""

import unicodedata
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from pathlib import Path
from uuid import UUID, uuid4

from mend.errors import ConflictError, NotFoundError, RefusalError, WrongInputError
from mend.robots.link.shown_name import can_be_shown
from mend.server.access.principal import RESERVED
from mend.server.access.principals_file import (
    KEPT_CHANGES,
    Enrolment,
    KeptPrincipal,
    PrincipalChange,
    Principals,
    What,
    edited,
)
from mend.server.access.roles import Role, with_article
from mend.server.access.tokens import fingerprint, fits, new_code, new_token, plain_code

LONGEST_NAME = 64
LONGEST_ROBOT_NAME = 128


class EnrolmentRefusedError(RefusalError):
    """A robot's code is wrong, used, or too old."""


@dataclass(frozen=True, slots=True)
class PrincipalsEditor:
    """Changes the file at `path`, on behalf of `by`, who has a `role` and comes from an `address`.

    The file remembers what was done, for the service to journal: also when that is killed before
    it can. A `change_id` is for one change alone; `made` has those that were made. Everything
    raises `PrincipalsFileError` where the file has mistakes and `OSError` where it cannot be
    written.
    """

    path: Path
    by: str
    role: Role = Role.ADMIN
    address: str | None = None
    change_id: UUID | None = None
    made: list[PrincipalChange] = field(default_factory=list)

    def add(self, name: str, role: Role, now: datetime, expires_days: float | None = None) -> str:
        """Add a principal and return its token.

        Raises `ConflictError` if the name is taken, `WrongInputError` if it cannot be one.
        """
        _refuse_name(name, LONGEST_NAME)
        with edited(self.path) as edit:
            if edit.principals.named(name) is not None:
                raise ConflictError(
                    f"there is a principal '{name}' already: rotate its token, or revoke it first"
                )
            token, kept = _made(name, role, now, _after(now, expires_days))
            edit.principals = self._changed(edit.principals, [], [kept], now, "added", kept)
        return token

    def rotate(self, name: str, now: datetime, expires_days: float | None = None) -> str:
        """Give a principal a new token and return it; the old one is good no longer.

        Without `expires_days` it lasts as long from now as the old one did from its beginning.
        Raises `NotFoundError`.
        """
        with edited(self.path) as edit:
            old = _found(edit.principals, name)
            expires = _after(now, expires_days)
            if expires is None and old.expires is not None:
                expires = now + (old.expires - old.added)
            token, kept = _made(name, old.role, now, expires)
            edit.principals = self._changed(edit.principals, [old], [kept], now, "rotated", kept)
        return token

    def revoke(self, name: str, now: datetime) -> Role:
        """End a principal, or the code that a robot was given, and return its role.

        Raises `NotFoundError`.
        """
        with edited(self.path) as edit:
            codes = [each for each in edit.principals.enrolments if each.robot == name]
            old = edit.principals.named(name)
            role = Role.ROBOT if old is None and codes else _found(edit.principals, name).role
            kept = [each for each in edit.principals.principals if each is not old]
            left = [each for each in edit.principals.enrolments if each not in codes]
            changed = edit.principals.model_copy(update={"principals": kept, "enrolments": left})
            edit.principals = self._noted(changed, now, "revoked", name, role)
        return role

    def open_enrolment(self, robot: str, now: datetime, minutes: float) -> str:
        """Let a robot fetch its credential once, and return the code for that.

        A code that it was given before is good no longer; a credential that it has is, until the
        new one is fetched. Raises `ConflictError` if a person has the name, `WrongInputError` if it
        cannot be one.
        """
        _refuse_name(robot, LONGEST_ROBOT_NAME)
        with edited(self.path) as edit:
            _refuse_person(edit.principals, robot)
            code = new_code()
            kept = _enrolment(robot, code, now + timedelta(minutes=minutes))
            others = [each for each in edit.principals.enrolments if each.robot != robot]
            opened = edit.principals.model_copy(update={"enrolments": [*others, kept]})
            edit.principals = self._noted(opened, now, "enrolment_opened", robot, Role.ROBOT)
        return code

    def enrol(self, robot: str, code: str, now: datetime) -> str:
        """Take a robot's code, for ever, and return the robot's new credential.

        Raises `EnrolmentRefusedError`.
        """
        with edited(self.path) as edit:
            open_ones = [each for each in edit.principals.enrolments if each.expires > now]
            found = next((each for each in open_ones if each.robot == robot), None)
            if found is None or not fits(plain_code(code), found.sha256):
                raise EnrolmentRefusedError(
                    f"this code does not enrol the robot '{robot}': codes are good once and for a "
                    f"short time; make a new one with 'mend access enrol'"
                )
            _refuse_person(edit.principals, robot)
            token, kept = _made(robot, Role.ROBOT, now, None)
            left = [each for each in open_ones if each is not found]
            rest = edit.principals.model_copy(update={"enrolments": left})
            old = rest.named(robot)
            edit.principals = self._changed(
                rest, [old] if old else [], [kept], now, "enrolled", kept
            )
        return token

    def _changed(
        self,
        principals: Principals,
        without: list[KeptPrincipal],
        more: list[KeptPrincipal],
        now: datetime,
        what: What,
        whom: KeptPrincipal,
    ) -> Principals:
        kept = [each for each in principals.principals if each not in without]
        changed = principals.model_copy(update={"principals": [*kept, *more]})
        return self._noted(changed, now, what, whom.name, whom.role)

    def _noted(
        self, principals: Principals, now: datetime, what: What, name: str, role: Role
    ) -> Principals:
        change = PrincipalChange(
            id=self.change_id or uuid4(),
            when=now,
            by=self.by,
            by_role=self.role,
            address=self.address,
            what=what,
            name=name,
            role=role,
        )
        self.made.append(change)
        latest = [*principals.changes, change][-KEPT_CHANGES:]
        return principals.model_copy(update={"changes": latest})


def _refuse_name(name: str, longest: int) -> None:
    if unicodedata.normalize("NFKC", name).strip().casefold() in RESERVED:
        raise WrongInputError(
            f"nobody can be called '{name}': that is what the service calls others"
        )
    if not 0 < len(name) <= longest or not can_be_shown(name):
        raise WrongInputError(
            f"a name has 1 to {longest} characters that can be seen, and no blank at its ends"
        )
    if "/" in name or name in (".", ".."):
        raise WrongInputError(f"nobody can be called '{name}': a name has no '/'")


def _enrolment(robot: str, code: str, expires: datetime) -> Enrolment:
    return Enrolment(robot=robot, sha256=fingerprint(code), expires=expires)


def _made(
    name: str, role: Role, now: datetime, expires: datetime | None
) -> tuple[str, KeptPrincipal]:
    token = new_token()
    kept = KeptPrincipal(
        name=name, role=role, id=token.id, sha256=token.sha256, added=now, expires=expires
    )
    return token.text, kept


def _after(now: datetime, days: float | None) -> datetime | None:
    return None if days is None else now + timedelta(days=days)


def _found(principals: Principals, name: str) -> KeptPrincipal:
    found = principals.named(name)
    if found is None:
        known = ", ".join(each.name for each in principals.principals) or "none"
        raise NotFoundError(f"there is no principal '{name}' (there are: {known})")
    return found


def _refuse_person(principals: Principals, robot: str) -> None:
    found = principals.named(robot)
    if found is not None and found.role is not Role.ROBOT:
        raise ConflictError(
            f"'{robot}' is the name of {with_article(found.role)} already; choose another"
        )
