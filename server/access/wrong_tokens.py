"""Wrong tokens by address: whoever shows many waits longer and longer before the next is read."""

import hashlib
import hmac
import secrets
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field

FIRST_WAIT_S = 1.0
LONGEST_WAIT_S = 30.0
"""Somebody with the right token may be behind the same address: they wait no longer than that."""

FORGOTTEN_AFTER_S = 15 * 60.0
MOST_ADDRESSES = 10_000
MOST_KNOWN = 16


@dataclass(slots=True)
class _Address:
    guesses: int = 0
    last: float = 0.0
    wait_s: float = 0.0
    known: deque[bytes] = field(default_factory=lambda: deque(maxlen=MOST_KNOWN))


class WrongTokens:
    """Counts the different wrong tokens of each address. `now` is a clock in seconds.

    The first `free` cost nothing: people mistype. The same wrong token again is no other guess: a
    robot that was never told the new token keeps nobody else out.
    """

    def __init__(self, free: int, now: Callable[[], float]) -> None:
        self._free = free
        self._now = now
        self._key = secrets.token_bytes(16)
        # The one that was wrong last is the last.
        self._addresses: dict[str, _Address] = {}

    def wait_s(self, address: str) -> float:
        """How long nothing that this address shows is read; 0 if it is read now."""
        found = self._addresses.get(address)
        if found is None:
            return 0.0
        now = self._now()
        # A clock that was set back must make nobody wait longer.
        found.last = min(found.last, now)
        return max(0.0, found.wait_s - (now - found.last))

    def is_known(self, address: str, token: bytes) -> bool:
        """Whether this address has lately shown this very token, and it was wrong."""
        found = self._addresses.get(address)
        return found is not None and self._digest(token) in found.known

    def add(self, address: str, token: bytes) -> None:
        """This address has shown a wrong token."""
        if self.is_known(address, token):
            return
        found = self._addresses.pop(address, None)
        now = self._now()
        if found is None or now - found.last > FORGOTTEN_AFTER_S:
            found = _Address()
        self._addresses[address] = found
        found.guesses += 1
        found.last = now
        found.wait_s = self._wait_after_s(found.guesses)
        found.known.append(self._digest(token))
        if len(self._addresses) > MOST_ADDRESSES:
            del self._addresses[next(iter(self._addresses))]

    def _wait_after_s(self, guesses: int) -> float:
        doublings = guesses - self._free - 1
        if doublings < 0:
            return 0.0
        # More doublings than that would not make it longer.
        return min(LONGEST_WAIT_S, FIRST_WAIT_S * 2.0 ** min(doublings, 10))

    def _digest(self, token: bytes) -> bytes:
        return hmac.new(self._key, token, hashlib.sha256).digest()
