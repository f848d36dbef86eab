"""Who may read a journal: its owner alone, as it holds names, pictures and what people said."""

from contextlib import suppress
from pathlib import Path

OWNERS_FILE = 0o600
OWNERS_FOLDER = 0o700


def keep_to_owner(file: Path) -> None:
    """Make a file that only its owner can read, also if it is there already. Raises `OSError`.

    SQLite gives the files that it makes beside a database the mode of the database.
    """
    # Who may write to somebody else's file cannot change its mode, and need not.
    with file.open("ab"), suppress(PermissionError):
        file.chmod(OWNERS_FILE)
