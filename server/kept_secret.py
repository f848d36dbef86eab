"""Secrets that the service makes itself, each in a file that its owner alone can read."""

import os
from pathlib import Path

from mend.server.journal.file_mode import OWNERS_FILE


def keep_secret(secret: bytes, file: Path) -> None:
    """Write all of it or nothing, never readable by others. Raises `OSError`."""
    half = file.with_name(f"{file.name}.new")
    half.unlink(missing_ok=True)
    descriptor = os.open(half, os.O_WRONLY | os.O_CREAT | os.O_EXCL, OWNERS_FILE)
    with os.fdopen(descriptor, "wb") as written:
        written.write(secret)
    half.replace(file)
