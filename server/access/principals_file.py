"""The file of principals: who there is, with hashes of their tokens; read, checked and changed."""

import fcntl
import os
import tempfile
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path
from typing import Annotated, Any, Literal, Self
from uuid import UUID

import yaml
from pydantic import (
    AwareDatetime,
    BaseModel,
    ConfigDict,
    Field,
    StringConstraints,
    ValidationError,
    model_validator,
)
from pydantic_core import ErrorDetails

from mend.documents.plain_mistakes import what_it_must_be
from mend.documents.spellings import SEEN_CHARACTERS, SHA256, SHORT_ID
from mend.documents.validation import what_is_right
from mend.errors import MendError
from mend.robots.link.shown_name import SHOWN
from mend.server.access.principal import RESERVED
from mend.server.access.roles import Role
from mend.server.journal.file_mode import OWNERS_FOLDER, keep_to_owner

HEADING = "# Written by `mend access`. Tokens are not in here, only their hashes.\n"
KEPT_CHANGES = 1000
"""So many changes are kept here for a service that has not yet journaled them."""

MAX_DEPTH = 100
"""Of mappings and lists within one another; what is right needs three."""

MOST_TOLD = 50
"""So many mistakes are told of one file."""

KEY_CHARS = 100
"""Of a longer key only the beginning is told."""

LOADER: type[Any] = getattr(yaml, "CSafeLoader", yaml.SafeLoader)

PrincipalName = Annotated[
    str, StringConstraints(min_length=1, max_length=64, pattern=SEEN_CHARACTERS), SHOWN
]
RobotName = Annotated[
    str, StringConstraints(min_length=1, max_length=128, pattern=SEEN_CHARACTERS), SHOWN
]
Sha256 = Annotated[str, StringConstraints(pattern=SHA256)]


class PrincipalsFileError(MendError):
    """The file of principals cannot be used; one sentence per mistake."""


class UnreadablePrincipalsError(PrincipalsFileError):
    """The file of principals could not be read this time, whatever is in it."""


