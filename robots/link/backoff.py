"""How long a robot waits before it connects again."""

import random


class Backoff:
    """Doubles from `first_s` to `longest_s`, with jitter, so that a fleet does not come at once."""

    def __init__(self, generator: random.Random, *, first_s: float, longest_s: float) -> None:
        self._generator = generator
        self._first_s = first_s
        self._longest_s = longest_s
        self._next_s = first_s

    def next_s(self) -> float:
        """The next delay: between half and the whole of the doubling one."""
        delay_s = self._next_s * self._generator.uniform(0.5, 1.0)
        self._next_s = min(self._next_s * 2.0, self._longest_s)
        return delay_s

    def reset(self) -> None:
        self._next_s = self._first_s
