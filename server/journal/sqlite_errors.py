"""What reading a damaged SQLite file may raise, and reading on beside that."""

import sqlite3

SQLITE_ERRORS = (sqlite3.Error, UnicodeDecodeError)
"""SQLite quotes a damaged name in its messages, and that need not be text."""


def text_or_marks(raw: bytes) -> str:
    """Text with marks for whatever is none: a `text_factory` that finds it and stops at nothing."""
    return raw.decode("utf-8", "replace")
