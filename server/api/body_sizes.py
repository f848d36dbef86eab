"""How large the body of a request may be, by its door, and all that come at once together."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from mend.server.access.permissions import endpoint_of
from mend.server.asking import asker
from mend.server.documents import DocumentKind

SHORT_BODY_BYTES = 64 * 1024
LARGE_BODY_BYTES = 8 * 1024 * 1024
MODEL_BODY_BYTES = 32 * 1024 * 1024

TAKE_LARGE_BODIES = frozenset(
    {"start_run"} | {f"{do}_{kind}" for do in ("check", "upload", "put") for kind in DocumentKind}
)
"""The operations that take files, or scripted answers by the thousand."""

TAKE_MODELS = frozenset({"put_model", "put_own_model"})
"""The operations that take a robot's meshes."""


def most_bytes(method: str, path: str) -> int:
    """How large a body may be at a door that is not open to everybody."""
    endpoint = endpoint_of(method, path)
    operation = None if endpoint is None else endpoint.operation
    if operation in TAKE_MODELS:
        return MODEL_BODY_BYTES
    return LARGE_BODY_BYTES if operation in TAKE_LARGE_BODIES else SHORT_BODY_BYTES


class IncomingBodies:
    """The bodies of the requests that are being received or answered.

    What is beyond the first 64 KiB of each has `most_bytes` in all, but of everybody one body is
    taken however many others there are.
    """

    def __init__(self, most_bytes: int) -> None:
        self._most_bytes = most_bytes
        self._large: dict[object, tuple[str, int]] = {}

    @contextmanager
    def body(self) -> Iterator[Callable[[int], bool]]:
        """One more, for as long as it is needed.

        What it yields is to be told how many bytes of it have come, and says whether there is room.
        """
        key, who = object(), asker.get()

        def has_room(received: int) -> bool:
            if received <= SHORT_BODY_BYTES:
                return True
            self._large[key] = who, received - SHORT_BODY_BYTES
            count = sum(who == other for other, _ in self._large.values())
            return count == 1 or sum(size for _, size in self._large.values()) <= self._most_bytes

        try:
            yield has_room
        finally:
            self._large.pop(key, None)
