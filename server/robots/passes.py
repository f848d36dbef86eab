"""As which robot a connection may say hello: names are bound to credentials."""

from collections import Counter
from dataclasses import dataclass, field
from typing import Protocol

from server.access.tokens import NewToken, fits, id_in, new_token


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
    """The robots that this service runs itself; each process has a credential for its time."""

    _tokens: dict[str, tuple[str, NewToken]] = field(default_factory=dict)
    _running: Counter[str] = field(default_factory=Counter)

    def issue(self, robot: str) -> str:
        """A credential for a process that is about to be started as this robot."""
        token = new_token()
        self._tokens[token.id] = robot, token
        self._running[robot] += 1
        return token.text

    def withdraw(self, token: str) -> None:
        """The process is gone, and what it had is good no longer."""
        robot, _ = self._tokens.pop(id_in(token) or "", ("", None))
        self._running[robot] -= 1
        if self._running[robot] <= 0:
            del self._running[robot]

    def of_token(self, token: str) -> str | None:
        """Which robot's process has this credential."""
        robot, kept = self._tokens.get(id_in(token) or "", ("", None))
        return robot if kept is not None and fits(token, kept.sha256) else None

    def __contains__(self, robot: str) -> bool:
        return robot in self._running
