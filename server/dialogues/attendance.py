"""Who is signed in to help, on however many devices."""

from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager


class Attendance:
    """Helpers who hear what robots ask at this moment.

    `changed` is called when one comes or goes.
    """

    def __init__(self) -> None:
        self._devices: Counter[str] = Counter()
        self.changed: Callable[[], None] = lambda: None

    @contextmanager
    def attending(self, helper: str) -> Iterator[None]:
        """Somebody is there for as long as this lasts."""
        self._devices[helper] += 1
        self.changed()
        try:
            yield
        finally:
            self._devices[helper] -= 1
            if self._devices[helper] <= 0:
                del self._devices[helper]
            self.changed()

    @property
    def there(self) -> list[str]:
        """Who is there, who came first first."""
        return list(self._devices)
