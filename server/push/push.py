"""Web push as the rest of the service uses it."""

import asyncio
import logging
import time
from collections.abc import Callable, Coroutine, Sequence
from datetime import datetime
from pathlib import Path

from mend.errors import MendError, NotFoundError, UnavailableError, WrongInputError
from mend.server.access.access import Access
from mend.server.access.principal import Caller
from mend.server.journal.journal import Journal
from mend.server.push.calling import Calling, Dialogues, Runs
from mend.server.push.messages import TrialMessage
from mend.server.push.outbox import Outbox
from mend.server.push.push_key import push_key
from mend.server.push.push_services import why_not_endpoint, why_not_keys
from mend.server.push.sending import Answer, PushSender
from mend.server.push.subscription import PushSubscription
from mend.server.push.subscriptions import Device, PushSubscriptions
from mend.server.settings import Settings

log = logging.getLogger(__name__)

TRIAL_S = 30
"""So long a trial is kept for a device that is not reached at once."""


class Push:
    """The devices, the calls to them, and trials; `key_file` None keeps the key in memory."""

    def __init__(
        self,
        journal: Journal,
        dialogues: Dialogues,
        runs: Runs,
        access: Access,
        settings: Settings,
        key_file: Path | None,
        utc_now: Callable[[], datetime],
        monotonic: Callable[[], float] = time.monotonic,
    ) -> None:
        key = push_key(key_file)
        self.application_key = key.public
        self._services = settings.push_services
        self._helpers = settings.helpers
        self._sender = PushSender(key, settings.contact_for_push_services)
        self.subscriptions = PushSubscriptions(
            journal, access, key.public, settings.limits, utc_now
        )
        self._outbox = Outbox(self._sender, self._forget_later, monotonic)
        self._calling = Calling(
            journal, dialogues, runs, self.subscriptions, self._outbox, monotonic
        )
        self._tasks: set[asyncio.Task[None]] = set()

    @property
    def available(self) -> bool:
        """Whether there is a push service that may be written to."""
        return bool(self._services)

    def asks(self, helper: str) -> bool:
        """Whether questions are ever put to a helper."""
        return not self._helpers or helper in self._helpers

    def helpers(self) -> frozenset[str]:
        """Those with a device that is called."""
        devices = self.subscriptions.of_helper(None) if self.available else ()
        return frozenset(each.helper for each in devices)

    async def start(self) -> None:
        """Have the devices again, and call them from now on."""
        await self.subscriptions.recover()
        await self._calling.recover()
        self._spawn(self._calling.follow())

    async def subscribe(self, device: Device, helper: str, caller: Caller) -> PushSubscription:
        """Call a device from now on.

        Raises `UnavailableError` where no push services are used, `WrongInputError` for one that
        is not used or keys that are none, `ConflictError` for too many.
        """
        if not self.available:
            raise UnavailableError("this service pushes to nobody: 'push_services' is empty")
        why = why_not_endpoint(device.endpoint, self._services)
        mistake = f"body.endpoint: {why}" if why else None
        if mistake is None and (why := why_not_keys(device.keys.p256dh, device.keys.auth)):
            mistake = f"body.keys: {why}"
        if mistake is not None:
            raise WrongInputError(mistake, [mistake])
        return await self.subscriptions.add(device, helper, caller)

    async def unsubscribe(self, subscription: str, caller: Caller) -> None:
        """Call one of the caller's devices no more. Raises `NotFoundError`."""
        found = self.subscriptions.one(subscription, caller)
        await self.subscriptions.end(found.id, "asked", caller.author)

    def of(self, caller: Caller) -> Sequence[PushSubscription]:
        """The caller's devices."""
        return self.subscriptions.of(caller)

    async def try_out(self, subscription: str, nonce: str, caller: Caller) -> Answer:
        """Push the nonce to one of the caller's devices, once. Raises `NotFoundError`."""
        found = self.subscriptions.one(subscription, caller)
        answer = await self._sender.send(
            found, TrialMessage(nonce=nonce), topic="trial", ttl_s=TRIAL_S, urgency="high"
        )
        if answer.outcome == "gone":
            await self._forget(found)
        return answer

    async def close(self) -> None:
        """Call nobody any more."""
        for task in tuple(self._tasks):
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        await self._outbox.close()
        await self._sender.close()

    def _forget_later(self, device: PushSubscription) -> None:
        self._spawn(self._forget(device))

    async def _forget(self, device: PushSubscription) -> None:
        try:
            await self.subscriptions.end(device.id, "gone")
        except NotFoundError:
            return
        except MendError as error:
            log.warning("%s of %s stays for now: %s", device.device, device.helper, error)

    def _spawn(self, work: Coroutine[None, None, None]) -> None:
        task = asyncio.create_task(work, name="calling")
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
