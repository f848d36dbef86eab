"""The key that browser sessions are signed with, kept so that they survive a restart."""

import logging
from pathlib import Path

from mend.server.access.sessions import KEY_BYTES, new_session_key
from mend.server.kept_secret import keep_secret

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
        keep_secret(key, file)
    except OSError as error:
        return _for_now(file, "kept", error)
    return key


def _for_now(file: Path, done: str, error: OSError) -> bytes:
    log.warning(
        "%s cannot be %s (%s): browsers have to sign in again after the next start",
        file, done, error.strerror,
    )  # fmt: skip
    return new_session_key()
