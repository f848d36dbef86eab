"""A world: stands in for hardware and the people around it; workcell and tabletop are two."""

from typing import Any, Protocol

from robots.body import Body
from tasks.intervention import Intervention


class World(Protocol):
    """A simulated world with one robot.

    Only `body` may be used by behaviors, monitors and looks; the rest belongs to the person and
    to the journal.
    """

    @property
    def body(self) -> Body: ...

    def intervene(self, intervention: Intervention) -> str:
        """Do what a person does, now (a pull or a hand-over goes on over the next cycles).

        Returns an empty string, or one sentence that says why it cannot be done.
        """
        ...

    def snapshot(self) -> dict[str, Any]:
        """The state from which `restore` can rebuild the world; JSON-compatible.

        Part poses, what is held (and where it last rested), stolen and blocked, and the clock.
        """
        ...

    def restore(self, snapshot: dict[str, Any]) -> None:
        """Rebuild the world. What was held lies where it last rested; the arm is at neutral."""
        ...

    def close(self) -> None: ...
