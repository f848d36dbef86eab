"""Failures of a command: what users read on stderr instead of a traceback, and exit codes."""

from collections.abc import Iterator
from contextlib import contextmanager

from mend.localization.logs.log import LogError
from mend.localization.pictures.failure import PictureError
from mend.localization.scan import InvalidScanError
from mend.maps.vector_map import VectorMapError
from mend.robots.vision.color_model import ColorModelError
from mend.server.access.principals_file import PrincipalsFileError
from mend.server.errors import InvalidError, ServiceError
from mend.server.journal.backup import BackupError
from mend.server.journal.file_lock import JournalLockedError
from mend.server.journal.journal import JournalOpenError, JournalReadError
from mend.server.journal.migrations import JournalSchemaError
from mend.server.settings import WrongSettingsError
from mend.sim.world import WorldUnavailableError
from mend.tasks.library import NotInLibraryError
from mend.tasks.plugins import PluginError
from mend.tasks.problem import InvalidFileError

NOT_FINISHED = 1
"""Exit code: the task did not finish, or a checked file is wrong."""
WRONG_INPUT = 2
"""Exit code: what was asked for cannot be done."""
INTERRUPTED = 130
"""Exit code: Ctrl-C (128 and the number of SIGINT, as shells have it)."""

KNOWN_ERRORS = (
    ColorModelError,
    InvalidFileError,
    InvalidScanError,
    BackupError,
    JournalLockedError,
    JournalOpenError,
    JournalReadError,
    JournalSchemaError,
    LogError,
    NotInLibraryError,
    PictureError,
    PluginError,
    PrincipalsFileError,
    ServiceError,
    VectorMapError,
    WorldUnavailableError,
    WrongSettingsError,
)


class CommandLineError(Exception):
    """A command cannot go on; the message has one clear sentence per line."""

    def __init__(self, message: str, exit_code: int = WRONG_INPUT) -> None:
        super().__init__(message)
        self.exit_code = exit_code


@contextmanager
def told_plainly() -> Iterator[None]:
    """Turn the errors that explain themselves into a `CommandLineError`."""
    try:
        yield
    except InvalidError as error:
        raise CommandLineError("\n".join([str(error), *error.problems])) from error
    except KNOWN_ERRORS as error:
        raise CommandLineError(str(error)) from error
    except OSError as error:
        subject = f"'{error.filename}': " if error.filename else ""
        raise CommandLineError(f"{subject}{error.strerror or error}") from error
