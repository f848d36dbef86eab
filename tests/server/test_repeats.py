"""What is remembered of requests under keys, where the journal has nothing of it."""

import pytest
from sample_events import paused

from mend.server.access.roles import Role
from mend.server.api.repeats import MOST_KEPT_BYTES, MOST_REMEMBERED_BYTES, Repeats
from mend.server.journal.journal import Entry
from mend.server.journal.keyed_request import FirstAnswer, KeptRequest, KeyedAuthor, KeyedRequest
from mend.server.journal.sqlite import SqliteJournal
from mend.server.limits import Limits
from mend.server.refusals import Refusals

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


async def _kept(chars: int, *, secret: bool) -> KeptRequest | None:
    remembering = Remembering()
    answer = FirstAnswer(201, [], b"x" * chars)
    await remembering.repeats.keep(_request("one"), answer, secret=secret)
    kept = await remembering.repeats.find(_request("one"))
    remembering.journal.close()
    return kept


@pytest.mark.parametrize(("more", "is_kept"), [(0, True), (1, False)])
async def test_of_a_long_answer_that_is_kept_in_memory_only_the_request_is(
    more: int, is_kept: bool
) -> None:
    kept = await _kept(MOST_REMEMBERED_BYTES + more, secret=True)
    assert kept is not None
    assert (kept.answer is not None) is is_kept


@pytest.mark.parametrize(("more", "is_kept"), [(0, True), (1, False)])
async def test_of_a_long_answer_only_the_request_is_in_the_journal(
    more: int, is_kept: bool
) -> None:
    journal = SqliteJournal(":memory:")
    repeats = Repeats(journal, Limits(), Refusals(), lambda: 1000.0)
    author = KeyedAuthor(principal="anna", role=Role.OPERATOR, request=_request("one"))
    await journal.append(Entry(events=[paused(0.0).model_copy(update={"author": author})]))
    answer = FirstAnswer(201, [], b"x" * (MOST_KEPT_BYTES + more))
    await repeats.keep(_request("one"), answer, secret=False)
    kept = await journal.find_request("anna", "one", 0.0)
    assert kept is not None
    assert (kept.answer is not None) is is_kept
    journal.close()
