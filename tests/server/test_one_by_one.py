"""Who asks for many turns keeps the others waiting for one of them."""

import asyncio
from contextvars import copy_context

import pytest
from service_under_test import TOKEN, build

from mend.errors import NotFoundError
from mend.server.access.principal import TOKEN_NAME
from mend.server.asking import asker
from mend.server.errors import BusyError
from mend.server.one_by_one import OneByOne


class Shop:
    """Somewhere with turns, of which each lasts until the next thing happens."""

    def __init__(self, most_chars: int = 100) -> None:
        self.turns = OneByOne(most_chars)
        self.served: list[str] = []

    def ask(self, who: str, what: str, chars: int = 1) -> asyncio.Task[None]:
        context = copy_context()
        context.run(asker.set, who)
        return asyncio.create_task(self._serve(what, chars), context=context)

    async def _serve(self, what: str, chars: int) -> None:
        async with self.turns.turn(chars):
            self.served.append(what)
            for _ in range(5):
                await asyncio.sleep(0)


async def test_who_asks_for_much_keeps_nobody_waiting_for_more_than_one_turn() -> None:
    shop = Shop()
    asked = [shop.ask("anna", f"anna {n}") for n in range(4)]
    await asyncio.sleep(0)
    asked += [shop.ask("ben", f"ben {n}") for n in range(2)] + [shop.ask("cleo", "cleo 0")]
    await asyncio.gather(*asked)
    rounds = ["anna 0", "ben 0", "cleo 0"], ["anna 1", "ben 1"], ["anna 2"], ["anna 3"]
    assert shop.served == [each for one in rounds for each in one]


async def test_who_has_a_turn_waits_within_it_for_nothing_else_of_their_own() -> None:
    """Else everybody who waits for that turn would wait for all of it."""
    shop, office = Shop(), Shop()

    async def sign() -> None:
        async with office.turns.turn(1):
            await shop.ask(asker.get(), f"within {asker.get().split()[0]}")

    async def signed(who: str) -> None:
        asker.set(who)
        await sign()

    asked = [shop.ask("anna", f"anna {n}") for n in range(4)]
    await asyncio.sleep(0)
    signing = [asyncio.create_task(signed(who)) for who in ("anna", "ben")]
    await asyncio.gather(*asked, *signing)
    assert shop.served[:3] == ["anna 0", "within anna", "anna 1"]
    assert shop.served.index("within ben") <= 3


async def test_who_goes_away_loses_their_turn_and_nobody_elses() -> None:
    shop = Shop()
    asked = [shop.ask("anna", f"anna {n}") for n in range(4)] + [shop.ask("ben", "ben 0")]
    await asyncio.sleep(0)
    for each in (asked[0], asked[2]):
        each.cancel()
    await asyncio.gather(*asked, return_exceptions=True)
    assert shop.served == ["anna 0", "ben 0", "anna 1", "anna 3"]


async def test_who_fills_the_room_leaves_the_others_one_turn_each() -> None:
    shop = Shop(most_chars=10)
    asked = [shop.ask("anna", f"anna {n}", 5) for n in range(2)]
    await asyncio.sleep(0)
    with pytest.raises(BusyError):
        await shop.ask("anna", "anna 2", 5)
    ben = shop.ask("ben", "ben 0", 5)
    await asyncio.sleep(0)
    with pytest.raises(BusyError):
        await shop.ask("ben", "ben 1", 5)
    await asyncio.gather(*asked, ben)
    assert sorted(shop.served) == ["anna 0", "anna 1", "ben 0"]


async def test_a_request_asks_for_who_makes_it(monkeypatch: pytest.MonkeyPatch) -> None:
    service, asked = build(token=TOKEN), []

    async def get(_: str) -> None:
        asked.append(asker.get())
        raise NotFoundError("there is none")

    monkeypatch.setattr(service.app.state.services.trees, "get", get)
    async with service.client(headers={"Authorization": f"Bearer {TOKEN}"}) as client:
        await client.get("/api/trees/big")
    assert asked == [TOKEN_NAME]
    service.journal.close()
