"""One push to one device, over HTTP: encrypted for it alone (RFC 8291), and signed (RFC 8292)."""

import asyncio
from dataclasses import dataclass
from enum import StrEnum
from typing import Literal

import httpx
from webpush import WebPush, WebPushSubscription

from mend.server.push.messages import PushMessage
from mend.server.push.push_key import PushKey
from mend.server.push.subscription import PushSubscription

TIMEOUT_S = 10.0
AT_ONCE = 20
"""Connections to push services at a time."""

SIGNED_FOR_S = 3600
LONGEST_WAIT_S = 300.0
"""So long a push service may have this one wait, whatever it says."""

Urgency = Literal["normal", "high"]


class Outcome(StrEnum):
    """What a push service made of a push."""

    TAKEN = "taken"
    GONE = "gone"
    LATER = "later"
    REFUSED = "refused"


@dataclass(frozen=True, slots=True)
class Answer:
    """What became of a push; `why` says it where it was not taken. `wait_s`: as it was told."""

    outcome: Outcome
    why: str = ""
    wait_s: float | None = None


class PushSender:
    """Writes to push services. `contact`: a mail address at which they may reach the operators.

    Encrypting is done in a thread and sending by asyncio: neither keeps the event loop busy.
    """

    def __init__(self, key: PushKey, contact: str, timeout_s: float = TIMEOUT_S) -> None:
        self._key = key
        self._contact = contact
        self._timeout_s = timeout_s
        self._client: httpx.AsyncClient | None = None
        self._opening = asyncio.Lock()

    async def send(
        self,
        subscription: PushSubscription,
        message: PushMessage,
        *,
        topic: str,
        ttl_s: int,
        urgency: Urgency = "high",
    ) -> Answer:
        """Push a message, which the push service keeps for `ttl_s` (0: not at all).

        Of two with one `topic` that wait for a device it keeps the later.
        """
        body, headers = await asyncio.to_thread(self._sealed, subscription, message, ttl_s)
        headers |= {"Topic": topic, "Urgency": urgency, "Content-Type": "application/octet-stream"}
        client = await self._opened()
        try:
            answer = await client.post(subscription.endpoint, content=body, headers=headers)
        except httpx.HTTPError as error:
            why = f"the push service was not reached ({str(error) or type(error).__name__})"
            return Answer(Outcome.LATER, why)
        return _read(answer)

    async def close(self) -> None:
        """Hang up."""
        if self._client is not None:
            await self._client.aclose()

    def _sealed(
        self, subscription: PushSubscription, message: PushMessage, ttl_s: int
    ) -> tuple[bytes, dict[str, str]]:
        # One for each push: it would remember the time to live of the one before.
        pushing = WebPush(
            self._key.private_pem,
            self._key.public_pem,
            subscriber=self._contact,
            ttl=ttl_s,
            expiration=SIGNED_FOR_S,
        )
        target = WebPushSubscription.model_validate(
            {"endpoint": subscription.endpoint, "keys": subscription.keys.model_dump()}
        )
        sealed = pushing.get(message.model_dump_json(), target)
        return sealed.encrypted, {name: str(value) for name, value in sealed.headers.items()}

    async def _opened(self) -> httpx.AsyncClient:
        """The client; reading the certificates to trust takes tens of milliseconds."""
        async with self._opening:
            if self._client is None:
                trusted = await asyncio.to_thread(httpx.create_ssl_context)
                self._client = httpx.AsyncClient(
                    verify=trusted,
                    timeout=self._timeout_s,
                    limits=httpx.Limits(max_connections=AT_ONCE),
                    follow_redirects=False,
                )
            return self._client


def _read(answer: httpx.Response) -> Answer:
    """What the statuses of RFC 8030 mean."""
    status = answer.status_code
    if answer.is_success:
        return Answer(Outcome.TAKEN)
    said = " ".join(answer.text[:200].split())
    why = f"the push service answered {status}" + (f" ({said})" if said else "")
    if status in (404, 410):
        return Answer(Outcome.GONE, why)
    if status == 429 or status >= 500:
        return Answer(Outcome.LATER, why, _wait_s(answer.headers.get("retry-after", "")))
    return Answer(Outcome.REFUSED, why)


def _wait_s(retry_after: str) -> float | None:
    is_number = retry_after.isascii() and retry_after.isdigit()
    return min(float(retry_after), LONGEST_WAIT_S) if is_number else None
