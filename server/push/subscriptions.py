"""The devices that are to be called: kept in the journal, each until it ends."""

import logging
from collections.abc import Callable, Sequence
from datetime import datetime
from typing import Literal, NamedTuple

from pydantic import ValidationError

from mend.errors import ConflictError, NotFoundError
from mend.server.access.access import Access
from mend.server.access.principal import Caller
from mend.server.access.roles import Role
from mend.server.journal import events as ev
from mend.server.journal.journal import Document, Entry, Journal
from mend.server.limits import Limits
from mend.server.push.subscription import KIND, DeviceKeys, PushSubscription, id_of

log = logging.getLogger(__name__)

Why = Literal["asked", "gone", "revoked", "key_changed"]


class Device(NamedTuple):
    """A browser's subscription, as it sends it, and what the helper calls the device."""

    endpoint: str
    keys: DeviceKeys
    name: str


class PushSubscriptions:
    """Every subscription there is. `application_key`: the public half of the service's push key."""

    def __init__(
        self,
        journal: Journal,
        access: Access,
        application_key: str,
        limits: Limits,
        utc_now: Callable[[], datetime],
    ) -> None:
        self._journal = journal
        self._access = access
        self._application_key = application_key
        self._limits = limits
        self._utc_now = utc_now
        self._all: dict[str, PushSubscription] = {}

    async def recover(self) -> None:
        """Have every subscription again; what was made for another key ends, as nothing reaches it.

        One that cannot be read is left out.
        """
        for name, text in (await self._journal.documents(KIND)).items():
            try:
                found = PushSubscription.model_validate_json(text)
            except ValidationError as error:
                log.error("the device %s cannot be read, and is not called: %s", name, error)
                continue
            self._all[found.id] = found
        for each in list(self._all.values()):
            if each.application_key != self._application_key:
                await self.end(each.id, "key_changed")

    async def add(self, device: Device, helper: str, caller: Caller) -> PushSubscription:
        """Have a device called from now on; one that is known already takes the new place.

        Raises `ConflictError` where the principal has too many.
        """
        principal = caller.principal
        added = PushSubscription(
            id=id_of(device.endpoint),
            helper=helper,
            principal=principal.name,
            key=principal.key,
            device=device.name,
            since=self._utc_now(),
            endpoint=device.endpoint,
            keys=device.keys,
            application_key=self._application_key,
        )
        most = self._limits.push_subscriptions
        others = [each for each in self.of(caller) if each.id != added.id]
        if len(others) >= most:
            raise ConflictError(
                f"{most} devices are called for '{principal.name}' already: end one of them",
                limit="push_subscriptions",
            )
        event = ev.PushSubscribed(
            wall_time=self._utc_now(), helper=helper, device=device.name, author=caller.author
        )
        document = Document(KIND, added.id, added.model_dump_json())

        def fold(_: list[ev.Event]) -> None:
            self._all[added.id] = added

        await self._journal.append(Entry(events=[event], document=document), fold)
        return added

    async def end(self, subscription: str, why: Why, author: ev.Author | None = None) -> None:
        """Call a device no more. Raises `NotFoundError`."""
        found = self._all.get(subscription)
        if found is None:
            raise NotFoundError(f"there is no push subscription '{subscription}'")
        event = ev.PushEnded(
            wall_time=self._utc_now(),
            helper=found.helper,
            device=found.device,
            why=why,
            author=author,
        )

        def fold(_: list[ev.Event]) -> None:
            self._all.pop(subscription, None)

        await self._journal.append(
            Entry(events=[event], document=Document(KIND, found.id, None)), fold
        )

    async def let_go(self) -> None:
        """End what belongs to credentials that are good no more."""
        for each in list(self._all.values()):
            if self._access.still(each.principal, each.key) is None and each.id in self._all:
                await self.end(each.id, "revoked")

    def of(self, caller: Caller) -> Sequence[PushSubscription]:
        """Those of one principal, the first made first."""
        principal = caller.principal
        return [
            each
            for each in self._all.values()
            if (each.principal, each.key) == (principal.name, principal.key)
        ]

    def one(self, subscription: str, caller: Caller) -> PushSubscription:
        """One of a principal's own. Raises `NotFoundError`."""
        for each in self.of(caller):
            if each.id == subscription:
                return each
        raise NotFoundError(f"there is no push subscription '{subscription}' of yours")

    def get(self, subscription: str) -> PushSubscription | None:
        """One that has not ended."""
        return self._all.get(subscription)

    def of_helper(self, helper: str | None) -> Sequence[PushSubscription]:
        """The devices of one helper, None for everybody's, of those who may answer now."""
        return [
            each
            for each in self._all.values()
            if helper in (None, each.helper) and self._may_answer(each)
        ]

    def _may_answer(self, subscription: PushSubscription) -> bool:
        principal = self._access.still(subscription.principal, subscription.key)
        return principal is not None and principal.role.may(Role.HELPER)