class FileModel(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class KeptPrincipal(FileModel):
    """One principal; `id` is the part of its token that finds it."""

    name: RobotName
    role: Role
    id: Annotated[str, StringConstraints(pattern=SHORT_ID)]
    sha256: Sha256
    added: AwareDatetime
    expires: AwareDatetime | None = None

    def valid(self, now: datetime) -> bool:
        """Whether its token is still good."""
        return self.expires is None or self.expires > now


class Enrolment(FileModel):
    """That a robot may fetch its credential once, with a code, until it `expires`."""

    robot: RobotName
    sha256: Sha256
    expires: AwareDatetime


What = Literal["added", "rotated", "revoked", "enrolment_opened", "enrolled"]


class PrincipalChange(FileModel):
    """What was done to the file, and `by` whom.

    That is a user of the operating system, who counts as an admin, or through the API a principal,
    with the role that it had and its `address`.
    """

    id: UUID
    when: AwareDatetime
    by: str
    by_role: Role = Role.ADMIN
    address: str | None = None
    what: What
    name: RobotName
    role: Role


class Principals(FileModel):
    """Everything that the file holds; `changes` are for the service to journal."""

    principals: list[KeptPrincipal] = []
    enrolments: list[Enrolment] = []
    changes: Annotated[list[PrincipalChange], Field(max_length=KEPT_CHANGES)] = []

    @model_validator(mode="after")
    def _each_once(self) -> Self:
        for what in ("name", "id"):
            seen = Counter(getattr(each, what) for each in self.principals)
            twice = next((each for each, times in seen.items() if times > 1), None)
            if twice is not None:
                raise ValueError(f"two principals have the {what} '{twice}'; each needs its own")
        reserved = next((each.name for each in self.principals if each.name in RESERVED), None)
        if reserved is not None:
            raise ValueError(f"no principal can be called '{reserved}'; take another name")
        return self

    def named(self, name: str) -> KeptPrincipal | None:
        """The principal of that name."""
        return next((each for each in self.principals if each.name == name), None)


def read_principals(path: Path) -> Principals:
    """What the file says; nobody where there is none.

    Raises `PrincipalsFileError` with every mistake, and `UnreadablePrincipalsError`.
    """
    unreadable = f"The principals in {path} cannot be read"
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        return Principals()
    except OSError as error:
        raise UnreadablePrincipalsError(f"{unreadable}: {error.strerror}.") from error
    except UnicodeDecodeError as error:
        raise PrincipalsFileError(f"{unreadable}: it is not UTF-8.") from error
    return principals_of(text, str(path))


def principals_of(text: str, source: str) -> Principals:
    """What the text of such a file says. Raises `PrincipalsFileError`."""
    try:
        # As the file is written: with YAML 1.2's numbers an id such as 6798e113 would be one.
        _refuse_depth(text, source)
        loaded = yaml.load(text, LOADER)
    except yaml.YAMLError as error:
        where = getattr(error, "problem_mark", None)
        # Where the text ends one reader says the last line, and the other the one after it.
        line = "" if where is None else f", line {min(where.line, text.count(chr(10))) + 1}"
        raise PrincipalsFileError(f"{source}{line}: this is not YAML.") from error
    except RecursionError as error:
        raise PrincipalsFileError(f"{source}: something in it is nested too deeply.") from error
    except (ValueError, TypeError, AttributeError) as error:
        # Numbers with too many digits, days that no month has, a mapping as a key.
        raise PrincipalsFileError(f"{source}: a value in it cannot be read.") from error
    if not isinstance(loaded, dict | None):
        raise PrincipalsFileError(f"{source}: a file of principals has the key 'principals'.")
    try:
        return Principals.model_validate(loaded or {})
    except ValidationError as error:
        sentences = dict.fromkeys(_sentence(source, each) for each in error.errors())
        told = list(sentences)[:MOST_TOLD]
        if len(sentences) > MOST_TOLD:
            told.append(f"{source}: and {len(sentences) - MOST_TOLD} more mistakes.")
        raise PrincipalsFileError("\n".join(told)) from error
    except RecursionError as error:
        raise PrincipalsFileError(f"{source}: something in it is nested too deeply.") from error


def _refuse_depth(text: str, source: str) -> None:
    """Raise `PrincipalsFileError`: LibYAML's reader would crash the process."""
    depth = 0
    for event in yaml.parse(text, LOADER):
        depth += isinstance(event, yaml.CollectionStartEvent)
        depth -= isinstance(event, yaml.CollectionEndEvent)
        if depth > MAX_DEPTH:
            raise PrincipalsFileError(f"{source}: something in it is nested too deeply.")


def _sentence(source: str, mistake: ErrorDetails) -> str:
    where = ".".join(str(each)[:KEY_CHARS] for each in mistake["loc"])
    if mistake["type"] in ("extra_forbidden", "missing"):
        return f"{source}: {where}: {what_it_must_be(mistake)}."
    if mistake["type"] == "value_error" and not where:
        return f"{source}: {what_it_must_be(mistake)}."
    return f"{source}: {where}: {what_is_right([mistake], None)}."


class Edit:
    """The file's content while nobody else may change it; what `principals` is then, is kept."""

    def __init__(self, principals: Principals) -> None:
        self.principals = principals


@contextmanager
def edited(path: Path) -> Iterator[Edit]:
    """Change the file, alone: it is replaced as a whole, or not at all.

    Raises `PrincipalsFileError` where it has mistakes, `OSError` where it cannot be written.
    """
    path.parent.mkdir(mode=OWNERS_FOLDER, parents=True, exist_ok=True)
    lock = path.with_name(path.name + ".lock")
    keep_to_owner(lock)
    _give_to_owner_of_folder(lock)
    with lock.open("w") as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        edit = Edit(read_principals(path))
        before = edit.principals
        yield edit
        if edit.principals != before:
            _replace(path, edit.principals)


def _replace(path: Path, principals: Principals) -> None:
    checked = Principals.model_validate(principals.model_dump())
    text = yaml.safe_dump(checked.model_dump(mode="json", exclude_none=True), sort_keys=False)
    with tempfile.NamedTemporaryFile(
        "w", encoding="utf-8", dir=path.parent, prefix=path.name, delete=False
    ) as written:
        try:
            written.write(HEADING + text)
            written.flush()
            os.fsync(written.fileno())
            _give_to_owner_of_folder(Path(written.name))
            Path(written.name).replace(path)
        except BaseException:
            Path(written.name).unlink(missing_ok=True)
            raise


def _give_to_owner_of_folder(file: Path) -> None:
    """What root writes is for the service, which runs as whoever has the folder."""
    if os.geteuid() == 0:
        folder = file.parent.stat()
        os.chown(file, folder.st_uid, folder.st_gid)
