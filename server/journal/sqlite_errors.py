"""What reading a damaged SQLite file may raise."""

import sqlite3

SQLITE_ERRORS = (sqlite3.Error, UnicodeDecodeError)
"""SQLite quotes a damaged name in its messages, and that need not be text."""
