"""Failures of a command: what users read on stderr instead of a traceback, and exit codes."""

from collections.abc import Iterator
from contextlib import contextmanager

from mend.errors import IllegalTransitionError, MendError, WrongInputError

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
    except IllegalTransitionError:
        raise  # A defect, whose traceback is wanted.
    except MendError as error:
        more = error.sentences if isinstance(error, WrongInputError) else []
        raise CommandLineError("\n".join([str(error), *more])) from error
    except OSError as error:
        subject = f"'{error.filename}': " if error.filename else ""
        raise CommandLineError(f"{subject}{error.strerror or error}") from error
