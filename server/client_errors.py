"""What goes wrong for a client of the service; each message is one sentence for people."""

from mend.errors import MendError
from mend.server.api.helper_messages import Error
from mend.server.api.problem import Problem


class ClientError(MendError):
    """Base of everything that a client of the service raises on purpose."""


class UnreachableError(ClientError):
    """No service answers at the address."""


class RefusedError(ClientError):
    """The service refused a request; `problem` says why."""

    def __init__(self, refusal: Problem) -> None:
        more = [each for each in refusal.errors or [] if each != refusal.detail]
        super().__init__("\n".join([refusal.detail, *more]))
        self.problem = refusal


class StreamRefusedError(ClientError):
    """The service does not let this client in, or is of a version that it cannot read."""


class CommandRefusedError(ClientError):
    """The service refused an answer, a claim or a release; `error` says why."""

    def __init__(self, error: Error) -> None:
        super().__init__(error.detail)
        self.error = error


class ConnectionLostError(ClientError):
    """The connection went away; what was sent last may have been done."""
