"""What a conversation is about, a question or a promise: finding it, and noticing its end."""

from collections.abc import AsyncIterator, Sequence
from dataclasses import dataclass
from uuid import UUID

from mend.errors import ConflictError, NotFoundError
from mend.server.journal.events import (
    Answered,
    DialogueClosed,
    DialogueEvent,
    Event,
    Prompt,
    WayOption,
    any_event,
)
from mend.server.journal.journal import Journal, JournalClosedError
from mend.server.journal.subscriptions import PrunedEventsError, SubscriptionOverflowError
from mend.server.runtime.service import RunService
from mend.server.runtime.views import PromptView
from mend.server.speech.chosen_way import CHOICES, way_meant
from mend.server.speech.commands import Command
from mend.server.speech.conversation import EndReason
from mend.server.speech.phrases import PROMISE_HELP, help_text
from mend.server.speech.vocabulary import Vocabulary

PAGE = 500


async def find_prompt(
    runs: RunService, journal: Journal, dialogue: UUID, prompt: UUID
) -> PromptView | Prompt:
    """A prompt of a dialogue, open or long over. Raises `NotFoundError`."""
    view = await runs.dialogues.view(dialogue)
    if view.prompt is not None and view.prompt.prompt == prompt:
        return view.prompt
    async for event in _events_of(journal, view.run, dialogue):
        if isinstance(event, Prompt) and event.prompt == prompt:
            return event
    raise NotFoundError(f"there is no prompt {prompt} in the dialogue {dialogue}")


async def _events_of(journal: Journal, run: UUID, dialogue: UUID) -> AsyncIterator[Event]:
    """The events of a dialogue, from its first one to its last."""
    indexed = await journal.index.dialogue(dialogue)
    after = 0 if indexed is None else indexed.opened - 1
    while records := await journal.read_records(after, PAGE, run):
        for record in records:
            if str(dialogue) not in record.text:
                continue
            event = any_event.validate_json(record.text)
            if isinstance(event, DialogueEvent) and event.dialogue == dialogue:
                yield event
                if isinstance(event, DialogueClosed):
                    return
        after = records[-1].seq


@dataclass(frozen=True, slots=True)
class Topic:
    """What is said first, what on `help`, and what is listened for, `ways` of help among it."""

    text: str
    help_text: str
    vocabulary: Vocabulary
    ways: Sequence[WayOption] = ()

    def takes(self, command: Command) -> bool:
        """Whether a command means anything here: no way is chosen that there is not."""
        return command not in CHOICES or way_meant(command, self.ways) is not None


async def open_topic(runs: RunService, dialogue: UUID, prompt: UUID) -> Topic:
    """The open question of a dialogue, or its last word while promised help is awaited.

    Raises `NotFoundError`, or `ConflictError` if it is another, or nothing is waited for.
    """
    view = await runs.dialogues.view(dialogue)
    if view.status == "closed" or view.awaiting is None or view.prompt is None:
        raise ConflictError("this dialogue waits for no answer")
    if view.prompt.prompt != prompt:
        raise ConflictError(f"the prompt {prompt} is not the last one of this dialogue")
    if view.awaiting == "help":
        return Topic(view.prompt.text, PROMISE_HELP, Vocabulary.PROMISE)
    ways = view.prompt.ways
    # Of two ways the second is the no to the first.
    vocabulary = Vocabulary.WAYS if len(ways) > 2 else Vocabulary.ANSWER
    said = help_text(view.prompt.answers, ways)
    return Topic(view.prompt.text, said, vocabulary, ways if len(ways) > 2 else ())


async def wait_until_over(
    runs: RunService, journal: Journal, dialogue: UUID, prompt: UUID, capacity: int
) -> EndReason:
    """Return once the question waits for no answer any more, and why."""
    while True:
        # Followed before it is looked at, so that nothing happens in between.
        with journal.subscribe(journal.head, capacity) as subscription:
            try:
                await open_topic(runs, dialogue, prompt)
            except ConflictError:
                return EndReason.CLOSED
            try:
                async for record in subscription:
                    if str(dialogue) in record.text:
                        reason = _end_in(record.text, dialogue, prompt)
                        if reason is not None:
                            return reason
            except (SubscriptionOverflowError, PrunedEventsError):
                continue
            except JournalClosedError:
                pass
            return EndReason.CLOSED


def _end_in(text: str, dialogue: UUID, prompt: UUID) -> EndReason | None:
    match any_event.validate_json(text):
        case Answered(dialogue=of, prompt=answered) if of == dialogue and answered == prompt:
            return EndReason.ANSWERED
        case DialogueClosed(dialogue=of) if of == dialogue:
            return EndReason.CLOSED
        case Prompt(dialogue=of, prompt=asked) if of == dialogue and asked != prompt:
            return EndReason.CLOSED
    return None
