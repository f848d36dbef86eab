"""What Mend raises on purpose. A message is a clear sentence: what, where, what would be right."""

from collections.abc import Sequence


class MendError(Exception):
    """Root of everything that is raised on purpose."""


class RefusalError(MendError):
    """What was asked for is not done, and whoever asked may read why.

    `limit` names the limit that was reached, if that is why.
    """

    def __init__(self, message: str, *, limit: str | None = None) -> None:
        super().__init__(message)
        self.limit = limit


class WrongInputError(RefusalError):
    """What was given cannot be used; `sentences` has one per mistake where there are several."""

    def __init__(
        self, message: str, sentences: Sequence[str] = (), *, limit: str | None = None
    ) -> None:
        super().__init__(message, limit=limit)
        self.sentences = list(sentences)


class NotFoundError(RefusalError):
    """There is no such thing."""


class ConflictError(RefusalError):
    """The state of the thing does not allow what was asked."""


class UnavailableError(RefusalError):
    """What is needed is not there, or has too much to do, just now or on this machine."""


class UnreadableError(RefusalError):
    """What was stored cannot be read, or is not what was written."""


class IllegalTransitionError(MendError):
    """What is in a state was told to do what that does not allow; nothing was changed."""

    def __init__(self, what: str, state: str, came: str, expected: str) -> None:
        super().__init__(f"{what} is {state}: expected {expected}, but {came} came")
        self.what = what
        self.state = state
        self.came = came
        self.expected = expected
