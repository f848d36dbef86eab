"""Views of large documents, which took long to check, kept for whoever asks next."""

import asyncio
import hashlib
from collections import OrderedDict
from collections.abc import Awaitable, Callable, Iterable
from typing import Generic, TypeVar

from pydantic import BaseModel

from mend.server.limits import Limits
from mend.server.one_by_one import OneByOne
from mend.server.rendered import Rendered

V = TypeVar("V", bound=BaseModel)

MOST_BYTES = 32 * 1024**2
"""So many bytes of views are kept, the latest that were asked for."""


class RememberedViews(Generic[V]):
    """Views by the digest of all that was read for them."""

    def __init__(self, limits: Limits) -> None:
        self._turns = OneByOne(limits.waiting_chars)
        self._views: OrderedDict[bytes, Rendered[V]] = OrderedDict()

    async def of(
        self,
        chars: int,
        texts: Callable[[], Iterable[str]],
        make: Callable[[], Awaitable[Rendered[V]]],
    ) -> Rendered[V]:
        """The view that is made of these texts, of so many characters.

        Raises what `make` raises, and `BusyError`.
        """
        if (kept := self._kept(await asyncio.to_thread(_digest, texts))) is not None:
            return kept
        # One after the other: who asks many times at once has it made once.
        async with self._turns.turn(chars):
            digest = await asyncio.to_thread(_digest, texts)
            if (kept := self._kept(digest)) is not None:
                return kept
            view = await make()
            # Of files that changed meanwhile nobody knows which of the two were read.
            if digest is not None and digest == await asyncio.to_thread(_digest, texts):
                self._keep(digest, view)
            return view

    def _kept(self, digest: bytes | None) -> Rendered[V] | None:
        if digest is None or digest not in self._views:
            return None
        self._views.move_to_end(digest)
        return self._views[digest]

    def _keep(self, digest: bytes, view: Rendered[V]) -> None:
        self._views[digest] = view
        while sum(len(each.json) for each in self._views.values()) > MOST_BYTES:
            self._views.popitem(last=False)


def _digest(texts: Callable[[], Iterable[str]]) -> bytes | None:
    """One digest of all texts in their order; None where some cannot be read just now."""
    digest = hashlib.sha256()
    try:
        for text in texts():
            encoded = text.encode("utf-8", "surrogatepass")
            digest.update(len(encoded).to_bytes(8, "big"))
            digest.update(encoded)
    except (OSError, ValueError):
        return None
    return digest.digest()
