"""Names of files in a model's archive, and what files of it name each other by."""

import posixpath
import re

from mend.errors import WrongInputError

URDF = "robot.urdf"
MESHES = frozenset({".stl", ".dae", ".obj"})
PICTURES = frozenset({".png", ".jpg", ".jpeg"})

SAFE = re.compile(r"[A-Za-z0-9_.+@,=() -]+(?:/[A-Za-z0-9_.+@,=() -]+)*")
"""What is the same in an address as in a file, whoever reads it."""

LONGEST = 200
PACKAGE = "package://"


def kind_of(name: str) -> str:
    """How a file's name ends, in small letters."""
    return posixpath.splitext(name)[1].lower()


def refuse_unsafe(name: str) -> None:
    """Raises `WrongInputError` for a file that would not stay in its archive."""
    parts = name.split("/")
    wrong = len(name) > LONGEST or name.startswith("/") or "\\" in name or ".." in parts
    if wrong or any(ord(each) < ord(" ") for each in name):
        raise WrongInputError(
            f"the archive has a file {name[:LONGEST]!r}: names are relative, with / between "
            f"folders, without .. and control characters, and have at most {LONGEST} characters"
        )


def named_file(said: str, by: str, kinds: frozenset[str]) -> str:
    """The file of the archive that a file of it, `by`, says. Raises `WrongInputError`.

    `package://NAME/file` is the file in a folder of that name; all else is relative to who says it.
    """
    if said.startswith(PACKAGE):
        path = posixpath.normpath(said.removeprefix(PACKAGE))
    else:
        path = posixpath.normpath(posixpath.join(posixpath.dirname(by), said))
    if ":" in said.removeprefix(PACKAGE) or said.startswith("/"):
        raise WrongInputError(
            f"{by} names {_short(said)}: only files of the archive may be named, relative or with "
            f"{PACKAGE}"
        )
    if path.startswith("..") or len(path) > LONGEST or SAFE.fullmatch(path) is None:
        raise WrongInputError(
            f"{by} names {_short(said)}: it has to be within the archive, and of letters, digits "
            "and _ . + @ , = ( ) - with / between folders"
        )
    if kind_of(path) not in kinds:
        raise WrongInputError(
            f"{by} names {_short(said)}: it has to be one of {', '.join(sorted(kinds))}"
        )
    return path


def _short(said: str) -> str:
    return repr(said if len(said) <= LONGEST else f"{said[:LONGEST]}...")
