"""Failures of a command: what users read on stderr instead of a traceback, and exit codes."""

from collections.abc import Iterator
from contextlib import contextmanager

NOT_FINISHED = 1
"""Exit code: the task did not finish, or a checked file is wrong."""
WRONG_INPUT = 2
"""Exit code: what was asked for cannot be done."""
INTERRUPTED = 130
"""Exit code: Ctrl-C (128 and the number of SIGINT, as shells have it)."""


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
    except (CommandLineError, KeyboardInterrupt):
        raise
    except OSError as error:
        subject = f"'{error.filename}': " if error.filename else ""
        raise CommandLineError(f"{subject}{error.strerror or error}") from error
    except Exception as error:
        # Imported only here: they are of all folders, and few commands fail.
        from mend.server.cli.known_errors import KNOWN_ERRORS
        from mend.server.errors import InvalidError

        if not isinstance(error, KNOWN_ERRORS):
            raise
        problems = error.problems if isinstance(error, InvalidError) else ()
        raise CommandLineError("\n".join([str(error), *problems])) from error
