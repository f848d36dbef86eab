"""What waits to be pushed to devices: to each in order, and of one topic only what is newest."""

import asyncio
import logging
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from mend.server.background import Endless
from mend.server.pace import Sleep
from mend.server.push.messages import PushMessage
from mend.server.push.sending import Answer, Outcome, Urgency
from mend.server.push.subscription import PushSubscription

log = logging.getLogger(__name__)

WAITS_S = (1.0, 4.0, 15.0, 60.0)
"""Between two tries, where the push service names no time; after the last a push is given up."""

LAST_MOMENT_S = 0.5
"""So long what is under way may take when the service stops."""


@dataclass(frozen=True, slots=True)
class Letter:
    """A message to one device; after `until` (monotonic seconds) it is of no use."""

    topic: str
    message: PushMessage
    until: float
    urgency: Urgency = "high"


class Sender(Protocol):
    """Sends one push; `mend.server.push.sending.PushSender`."""

    async def send(
        self,
        subscription: PushSubscription,
        message: PushMessage,
        *,
        topic: str,
        ttl_s: int,
        urgency: Urgency,
    ) -> Answer: ...


class Outbox:
    """Sends letters; devices do not wait for one another, nor does anybody for them.

    `gone` is told of a device that its push service knows no more. What became of a letter that
    was not taken is logged.
    """

    def __init__(
        self,
        sender: Sender,
        gone: Callable[[PushSubscription], None],
        monotonic: Callable[[], float],
        sleep: Sleep = asyncio.sleep,
    ) -> None:
        self._sender = sender
        self._gone = gone
        self._monotonic = monotonic
        self._sleep = sleep
        self._waiting: dict[str, dict[str, Letter]] = {}
        self._sending: dict[str, asyncio.Task[None]] = {}
        self._endless = Endless("pushing to devices", monotonic)

    def put(self, device: PushSubscription, letter: Letter) -> None:
        """Send a letter soon; it takes the place of one of its topic that has not left yet."""
        waiting = self._waiting.setdefault(device.id, {})
        waiting.pop(letter.topic, None)
        waiting[letter.topic] = letter
        if device.id not in self._sending:
            task = asyncio.create_task(self._send_all(device), name="push")
            self._sending[device.id] = task

    async def sent(self) -> None:
        """Wait until nothing waits any more."""
        while self._sending:
            await asyncio.wait(tuple(self._sending.values()))

    async def close(self) -> None:
        """Give what is under way a last moment."""
        tasks = tuple(self._sending.values())
        if tasks:
            await asyncio.wait(tasks, timeout=LAST_MOMENT_S)
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    async def _send_all(self, device: PushSubscription) -> None:
        waiting = self._waiting[device.id]
        try:
            while waiting:
                letter = waiting.pop(next(iter(waiting)))
                there = True
                with self._endless.one_pass():
                    there = await self._send(device, letter)
                if not there:
                    return
        finally:
            del self._waiting[device.id], self._sending[device.id]

    async def _send(self, device: PushSubscription, letter: Letter) -> bool:
        """Send a letter, again and again if need be; False if the device is gone."""
        waiting = self._waiting[device.id]
        for wait_s in (*WAITS_S, None):
            left_s = letter.until - self._monotonic()
            if left_s <= 0:
                log.warning("a push to %s of %s came too late", device.device, device.helper)
                return True
            answer = await self._sender.send(
                device,
                letter.message,
                topic=letter.topic,
                ttl_s=math.ceil(left_s),
                urgency=letter.urgency,
            )
            if answer.outcome is Outcome.TAKEN:
                return True
            if answer.outcome is Outcome.GONE:
                log.info("%s of %s is gone: %s", device.device, device.helper, answer.why)
                self._gone(device)
                return False
            if answer.outcome is Outcome.REFUSED or wait_s is None:
                log.error("%s of %s was not called: %s", device.device, device.helper, answer.why)
                return True
            await self._sleep(answer.wait_s or wait_s)
            # What has come meanwhile about the same says all.
            letter = waiting.pop(letter.topic, letter)
        return True
