"""Counting what may come in any number, so that one event tells of many."""

from collections import Counter

from mend.server.journal.events import AddressCount

MOST_ADDRESSES = 20
UNKNOWN = "unknown"


class Tally:
    """How often something came, and from where; of further addresses only how often."""

    def __init__(self) -> None:
        self._by_address: Counter[str] = Counter()
        self.elsewhere = 0

    def add(self, address: str | None) -> None:
        """Count one."""
        where = address or UNKNOWN
        if where in self._by_address or len(self._by_address) < MOST_ADDRESSES:
            self._by_address[where] += 1
        else:
            self.elsewhere += 1

    @property
    def times(self) -> int:
        return self._by_address.total() + self.elsewhere

    @property
    def addresses(self) -> list[AddressCount]:
        """The addresses that were kept, the most frequent first."""
        return [
            AddressCount(address=address, times=times)
            for address, times in self._by_address.most_common()
        ]
