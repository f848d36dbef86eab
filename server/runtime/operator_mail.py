"""Mail to the operators: an unanswered question, a suspected false alarm; sent beside the run."""

import asyncio
import logging
from collections.abc import Callable
from datetime import datetime

from server.dialogues.mail import Mailer, MailError, MailNotice, MailRequest
from server.journal.events import Escalated, SuspectedFalseAlarm
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

    def send_later(
        self, state: RunState, event: Escalated | SuspectedFalseAlarm, dialogue: DialogueState
    ) -> None:
        """Write to the operators whom an event names, about its dialogue."""
        if self._mailer is None:
            return
        match event:
            case Escalated():
                mail = self._request(state, event, dialogue)
                to = event.to.split(", ")
            case SuspectedFalseAlarm():
                mail, to = self._notice(state, event, dialogue), event.told
        if mail is None:
            return
        task = asyncio.create_task(self._send(self._mailer, mail, to))
        self._sending.add(task)
        task.add_done_callback(self._sending.discard)

    def _request(
        self, state: RunState, escalated: Escalated, dialogue: DialogueState
    ) -> MailRequest | MailNotice | None:
        ask, raised = dialogue.asked, dialogue.raised
        if ask is None:
            return None
        effects = {each.value: each.effect for each in ask.answers}
        return MailRequest(
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
            timeout_effect=ask.timeout_effect,
            answer_within_s=None if ask.deadline is None else ask.deadline - escalated.time,
            console_url=self._console_url,
        )

    def _notice(
        self, state: RunState, suspected: SuspectedFalseAlarm, dialogue: DialogueState
    ) -> MailNotice:
        return MailNotice(
            run=state.id,
            dialogue=dialogue.id,
            tree=state.started.tree_name,
            robot=suspected.robot,
            issue=suspected.issue,
            object=suspected.object,
            node=suspected.node,
            name=suspected.name,
            times=suspected.times,
            explanation=suspected.explanation,
            console_url=self._console_url,
        )

    async def _send(self, mailer: Mailer, mail: MailRequest | MailNotice, to: list[str]) -> None:
        try:
            refused = await mailer.send(mail, to, self._utc_now())
        except MailError as error:
            log.error("%s", error)
        else:
            if refused:
                log.error("the mail server refused %s", ", ".join(refused))

    async def close(self) -> None:
        """Wait for the mails that are under way."""
        await asyncio.gather(*self._sending, return_exceptions=True)
