"""What robots ask, for the client of a service."""

from typing import Literal
from uuid import UUID

from mend.server.client_wire import Wire
from mend.server.dialogues.who_helps import HelpersView
from mend.server.journal.events import (
    Answered,
    DeadlineExtended,
    HelpReported,
    PromiseTakenBack,
)
from mend.server.runtime.views import (
    ChosenView,
    DialogueView,
    QuestionBatchView,
)


class DialogueCalls(Wire):
    """Reads questions and answers them."""

    async def dialogues(
        self, status: Literal["open", "closed"] | None = None
    ) -> list[DialogueView]:
        return await self._get("/api/dialogues", list[DialogueView], status=status)

    async def helpers(self) -> HelpersView:
        """Who may be asked now, and who of them is here, away or busy."""
        return await self._get("/api/helpers", HelpersView)

    async def questions(self) -> list[QuestionBatchView]:
        """The open questions, the most urgent first; those that may be answered alike together."""
        return await self._get("/api/questions", list[QuestionBatchView])

    async def choose_for_all(self, way: str, prompts: list[UUID], helper: str) -> list[ChosenView]:
        """Choose one of a batch's `at_once` for its questions; what became of each."""
        body = {"way": way, "prompts": [str(each) for each in prompts], "helper": helper}
        return await self._post("/api/questions/choices", list[ChosenView], body)

    async def dialogue(self, dialogue: UUID) -> DialogueView:
        return await self._get(f"/api/dialogues/{dialogue}", DialogueView)

    async def answer(
        self, dialogue: UUID, prompt: UUID, answer: Literal["yes", "no"], helper: str
    ) -> Answered:
        """Answer a prompt. A `RefusedError` has `problem.answered_by` if another was first."""
        body = {"prompt": str(prompt), "answer": answer, "helper": helper}
        return await self._post(f"/api/dialogues/{dialogue}/answers", Answered, body)

    async def choose(self, dialogue: UUID, prompt: UUID, way: str, helper: str) -> Answered:
        """Choose one of a prompt's `ways`; the last of its answers. Raises as `answer` does."""
        body = {"prompt": str(prompt), "way": way, "helper": helper}
        return await self._post(f"/api/dialogues/{dialogue}/choices", Answered, body)

    async def extend(self, dialogue: UUID, prompt: UUID, helper: str) -> DeadlineExtended:
        """Give the open question as much time again as it was first put for."""
        path = f"/api/dialogues/{dialogue}/extend"
        return await self._post(path, DeadlineExtended, {"prompt": str(prompt), "helper": helper})

    async def said_done(self, dialogue: UUID, helper: str) -> HelpReported:
        """Say that the awaited help is done: the robot looks at once, and says what it sees."""
        path = f"/api/dialogues/{dialogue}/done"
        return await self._post(path, HelpReported, {"helper": helper})

    async def take_back(self, dialogue: UUID, helper: str) -> PromiseTakenBack:
        """Take back the promise to help: the dialogue goes on as after a no to it."""
        path = f"/api/dialogues/{dialogue}/take_back"
        return await self._post(path, PromiseTakenBack, {"helper": helper})

    async def claim(self, dialogue: UUID, helper: str, *, take_over: bool = False) -> DialogueView:
        path = f"/api/dialogues/{dialogue}/claim"
        body = {"helper": helper, "take_over": take_over}
        return await self._post(path, DialogueView, body)

    async def release(self, dialogue: UUID, helper: str) -> DialogueView:
        path = f"/api/dialogues/{dialogue}/release"
        return await self._post(path, DialogueView, {"helper": helper})

    async def picture(self, picture: UUID) -> bytes:
        """The picture that an event names, as JPEG."""
        return (await self._request("GET", f"/api/pictures/{picture}")).content
