"""Claims: which helper is on which dialogue, so that the others need not be.

A claim is a courtesy with a lease (wall time); it never keeps anybody from answering.
"""

from datetime import timedelta

from mend.errors import ConflictError
from mend.server.journal.events import Author
from mend.server.runtime.context import RunContext
from mend.server.runtime.dialogue_events import DialogueEvents
from mend.server.runtime.dialogue_state import DialogueState

MOST_CLAIMS = 10_000
"""Of one dialogue, renewals included: who renews as the console does needs days for so many."""


class Claims:
    """The claims on the open dialogues of one run."""

    def __init__(self, context: RunContext) -> None:
        self._context = context

    async def claim(
        self,
        dialogue: DialogueState,
        helper: str,
        *,
        take_over: bool,
        author: Author | None = None,
    ) -> None:
        """Claim a dialogue, or renew one's own claim; `take_over` takes it from another helper.

        Raises `ConflictError` while another helper's lease lasts (unless it is taken over), once
        the dialogue is closed, or when it was claimed too often.
        """
        now = self._context.utc_now()
        held = dialogue.claim
        if dialogue.closed is not None:
            raise ConflictError(f"this dialogue is closed ({dialogue.closed})")
        if dialogue.claims >= MOST_CLAIMS:
            raise ConflictError(
                f"this dialogue was claimed {MOST_CLAIMS} times: it can be answered, not claimed",
                limit="claims",
            )
        others = held is not None and held.helper != helper
        if held is not None and others and held.until > now and not take_over:
            seconds = (held.until - now).total_seconds()
            raise ConflictError(
                f"{held.helper} is on this dialogue for {seconds:.0f} s more; "
                "'take_over' takes it from them"
            )
        make = self._make(dialogue)
        lease = timedelta(seconds=self._context.settings.claim_lease_s)
        claimed = make.claimed(helper, now + lease, author)
        if held is not None and others:
            released = make.released(held.helper, held.until <= now, author)
            await self._context.commit([released, claimed])
        else:
            await self._context.commit([claimed])

    async def release(
        self, dialogue: DialogueState, helper: str, author: Author | None = None
    ) -> None:
        """Give up one's own claim. Raises `ConflictError` when the helper has none."""
        if dialogue.claim is None or dialogue.claim.helper != helper:
            raise ConflictError(f"{helper} has no claim on this dialogue to release")
        released = self._make(dialogue).released(helper, expired=False, author=author)
        await self._context.commit([released])

    async def expire(self) -> None:
        """Release every claim whose lease has run out."""
        now = self._context.utc_now()
        for dialogue in self._context.state.open_dialogues:
            if dialogue.claim is not None and dialogue.claim.until <= now:
                released = self._make(dialogue).released(dialogue.claim.helper, expired=True)
                await self._context.commit([released])

    def expire_in_s(self) -> float | None:
        """Seconds until the next lease runs out, if it is not renewed."""
        now = self._context.utc_now()
        left = [
            (each.claim.until - now).total_seconds()
            for each in self._context.state.open_dialogues
            if each.claim is not None
        ]
        return max(0.0, min(left)) if left else None

    def _make(self, dialogue: DialogueState) -> DialogueEvents:
        return DialogueEvents(self._context.stamp, dialogue.id, dialogue.raised)
