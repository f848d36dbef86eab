"""Mail to the operators about a question that nobody answered, sent beside the run."""

import asyncio
import logging
from collections.abc import Callable
from datetime import datetime

from server.dialogues.mail import Mailer, MailError, MailRequest
from server.journal.events import Escalated
from server.runtime.run_state import DialogueState, RunState

log = logging.getLogger(__name__)


class OperatorMail:
    """Sends mails without keeping any run waiting; a mail that fails is logged."""

    def __init__(
        self, mailer: Mailer | None, utc_now: Callable[[], datetime], console_url: str
    ) -> None:
        self._mailer = mailer
        self._utc_now = utc_now
        self._console_url = console_url
        self._sending: set[asyncio.Task[None]] = set()

    def send_later(self, state: RunState, escalated: Escalated, dialogue: DialogueState) -> None:
        """Write to the addresses of an escalation about the dialogue's open question."""
        ask = dialogue.asked
        if self._mailer is None or ask is None:
            return
        raised = dialogue.raised
        effects = {each.value: each.effect for each in ask.answers}
        request = MailRequest(
            run=state.id,
            dialogue=dialogue.id,
            prompt=ask.prompt,
            tree=state.started.tree_name,
            robot=raised.robot,
            issue=raised.issue,
            object=raised.object,
            node=raised.node,
            name=raised.name,
            question=ask.text,
            yes_effect=effects.get("yes", ""),
            no_effect=effects.get("no", ""),
            answer_within_s=None if ask.deadline is None else ask.deadline - escalated.time,
            console_url=self._console_url,
        )
        task = asyncio.create_task(self._send(self._mailer, request, escalated.to.split(", ")))
        self._sending.add(task)
        task.add_done_callback(self._sending.discard)

    async def _send(self, mailer: Mailer, request: MailRequest, to: list[str]) -> None:
        try:
            refused = await mailer.send(request, to, self._utc_now())
        except MailError as error:
            log.error("%s", error)
        else:
            if refused:
                log.error("the mail server refused %s", ", ".join(refused))

    async def close(self) -> None:
        """Wait for the mails that are under way."""
        await asyncio.gather(*self._sending, return_exceptions=True)
