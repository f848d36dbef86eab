"""What a robot answers to a command that it cannot carry out."""

from mend.errors import MendError


class CommandError(MendError):
    """A command cannot be carried out; the message says why."""
