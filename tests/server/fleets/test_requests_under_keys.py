"""What is asked for under an idempotency key is booked once, whatever becomes of the answer."""

from types import SimpleNamespace
from typing import Any, cast

import pytest
from dispatch_office import asked
from test_legs_as_runs import Work, working

from mend.fleet.requests import Recurrence
from mend.server.access.roles import Role
from mend.server.api.first_answers import answer_of
from mend.server.api.services import Services
from mend.server.fleets.request_refused import RequestRefusedError
from mend.server.journal.keyed_request import KeyedAuthor, KeyedRequest

KEYED = KeyedRequest("anna", "one", b"digest")
ANNA = KeyedAuthor(principal="anna", role=Role.HELPER, request=KEYED)


async def answered(work: Work, seq: int) -> Any:
    async def request(_: object, name: str) -> object:
        return work.site.id, await work.fleet.read(lambda all_: all_.view(name))

    services = SimpleNamespace(journal=work.journal, fleets=SimpleNamespace(request=request))
    return await answer_of(seq, cast(Services, services))


@pytest.mark.parametrize(
    ("recurrence", "name"), [(None, "tea"), (Recurrence(every_s=3600.0, until_s=7200.0), "tea/1")]
)
async def test_an_answer_that_was_lost_is_made_of_what_was_booked(
    recurrence: Recurrence | None, name: str
) -> None:
    async with working("a") as work:
        await work.fleet.requesters.submit(asked(recurrence=recurrence), ANNA)
        kept = await work.journal.find_request("anna", "one", 0.0)
        assert kept is not None
        answer = await answered(work, kept.seq)
        assert answer.status == 201
        assert f'"name":"{name}"'.encode() in answer.body
        assert ("location", f"/api/requests/{name}?site={work.site.id}") in answer.headers


async def test_what_is_refused_leaves_its_key_free_to_ask_once_more() -> None:
    async with working("a") as work:
        with pytest.raises(RequestRefusedError):
            await work.fleet.requesters.submit(asked(latest_s=1.0), ANNA)
        assert await work.journal.find_request("anna", "one", 0.0) is None
