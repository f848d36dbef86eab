"""What is remembered of requests under keys, where the journal has nothing of it."""

from server.api.repeats import Repeats
from server.journal.keyed_request import FirstAnswer, KeyedRequest
from server.journal.sqlite import SqliteJournal
from server.limits import Limits
from server.refusals import Refusals

LASTS_S = 100.0
MOST = 2


class Remembering:
    """Requests of one principal whose answers are secret, and a clock."""

    def __init__(self) -> None:
        self.now_s = 1000.0
        self.journal = SqliteJournal(":memory:")
        self.refusals = Refusals()
        limits = Limits(idempotency_keys=MOST, idempotency_s=LASTS_S)
        self.repeats = Repeats(self.journal, limits, self.refusals, lambda: self.now_s)

    async def keep(self, key: str) -> None:
        await self.repeats.keep(_request(key), FirstAnswer(201, [], b"{}"), secret=True)

    async def knows(self, key: str) -> bool:
        return await self.repeats.find(_request(key)) is not None


def _request(key: str) -> KeyedRequest:
    return KeyedRequest("anna", key, b"digest")


async def test_a_key_that_is_used_anew_hides_none_whose_time_is_over() -> None:
    remembering = Remembering()
    await remembering.keep("first")
    await remembering.keep("second")
    remembering.now_s += LASTS_S + 1
    await remembering.keep("first")
    assert list(remembering.repeats._remembered) == [("anna", "first")]
    remembering.journal.close()


async def test_a_key_that_is_used_anew_is_not_the_first_to_go() -> None:
    remembering = Remembering()
    await remembering.keep("first")
    remembering.now_s += LASTS_S / 2
    await remembering.keep("second")
    remembering.now_s += LASTS_S / 2 + 1
    await remembering.keep("first")
    await remembering.keep("third")
    assert await remembering.knows("first")
    assert await remembering.knows("third")
    assert not await remembering.knows("second")
    assert remembering.refusals.counts["idempotency_keys"] == 1
    remembering.journal.close()
