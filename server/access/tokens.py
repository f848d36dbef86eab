"""Tokens and one-time codes: how they are made, and what is kept of them.

A token has 256 random bits, so that nobody can guess it from its hash: one round of SHA-256 is
enough, and takes about a microsecond per request. A slow hash is for what people choose.
"""

import base64
import hashlib
import secrets
from dataclasses import dataclass

MARK = "mend"
SECRET_BYTES = 32
CODE_BYTES = 15
LONGEST_DAYS = 3650
"""For which a token may be good."""


@dataclass(frozen=True, slots=True)
class NewToken:
    """A token that was just made; `text` is shown once and kept nowhere."""

    id: str
    text: str
    sha256: str


def new_token() -> NewToken:
    """A token for a principal; its `id` is part of it and finds who it belongs to."""
    number = secrets.token_hex(4)
    text = f"{MARK}_{number}_{secrets.token_urlsafe(SECRET_BYTES)}"
    return NewToken(number, text, fingerprint(text))


def id_in(token: str) -> str | None:
    """The id that a token names; None for what is no token of a principal."""
    parts = token.split("_", 2)
    return parts[1] if len(parts) == 3 and parts[0] == MARK else None


def bytes_of(shown: str) -> bytes:
    """What somebody shows as bytes, whatever characters they put into it."""
    return shown.encode("utf-8", "surrogatepass")


def fingerprint(text: str) -> str:
    """What is kept of a token or a code."""
    return hashlib.sha256(bytes_of(text)).hexdigest()


def fits(text: str, sha256: str) -> bool:
    """Whether this is the text of a fingerprint, in a time that tells nothing about it."""
    return secrets.compare_digest(fingerprint(text), sha256)


def new_code() -> str:
    """A one-time code of 120 random bits that a person can type: `ABCD-EFGH-...`."""
    letters = base64.b32encode(secrets.token_bytes(CODE_BYTES)).decode()
    return "-".join(letters[at : at + 4] for at in range(0, len(letters), 4))


def plain_code(typed: str) -> str:
    """A code as it was made, however somebody typed it."""
    letters = "".join(each for each in typed.upper() if each.isalnum())
    return "-".join(letters[at : at + 4] for at in range(0, len(letters), 4))
