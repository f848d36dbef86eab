"""Who asks for what is being done: for what has to be shared out between those who do."""

from contextvars import ContextVar

NOBODY = ""
"""The service itself, and whoever need not say who they are."""

asker: ContextVar[str] = ContextVar("asker", default=NOBODY)
"""The name of the principal on whose behalf the current task works."""
