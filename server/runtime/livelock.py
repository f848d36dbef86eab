"""A robot that is told one thing after the other, and nothing comes of it."""

from collections import Counter

MOST_FRUITLESS_COMMANDS = 200
"""A robot whose connection fails often, or whose program is killed, is told the same thing again
some ten times. Far more is a fault that ends in nothing, or a robot that means harm.
"""

WINDOW_S = 100.0
"""While people are asked a robot looks every other second, for as long as it takes them. So what it
is told meanwhile is counted for so long at a time.
"""


class Livelock:
    """Counts what one robot was told since its task last came on."""

    def __init__(self) -> None:
        self._told: Counter[int | None] = Counter()
        self._progress = 0
        self._window: int | None = None

    def see(self, progress: int, asking_at_s: float | None) -> None:
        """How far the task has come on, and the time if the robot is asking for help now."""
        if progress != self._progress:
            self._told.clear()
            self._progress = progress
        self._window = None if asking_at_s is None else int(asking_at_s // WINDOW_S)

    def tell(self) -> bool:
        """The robot is told something; whether it is the first since the task came on."""
        self._told[self._window] += 1
        return self._told[self._window] == 1

    @property
    def lasts(self) -> bool:
        """Whether the robot was told more than ever leads to something."""
        return self._told[self._window] >= MOST_FRUITLESS_COMMANDS
