"""The runtime as the API, the sockets and the command line see it."""

from collections.abc import Mapping, Sequence
from typing import Literal, Protocol
from uuid import UUID

from mend.server.camera_picture import CameraPicture
from mend.server.dialogues.who_helps import HelpersView
from mend.server.journal.events import (
    Answered,
    Author,
    DeadlineExtended,
    HelpReported,
    PromiseTakenBack,
    RecordingBegun,
)
from mend.server.journal.run_index import RunPage
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.steering_views import AnySteering, NodeSteeringView, SteeringView
from mend.server.runtime.views import (
    ChosenView,
    DialogueView,
    LeafSaid,
    QuestionBatchView,
    RobotView,
    RunStatus,
    RunSummary,
    RunView,
    Snapshot,
)
from mend.tasks.intervention import Intervention


class DialogueService(Protocol):
    """The dialogues of all runs. Every method raises the errors of `server.errors`.

    `author` is who asks for it; None for what this process does by itself.
    """

    async def page(
        self, status: Literal["open", "closed"] | None, limit: int, offset: int
    ) -> list[DialogueView]:
        """A page of dialogues, oldest first."""
        ...

    def questions(self) -> list[QuestionBatchView]:
        """The open questions of all runs, the most urgent first; those alike stand together."""
        ...

    async def choose_for_all(
        self, way: str, prompts: Sequence[UUID], helper: str, author: Author | None = None
    ) -> list[ChosenView]:
        """Choose a way for several open questions. Raises `NotFoundError`, `ConflictError`."""
        ...

    def count_open(self) -> int:
        """How many dialogues are open."""
        ...

    async def view(self, dialogue: UUID) -> DialogueView:
        """One dialogue. Raises `NotFoundError` or `UnreadableError`."""
        ...

    async def answer(
        self,
        dialogue: UUID,
        prompt: UUID,
        answer: Literal["yes", "no"],
        helper: str,
        author: Author | None = None,
    ) -> Answered:
        """Answer a prompt: the first answer wins. Raises `LostRaceError`, `ConflictError`."""
        ...

    async def choose(
        self,
        dialogue: UUID,
        prompt: UUID,
        way: str,
        helper: str,
        author: Author | None = None,
    ) -> Answered:
        """Answer a prompt and what follows from it by a way of help; the last answer.

        Raises as `answer` does.
        """
        ...

    async def extend(
        self, dialogue: UUID, prompt: UUID, helper: str, author: Author | None = None
    ) -> DeadlineExtended:
        """Move the open question's deadline by its original length. Raises `ConflictError`."""
        ...

    async def said_done(
        self, dialogue: UUID, helper: str, author: Author | None = None
    ) -> HelpReported:
        """Somebody says that awaited help is done: the robot looks. Raises `ConflictError`."""
        ...

    async def take_back(
        self, dialogue: UUID, helper: str, author: Author | None = None
    ) -> PromiseTakenBack:
        """Who promised awaited help cannot give it after all. Raises `ConflictError`."""
        ...

    async def claim(
        self,
        dialogue: UUID,
        helper: str,
        *,
        take_over: bool = False,
        author: Author | None = None,
    ) -> DialogueView: ...

    async def release(
        self, dialogue: UUID, helper: str, author: Author | None = None
    ) -> DialogueView: ...


class RunService(Protocol):
    """Runs and robots. Every method raises the errors of `server.errors`.

    `author` is who asks for it; None for what this process does by itself.
    """

    @property
    def dialogues(self) -> DialogueService:
        """What robots ask in these runs."""
        ...

    def helpers(self) -> HelpersView:
        """Who may be asked at this moment, and who of them is here, away or busy."""
        ...

    async def start_run(self, request: RunRequest, author: Author | None = None) -> RunSummary:
        """Begin a run. Raises `NotFoundError` (tree, scenario, robot), `WrongInputError`."""
        ...

    async def runs(self, page: RunPage) -> list[RunSummary]:
        """A page of runs, newest first."""
        ...

    async def count_runs(self) -> Mapping[RunStatus, int]:
        """How many runs there are of each status."""
        ...

    async def run(self, run: UUID) -> RunView:
        """One run. Raises `NotFoundError` or `UnreadableError`."""
        ...

    async def run_summary(self, run: UUID) -> RunSummary:
        """One run without its nodes. Raises `NotFoundError` or `UnreadableError`."""
        ...

    async def run_json(self, run: UUID) -> list[bytes]:
        """What `run` returns, in JSON, in pieces."""
        ...

    async def pause(self, run: UUID, author: Author | None = None) -> RunSummary: ...

    async def resume(self, run: UUID, author: Author | None = None) -> RunSummary: ...

    async def abort(self, run: UUID, author: Author | None = None) -> RunSummary: ...

    async def take_leaf(
        self, run: UUID, node: str, helper: str, author: Author | None = None
    ) -> RunSummary:
        """A person does a leaf themselves. Raises `ConflictError` if it cannot be begun now."""
        ...

    async def give_leaf_back(self, run: UUID, node: str, helper: str) -> RunSummary:
        """They do not after all. Raises `ConflictError` if it is not theirs."""
        ...

    async def say_of_leaf(
        self, run: UUID, words: str, helper: str, author: Author | None = None
    ) -> LeafSaid:
        """Either of these in plain words. Raises `WrongInputError` if they are not understood."""
        ...

    async def steer(
        self, run: UUID, wish: AnySteering, by: str, author: Author | None = None
    ) -> SteeringView:
        """Steer a run. Raises `ConflictError` where that would break its tree's order."""
        ...

    async def steering(self, run: UUID) -> SteeringView:
        """How a run is steered."""
        ...

    async def steering_of(self, run: UUID, node: str) -> NodeSteeringView:
        """What may be said of a node of a run now."""
        ...

    async def intervene(
        self, run: UUID, intervention: Intervention, author: Author | None = None
    ) -> None:
        """Have a person do something in a simulated world. Raises `ConflictError` if it cannot."""
        ...

    async def record(
        self, run: UUID, seconds: float, by: str, author: Author | None = None
    ) -> RecordingBegun:
        """Have a run's cameras recorded. Raises `ConflictError` without any, or without room."""
        ...

    async def picture(self, run: UUID, camera: str, robot: str | None = None) -> CameraPicture:
        """A camera's picture now; of the run's first robot that has one, unless it is named."""
        ...

    def robots(self) -> list[RobotView]: ...

    async def snapshot(self, seq: int | None) -> Snapshot:
        """The state after event `seq`, or after the last one without it."""
        ...
