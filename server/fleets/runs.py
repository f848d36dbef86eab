"""What fleets have their legs done by."""

from typing import Protocol
from uuid import UUID

from mend.server.journal.events import Author
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunSummary, RunView
from mend.tasks.definition import TaskTreeDefinition


class Runs(Protocol):
    """The runtime, as a fleet sees it."""

    async def start_run_of(
        self, run: UUID, request: RunRequest, tree: TaskTreeDefinition
    ) -> RunSummary:
        """Begin a run at a site of a tree that is no document; once only for each id."""
        ...

    async def wait_for_end(self, run: UUID) -> RunView: ...

    async def abort(self, run: UUID, author: Author | None = None) -> RunSummary: ...

    async def has_run(self, run: UUID) -> bool:
        """Whether there is such a run, whatever has become of it."""
        ...
