"""A device is called from when its helper asks for it until that ends, over restarts too."""

from collections.abc import AsyncIterator
from datetime import UTC, datetime
from pathlib import Path

import pytest
from people import NAMES

from mend.errors import ConflictError, NotFoundError
from mend.server.access.access import Access
from mend.server.access.changes import PrincipalsEditor
from mend.server.access.known_principals import KnownPrincipals
from mend.server.access.principal import Caller
from mend.server.access.roles import Role
from mend.server.journal import events as ev
from mend.server.journal.sqlite import SqliteJournal
from mend.server.limits import Limits
from mend.server.push.subscription import KIND, DeviceKeys
from mend.server.push.subscriptions import Device, PushSubscriptions

NOW = datetime(2026, 5, 4, 12, tzinfo=UTC)


class House:
    """Principals in a file, and a journal that outlives the service."""

    def __init__(self, folder: Path) -> None:
        self._file = folder / "principals.yaml"
        self.editor = PrincipalsEditor(self._file, by="root")
        self.tokens = {role: self.editor.add(name, role, NOW) for role, name in NAMES.items()}
        self.journal = SqliteJournal(folder / "journal.db")
        self.access = Access(
            None,
            principals=KnownPrincipals(self._file, lambda: NOW.timestamp()),
            wall_time_s=lambda: NOW.timestamp(),
        )

    def caller(self, role: Role) -> Caller:
        principal = self.access.of_token(self.tokens[role])
        assert principal is not None
        return Caller(principal, "10.0.0.7")

    async def subscriptions(self, key: str = "our key", most: int = 3) -> PushSubscriptions:
        """As after a start of the service."""
        limits = Limits(push_subscriptions=most)
        opened = PushSubscriptions(self.journal, self.access, key, limits, lambda: NOW)
        await opened.recover()
        return opened

    async def events(self) -> list[ev.Event]:
        return await self.journal.read(0, 100)


@pytest.fixture
async def house(tmp_path: Path) -> AsyncIterator[House]:
    house = House(tmp_path)
    yield house
    house.journal.close()


def phone(number: int = 1) -> Device:
    keys = DeviceKeys(p256dh="point", auth="secret")
    return Device(f"https://push.example.org/{number}", keys, f"phone {number}")


async def test_it_lasts_over_a_restart_and_its_secrets_are_in_no_event(house: House) -> None:
    helper = house.caller(Role.HELPER)
    added = await (await house.subscriptions()).add(phone(), "henri", helper)
    again = await house.subscriptions()
    assert list(again.of(helper)) == [added]
    assert list(again.of_helper("henri")) == list(again.of_helper(None)) == [added]
    assert again.of_helper("ada") == []
    [event] = await house.events()
    assert isinstance(event, ev.PushSubscribed)
    assert (event.helper, event.author.principal) == ("henri", "henri")
    assert "push.example.org" not in event.model_dump_json()
    assert "secret" not in event.model_dump_json()


async def test_a_browser_that_asks_again_is_one_device(house: House) -> None:
    subscriptions, helper = await house.subscriptions(), house.caller(Role.HELPER)
    first = await subscriptions.add(phone(), "henri", helper)
    second = await subscriptions.add(phone()._replace(name="old phone"), "henri", helper)
    assert first.id == second.id
    assert [each.device for each in subscriptions.of(helper)] == ["old phone"]


async def test_nobody_has_more_devices_than_the_limit(house: House) -> None:
    subscriptions, helper = await house.subscriptions(), house.caller(Role.HELPER)
    for number in range(3):
        await subscriptions.add(phone(number), "henri", helper)
    with pytest.raises(ConflictError, match="3 devices are called for 'henri' already"):
        await subscriptions.add(phone(3), "henri", helper)
    await subscriptions.add(phone(2), "henri", helper)
    await subscriptions.add(phone(4), "olga", house.caller(Role.OPERATOR))


async def test_one_that_is_ended_is_gone_after_a_restart_too(house: House) -> None:
    subscriptions, helper = await house.subscriptions(), house.caller(Role.HELPER)
    added = await subscriptions.add(phone(), "henri", helper)
    await subscriptions.end(added.id, "asked", helper.author)
    assert subscriptions.get(added.id) is None
    assert (await house.subscriptions()).of_helper(None) == []
    assert await house.journal.documents(KIND) == {}
    with pytest.raises(NotFoundError):
        await subscriptions.end(added.id, "asked")


async def test_nobody_finds_the_devices_of_another(house: House) -> None:
    subscriptions = await house.subscriptions()
    added = await subscriptions.add(phone(), "henri", house.caller(Role.HELPER))
    with pytest.raises(NotFoundError):
        subscriptions.one(added.id, house.caller(Role.ADMIN))


async def test_it_ends_with_the_credential_that_it_was_made_with(house: House) -> None:
    subscriptions, helper = await house.subscriptions(), house.caller(Role.HELPER)
    await subscriptions.add(phone(), "henri", helper)
    kept = await subscriptions.add(phone(2), "olga", house.caller(Role.OPERATOR))
    house.editor.rotate("henri", NOW)
    await house.access.look()
    assert list(subscriptions.of_helper(None)) == [kept]
    await subscriptions.let_go()
    assert (await house.events())[-1].model_dump()["why"] == "revoked"
    assert [each.helper for each in (await house.subscriptions()).of_helper(None)] == ["olga"]


async def test_what_expects_another_key_is_not_called(house: House) -> None:
    await (await house.subscriptions()).add(phone(), "henri", house.caller(Role.HELPER))
    assert (await house.subscriptions("a new key")).of_helper(None) == []
    assert (await house.events())[-1].model_dump()["why"] == "key_changed"
