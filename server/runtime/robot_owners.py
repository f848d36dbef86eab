"""Which run has which robot, or is about to be given it."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from uuid import UUID

from mend.errors import ConflictError, WrongInputError
from mend.server.errors import NotConnectedError
from mend.server.journal.events import RunStarted
from mend.server.runtime.ports import Robots
from mend.server.runtime.run import Run

MOST_NAMED = 20
"""A sentence about robots names so many of them."""


class RobotOwners:
    """Gives each robot to one run at a time."""

    def __init__(self, robots: Robots) -> None:
        self._robots = robots
        self._promised: dict[str, UUID] = {}
        self._given: dict[str, UUID] = {}

    @property
    def promised_to(self) -> set[UUID]:
        """The runs that are being journaled, and get their robots then."""
        return set(self._promised.values())

    def check_live(self, robots: Sequence[str]) -> None:
        """Look whether a run in the world 'live' can have these robots.

        Raises `WrongInputError`, `NotConnectedError` or `ConflictError`.
        """
        if not robots:
            raise WrongInputError(
                "a run in the world 'live' needs 'robots', the names of connected ones "
                f"({self._who_is_free()})"
            )
        away = [each for each in robots if not self._robots.connected(each)]
        if away:
            names = " or ".join(f"'{each}'" for each in away)
            raise NotConnectedError(f"no robot {names} is connected ({self._who_is_free()})", away)
        self.check_free(robots)

    def check_free(self, robots: Sequence[str]) -> None:
        """Raise `ConflictError` where a run has one of these robots, or is about to."""
        busy = self._given | self._promised
        for robot in robots:
            if robot in busy:
                raise ConflictError(f"the robot '{robot}' is busy with run {busy[robot]}")

    def _who_is_free(self) -> str:
        busy = self._given | self._promised
        known = [each for each in self._robots.known() if self._robots.connected(each)]
        free = [f"'{each}'" for each in known if each not in busy]
        more = f" and {len(free) - MOST_NAMED} more" if len(free) > MOST_NAMED else ""
        return f"connected and free: {', '.join(free[:MOST_NAMED]) or 'none'}{more}"

    @contextmanager
    def promised(self, started: RunStarted) -> Iterator[None]:
        """While a run is being journaled no other may be given its robots."""
        promised = dict.fromkeys(started.robots, started.run)
        self._promised.update(promised)
        try:
            yield
        finally:
            for robot in promised:
                del self._promised[robot]

    def give(self, run: Run) -> None:
        """Give a run all its robots, or none. Raises `ConflictError` if another run has one."""
        given: list[str] = []
        try:
            for robot in run.proxies:
                self._robots.assign(robot, run)
                given.append(robot)
        except ConflictError:
            for robot in given:
                self._robots.unassign(robot)
            raise
        self._given.update(dict.fromkeys(given, run.context.state.id))

    def take_back(self, run: Run) -> None:
        """A run needs its robots no more."""
        for robot in run.proxies:
            self._robots.unassign(robot)
            del self._given[robot]
