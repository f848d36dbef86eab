"""Who is signed in to help, on however many devices, and at which of these somebody is."""

import time
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from typing import Literal

Presence = Literal["active", "away", "beside"]
"""What a page says of who is at it: somebody, who has just done something there; nobody who would
see it, as it is hidden or somebody has left; or whoever is beside a robot, whom it always hears."""

AWAY_AFTER_S = 300.0


class Device:
    """A page or a program of one helper, and what it has said of who is at it.

    A program listens for as long as it is connected, so what says nothing counts as here.
    """

    def __init__(self, presence: Presence | None, now_s: float) -> None:
        self._presence, self._said_at_s = presence, now_s

    def says(self, presence: Presence, now_s: float) -> None:
        self._presence, self._said_at_s = presence, now_s

    def counts_as_here(self, now_s: float, away_after_s: float) -> bool:
        """Whether somebody is at it by now."""
        if self._presence == "active":
            return now_s - self._said_at_s < away_after_s
        return self._presence != "away"


class Attendance:
    """Helpers who hear what robots ask at this moment, and which of them are here.

    Somebody who has done nothing at any of their pages for `away_after_s` seconds of the clock is
    away. `changed` is called when one comes or goes. `called_by_push` has who can be called though
    they have no page open. Nothing of this is kept.
    """

    def __init__(
        self,
        monotonic: Callable[[], float] = time.monotonic,
        away_after_s: float = AWAY_AFTER_S,
    ) -> None:
        self._monotonic, self.away_after_s = monotonic, away_after_s
        self._devices: dict[str, list[Device]] = {}
        self.changed: Callable[[], None] = lambda: None
        self.called_by_push: Callable[[], Collection[str]] = lambda: ()

    @contextmanager
    def attending(self, helper: str, presence: Presence | None = None) -> Iterator[Device]:
        """A device is there for as long as this lasts."""
        device = Device(presence, self._monotonic())
        self._devices.setdefault(helper, []).append(device)
        self.changed()
        try:
            yield device
        finally:
            self._devices[helper].remove(device)
            if not self._devices[helper]:
                del self._devices[helper]
            self.changed()

    def says(self, helper: str, device: Device, presence: Presence) -> None:
        """A device says who is at it; one that is there no longer says nothing to anybody."""
        before = self._is_here(helper)
        device.says(presence, self._monotonic())
        if self._is_here(helper) != before:
            self.changed()

    @property
    def there(self) -> list[str]:
        """Who is signed in, who came first first."""
        return list(self._devices)

    @property
    def away(self) -> list[str]:
        """Who is signed in, but at none of their pages."""
        return [each for each in self._devices if not self._is_here(each)]

    def _is_here(self, helper: str) -> bool:
        now_s = self._monotonic()
        devices = self._devices.get(helper, ())
        return any(each.counts_as_here(now_s, self.away_after_s) for each in devices)
