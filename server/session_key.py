"""The key that browser sessions are signed with, kept so that they survive a restart."""

import logging
import os
from pathlib import Path

from mend.server.access.sessions import KEY_BYTES, new_session_key
from mend.server.journal.file_mode import OWNERS_FILE

log = logging.getLogger(__name__)


def session_key(file: Path) -> bytes:
    """The key in the file, which is made when there is none.

    Where it cannot be read or kept, a new one lasts until the service stops.
    """
    try:
        key = file.read_bytes()
        if len(key) == KEY_BYTES:
            return key
    except FileNotFoundError:
        pass
    except OSError as error:
        return _for_now(file, "read", error)
    key = new_session_key()
    try:
        _keep(key, file)
    except OSError as error:
        return _for_now(file, "kept", error)
    return key


def _keep(key: bytes, file: Path) -> None:
    """All of it or nothing, and never readable by others."""
    half = file.with_name(f"{file.name}.new")
    half.unlink(missing_ok=True)
    descriptor = os.open(half, os.O_WRONLY | os.O_CREAT | os.O_EXCL, OWNERS_FILE)
    with os.fdopen(descriptor, "wb") as written:
        written.write(key)
    half.replace(file)


def _for_now(file: Path, done: str, error: OSError) -> bytes:
    log.warning(
        "%s cannot be %s (%s): browsers have to sign in again after the next start",
        file, done, error.strerror,
    )  # fmt: skip
    return new_session_key()
