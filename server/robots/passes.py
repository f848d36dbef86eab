"""As which robot a connection may say hello: names are bound to credentials."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Protocol

from mend.server.access.tokens import NewToken, fits, id_in, new_token


class Pass(Protocol):
    """What a connection of a robot has shown."""

    def why_not(self, robot: str) -> str | None:
        """Why it may not say hello as this robot; None if it may."""
        ...


class Anyone:
    """The pass of a channel within this process: who made it knows which robot it is for."""

    def why_not(self, robot: str) -> None:  # noqa: ARG002
        return None


@dataclass(frozen=True, slots=True)
class OneRobot:
    """The pass of a credential that is bound to one robot."""

    name: str

    def why_not(self, robot: str) -> str | None:
        if robot == self.name:
            return None
        return (
            f"this credential is that of the robot '{self.name}': with it nobody can be "
            f"'{robot}', which needs one of its own ('mend access enrol')"
        )


@dataclass
class OwnRobots:
    """The robots that this service runs itself; each process has a credential for its time.

    A name of one of them is nobody else's while its run lasts, also while its process is started
    again.
    """

    _names: set[str] = field(default_factory=set)
    _tokens: dict[str, tuple[str, NewToken]] = field(default_factory=dict)

    def reserve(self, robots: Iterable[str]) -> None:
        """These are robots of this service, whose processes are still to come."""
        self._names.update(robots)

    def release(self, robots: Iterable[str]) -> None:
        """Their run has ended, and so have their processes."""
        self._names.difference_update(robots)

    def issue(self, robot: str) -> str:
        """A credential for a process that is about to be started as this robot."""
        token = new_token()
        self._tokens[token.id] = robot, token
        self._names.add(robot)
        return token.text

    def withdraw(self, token: str) -> None:
        """The process is gone, and what it had is good no longer."""
        self._tokens.pop(id_in(token) or "", None)

    def of_token(self, token: str) -> str | None:
        """Which robot's process has this credential."""
        robot, kept = self._tokens.get(id_in(token) or "", ("", None))
        return robot if kept is not None and fits(token, kept.sha256) else None

    def __contains__(self, robot: str) -> bool:
        return robot in self._names
