"""What helpers may say of help that is awaited: that it is done, or that they cannot after all."""

from collections.abc import Sequence
from typing import Protocol

from mend.dialogue.conversation import MOST_LOOKS
from mend.errors import ConflictError
from mend.server.journal import events as ev
from mend.server.runtime.context import RunContext
from mend.server.runtime.dialogue_events import DialogueEvents
from mend.server.runtime.dialogue_state import TAKE_BACK, DialogueState
from mend.server.runtime.robot_proxy import RobotProxy


class Converse(Protocol):
    """Commits a call to a conversation: the events before it, and what it says to it."""

    async def __call__(
        self,
        dialogue: DialogueState,
        call: str,
        before: Sequence[ev.Event],
        proxy: RobotProxy,
        helper: str = "",
    ) -> list[ev.Event]: ...


class HelpersWord:
    """Takes a helper's word on awaited help, in the dialogues of one run."""

    def __init__(self, context: RunContext, converse: Converse) -> None:
        self._context, self._converse = context, converse

    async def said_done(
        self, dialogue: DialogueState, helper: str, proxy: RobotProxy, author: ev.Author | None
    ) -> ev.HelpReported:
        """Somebody says that the help is done: the robot looks at once.

        Anybody may say so who is there, as the robot believes only what it sees. Raises
        `ConflictError` where no help is awaited, or no look would follow.
        """
        awaiting = _look_at_a_word(dialogue)
        said = self._make(dialogue).help_reported(awaiting, helper, author)
        (reported,) = await self._context.commit([said])
        proxy.give_up_look()
        assert isinstance(reported, ev.HelpReported), "what is committed keeps its type"
        return reported

    async def take_back(
        self, dialogue: DialogueState, helper: str, proxy: RobotProxy, author: ev.Author | None
    ) -> ev.PromiseTakenBack:
        """Who promised the help cannot give it: the dialogue goes on as after their no to it.

        Raises `ConflictError` where no help is awaited, or somebody else promised it.
        """
        awaiting = _awaited(dialogue)
        if awaiting.helper != helper:
            raise ConflictError(
                f"{awaiting.helper} has promised this: nobody else can take that promise back"
            )
        taken_back = self._make(dialogue).promise_taken_back(awaiting, author)
        committed = await self._converse(dialogue, TAKE_BACK, [taken_back], proxy, helper)
        proxy.give_up_look()
        return next(each for each in committed if isinstance(each, ev.PromiseTakenBack))

    def _make(self, dialogue: DialogueState) -> DialogueEvents:
        return DialogueEvents(self._context.stamp, dialogue.id, dialogue.raised)


def _awaited(dialogue: DialogueState) -> ev.HelpAwaited:
    if dialogue.closed is not None:
        raise ConflictError(f"this dialogue is closed ({dialogue.closed})")
    if dialogue.awaiting is None:
        raise ConflictError("no help is awaited in this dialogue: nobody has promised any")
    return dialogue.awaiting


def _look_at_a_word(dialogue: DialogueState) -> ev.HelpAwaited:
    """The help that a look for would follow at once."""
    awaiting = _awaited(dialogue)
    if dialogue.reported is not None:
        raise ConflictError(f"{dialogue.reported.helper} has said so: the robot looks already")
    if awaiting.guess is not None:
        raise ConflictError("there is nothing to be done: the robot looks already")
    if not dialogue.conversation.looks_at_a_word:
        raise ConflictError(
            f"the robot has looked {MOST_LOOKS} times at a word: it goes on looking by itself",
            limit="looks_at_a_word",
        )
    return awaiting
