"""A browser whose push service is the one of a test: what comes there goes to its worker."""

import asyncio
import json
from typing import Any
from urllib.parse import urlsplit

from playwright.async_api import CDPSession, Page
from push_endpoint import PushDevice, PushService

_SUBSCRIBED = """({ endpoint, keys }) => {
  let current = null;
  const made = (key) => ({
    endpoint,
    options: { applicationServerKey: key },
    toJSON: () => ({ endpoint, keys }),
    unsubscribe: async () => { current = null; return true; },
  });
  const bytes = (text) => Uint8Array.from(
    atob(text.replaceAll("-", "+").replaceAll("_", "/")), (each) => each.charCodeAt(0)).buffer;
  PushManager.prototype.getSubscription = async () => current;
  PushManager.prototype.subscribe = async ({ applicationServerKey }) => {
    current = made(bytes(applicationServerKey));
    return current;
  };
}"""


class PushedBrowser:
    """Hands every push on as the browser would, decrypted."""

    def __init__(self, page: Page, pushes: PushService, name: str) -> None:
        self.device = PushDevice(pushes, name)
        self._page = page
        self._pushes = pushes
        self._taken = 0
        self._session: CDPSession | None = None
        self._registration: asyncio.Future[str] = asyncio.get_running_loop().create_future()

    async def begin(self) -> None:
        """Be the push service of a page that is open already."""
        await self._page.context.grant_permissions(["notifications"])
        said = {key: self.device.subscription[key] for key in ("endpoint", "keys")}
        await self._page.evaluate(_SUBSCRIBED, said)
        self._session = await self._page.context.new_cdp_session(self._page)
        self._session.on("ServiceWorker.workerRegistrationUpdated", self._note)
        await self._session.send("ServiceWorker.enable")

    def _note(self, event: dict[str, Any]) -> None:
        for each in event["registrations"]:
            if not self._registration.done():
                self._registration.set_result(each["registrationId"])

    async def hand_on(self, count: int = 1) -> list[Any]:
        """Wait for so many pushes, and hand them on; returns their messages."""
        async with asyncio.timeout(60):
            while len(self._pushes.of(self.device)) < self._taken + count:  # noqa: ASYNC110
                await asyncio.sleep(0.01)
            registration = await self._registration
        messages = self._pushes.of(self.device)[self._taken : self._taken + count]
        self._taken += count
        assert self._session is not None, "it has begun"
        parts = urlsplit(self._page.url)
        for message in messages:
            await self._session.send(
                "ServiceWorker.deliverPushMessage",
                {
                    "origin": f"{parts.scheme}://{parts.netloc}",
                    "registrationId": registration,
                    "data": json.dumps(message.model_dump(mode="json")),
                },
            )
        return messages

    async def notices(self) -> list[dict[str, Any]]:
        """What the device shows."""
        shown: list[dict[str, Any]] = await self._page.evaluate(
            "async () => (await (await navigator.serviceWorker.ready).getNotifications())"
            ".map(({ title, body, tag }) => ({ title, body, tag }))"
        )
        return shown

    async def shows_something(self) -> None:
        """Wait until the device shows a notification."""
        async with asyncio.timeout(60):
            while await self.notices() == []:  # noqa: ASYNC110 - the browser tells nobody
                await asyncio.sleep(0.02)
