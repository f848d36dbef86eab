"""Mail to the operators: an unanswered question, a suspected false alarm; sent beside the run."""

import asyncio
import logging
from collections.abc import Callable, Sequence
from dataclasses import replace
from datetime import datetime, timedelta

from mend.server.dialogues.mail import Mailer, MailError, MailNotice, MailRequest
from mend.server.journal.events import Escalated, SuspectedFalseAlarm
from mend.server.journal.trouble import Sleep
from mend.server.runtime.dialogue_state import DialogueState
from mend.server.runtime.run_state import RunState

log = logging.getLogger(__name__)


WAITS_S = (5.0, 30.0, 120.0, 300.0)
"""Between two tries; a mail that cannot be sent after the last is given up."""

LAST_MOMENT_S = 0.75
"""So long a mail that is just under way may take when the service stops."""

HANG_UP_S = 0.2
"""And so long to take leave of the server."""


class OperatorMail:
    """Sends mails without keeping any run waiting, and tries again when that fails.

    What became of each mail is logged. `console` is the address at which operators reach the
    console, if it is known.
    """

    def __init__(
        self,
        mailer: Mailer | None,
        utc_now: Callable[[], datetime],
        console: str | None,
        sleep: Sleep = asyncio.sleep,
    ) -> None:
        self._mailer = mailer
        self._utc_now = utc_now
        self._console = console
        self._sleep = sleep
        self._sending: set[asyncio.Task[None]] = set()
        self._between_tries: set[asyncio.Task[None]] = set()

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
        sending = self._send(self._mailer, mail, to, lambda: _is_wanted(mail, dialogue))
        task = asyncio.create_task(sending, name="mail")
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
            console_url=self._address_of(state),
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
            console_url=self._address_of(state),
        )

    def _address_of(self, state: RunState) -> str | None:
        return None if self._console is None else f"{self._console}/runs/{state.id}"

    async def _send(
        self,
        mailer: Mailer,
        mail: MailRequest | MailNotice,
        to: Sequence[str],
        is_wanted: Callable[[], bool],
    ) -> None:
        """Send a mail, again and again if need be, and log what became of it."""
        begun = self._utc_now()
        about = f"about the {mail.issue} issue of {mail.robot}"
        left = tuple(to)
        try:
            for wait_s in (*WAITS_S, None):
                now = self._utc_now()
                left, why = await self._try(mailer, _as_of(mail, now - begun), left, now)
                if not left:
                    return
                people = ", ".join(left)
                if wait_s is None:
                    log.error("the mail %s to %s is given up: %s", about, people, why)
                    return
                log.warning("%s; trying again in %g s", why, wait_s)
                await self._wait(wait_s)
                if not is_wanted():
                    log.info("the mail %s to %s is not needed any more", about, people)
                    return
        except asyncio.CancelledError:
            log.error("the service stops: the mail %s to %s was not sent", about, ", ".join(left))
            raise

    async def _try(
        self, mailer: Mailer, mail: MailRequest | MailNotice, to: tuple[str, ...], now: datetime
    ) -> tuple[tuple[str, ...], str]:
        """Send a mail once; whom it should still be sent to, and why it was not."""
        try:
            refused = await mailer.send(mail, to, now)
        except MailError as error:
            if error.for_now:
                return to, str(error)
            log.error("%s; that is final", error)
            return (), ""
        for each in refused:
            if not each.for_now:
                log.error("the mail server refuses %s: %s", each.address, each.reason)
        later = [each for each in refused if each.for_now]
        why = "; ".join(f"the mail server puts {each.address} off: {each.reason}" for each in later)
        return tuple(each.address for each in later), why

    async def _wait(self, seconds: float) -> None:
        task = asyncio.current_task()
        assert task is not None, "each mail is a task of its own"
        self._between_tries.add(task)
        try:
            await self._sleep(seconds)
        finally:
            self._between_tries.discard(task)

    async def close(self) -> None:
        """Give the mails that are under way a last moment; what was not sent then is logged."""
        for task in tuple(self._between_tries):
            task.cancel()
        await _end(self._sending, LAST_MOMENT_S)
        # Once to have it take leave of the server, once more if the server does not even do that.
        for _ in range(2):
            for task in tuple(self._sending):
                task.cancel()
            await _end(self._sending, HANG_UP_S)


async def _end(tasks: set[asyncio.Task[None]], within_s: float) -> None:
    """Wait until all have ended, but not for ever."""
    if tasks:
        await asyncio.wait(tuple(tasks), timeout=within_s)


def _is_wanted(mail: MailRequest | MailNotice, dialogue: DialogueState) -> bool:
    """Whether there is still something to answer; a notice is worth reading at any time."""
    if isinstance(mail, MailNotice):
        return True
    return dialogue.open_ask is not None and dialogue.open_ask.prompt == mail.prompt


def _as_of(mail: MailRequest | MailNotice, later: timedelta) -> MailRequest | MailNotice:
    """The mail when it is sent later than it was written: there is less time to answer."""
    if isinstance(mail, MailNotice) or mail.answer_within_s is None:
        return mail
    return replace(mail, answer_within_s=max(0.0, mail.answer_within_s - later.total_seconds()))
