"""A robot that is told one thing after the other, and nothing comes of it."""

from dataclasses import dataclass

MOST_FRUITLESS_COMMANDS = 200
"""A robot whose connection fails often, or whose program is killed, is told the same thing again
some ten times. Far more is a fault that ends in nothing, or a robot that means harm.
"""


@dataclass(slots=True)
class Livelock:
    """Counts what one robot was told for the task since the task last came on."""

    told: int = 0
    progress: int = 0
    """`RunState.progress`, when the robot was last told something."""

    def tell(self, progress: int) -> None:
        """The robot is told something, `progress` being how far the task has come on."""
        if progress != self.progress:
            self.told, self.progress = 0, progress
        self.told += 1

    def lasts(self, progress: int) -> bool:
        """Whether it has been told more than ever leads to something."""
        return progress == self.progress and self.told >= MOST_FRUITLESS_COMMANDS
