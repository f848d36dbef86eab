"""Who runs a command: the user of the operating system."""

import getpass
import os

from mend.server.access.roles import Role
from mend.server.journal.events import Author


def local_user() -> str:
    """The user's name, or their number where they have none."""
    try:
        return getpass.getuser()
    except (ImportError, KeyError, OSError):
        return f"uid {os.getuid()}"


def local_author() -> Author:
    """How the journal names them: whoever runs a service of their own may do everything there."""
    return Author(principal=local_user(), role=Role.ADMIN)
