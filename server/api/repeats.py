"""Requests under idempotency keys: which are under way, and which were answered before."""

from collections import OrderedDict
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from mend.server.api.idempotency_header import HEADER
from mend.server.api.problems import ProblemError
from mend.server.journal.journal import (
    Journal,
    JournalClosedError,
    JournalReadError,
    JournalWriteError,
)
from mend.server.journal.keyed_request import FirstAnswer, KeptRequest, KeyedRequest
from mend.server.limits import Limits
from mend.server.refusals import Refusals

MOST_KEPT_BYTES = 64 * 1024
"""A longer answer is not kept in the journal, but made again from what came of the request."""

MOST_REMEMBERED_BYTES = 16 * 1024
"""A longer answer is not kept in memory; what it answers made nothing, and is done again."""


@dataclass(frozen=True, slots=True)
class _Remembered:
    time_s: float
    kept: KeptRequest


class Repeats:
    """What was asked under a key: kept in the journal with what came of it, else in memory.

    In memory are requests that nothing in the journal came of, as checks, and answers with secrets
    in them, which must be written nowhere. They are forgotten when the service ends.
    """

    def __init__(
        self,
        journal: Journal,
        limits: Limits,
        refusals: Refusals,
        wall_time_s: Callable[[], float],
    ) -> None:
        self._journal = journal
        self._limits = limits
        self._refusals = refusals
        self._wall_time_s = wall_time_s
        self._under_way: dict[tuple[str, str], bytes] = {}
        self._remembered: OrderedDict[tuple[str, str], _Remembered] = OrderedDict()

    @contextmanager
    def under_way(self, request: KeyedRequest) -> Iterator[None]:
        """While a request is being done no other is under its key.

        Raises `ProblemError`: 409 for the same request, 422 for another one.
        """
        who = request.principal, request.key
        digest = self._under_way.get(who)
        if digest is not None:
            refuse_other(digest, request)
            raise ProblemError(
                409, f"the first request under this {HEADER} is still under way: try again",
                {"Retry-After": "1"},
            )  # fmt: skip
        self._under_way[who] = request.digest
        try:
            yield
        finally:
            del self._under_way[who]

    async def find(self, request: KeyedRequest) -> KeptRequest | None:
        """The request that was made before under this key.

        Raises `ProblemError` (422) if it was another one.
        """
        since = self._since()
        remembered = self._remembered.get((request.principal, request.key))
        found = remembered.kept if remembered and remembered.time_s >= since else None
        if found is None:
            found = await self._journal.find_request(request.principal, request.key, since)
        if found is not None:
            refuse_other(found.digest, request)
        return found

    async def keep(
        self, request: KeyedRequest, answer: FirstAnswer | None, *, secret: bool
    ) -> None:
        """Keep an answer, None if it is too long to be kept; a `secret` one in memory alone."""
        if secret or not await self._keep_in_journal(request, answer):
            self._remember(request, answer)

    async def _keep_in_journal(self, request: KeyedRequest, answer: FirstAnswer | None) -> bool:
        """Whether the journal has the request. What was done stands, whether it has or not."""
        since = self._since()
        fits = answer is not None and len(answer.body) <= MOST_KEPT_BYTES
        try:
            gone = await self._journal.keep_answer(
                request, answer if fits else None, self._limits.idempotency_keys, since
            )
            if gone:
                self._refusals.note("idempotency_keys", gone)
            found = await self._journal.find_request(request.principal, request.key, since)
        except (JournalWriteError, JournalReadError, JournalClosedError):
            return False
        return found is not None

    def _remember(self, request: KeyedRequest, answer: FirstAnswer | None) -> None:
        fits = answer is not None and len(answer.body) <= MOST_REMEMBERED_BYTES
        kept = KeptRequest(request.digest, 0, answer if fits else None)
        who = request.principal, request.key
        self._remembered[who] = _Remembered(self._wall_time_s(), kept)
        # One whose time was over has its old place else.
        self._remembered.move_to_end(who)
        since = self._since()
        while self._remembered:
            oldest, remembered = next(iter(self._remembered.items()))
            too_many = len(self._remembered) > self._limits.idempotency_keys
            if remembered.time_s >= since and not too_many:
                break
            del self._remembered[oldest]
            if remembered.time_s >= since:
                self._refusals.note("idempotency_keys")

    def _since(self) -> float:
        return self._wall_time_s() - self._limits.idempotency_s


def refuse_other(digest: bytes, request: KeyedRequest) -> None:
    """Raises `ProblemError` (422) if a digest is not that of the request."""
    if digest != request.digest:
        raise ProblemError(
            422, f"another request came under this {HEADER}: a new request needs a new key"
        )
