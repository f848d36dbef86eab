"""Who seeks the deeds of one principal among those of many others is answered page by page."""

from datetime import UTC, datetime
from pathlib import Path

import pytest
from people import People
from service_under_test import build

from mend.server.access.roles import Role
from mend.server.journal import events as ev
from mend.server.journal.journal import Entry

EVENTS = 35
NOW = datetime(2026, 5, 4, 12, tzinfo=UTC)
OLGA = ev.Author(principal="olga", role=Role.OPERATOR, address="10.0.0.7")
DELETED = ev.DocumentDeleted(wall_time=NOW, kind="tree", name="one", author=OLGA)


@pytest.mark.parametrize(("who", "found"), [("nobody", 0), ("olga", EVENTS)])
async def test_one_answer_looks_at_so_many_events_and_says_where_to_go_on(
    who: str, found: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("mend.server.api.principals.MOST_SCANNED", 10)
    monkeypatch.setattr("mend.server.api.principals.SCANNED_AT_ONCE", 5)
    people = People(tmp_path)
    service = build(principals=people.file)
    await service.journal.append(Entry(events=[DELETED] * EVENTS))
    deeds, ends = 0, [0]
    async with service.client(headers=people.headers(Role.ADMIN)) as client:
        more = True
        while more:
            query = {"who": who, "after": ends[-1], "limit": 1000}
            page = (await client.get("/api/access/deeds", params=query)).json()
            deeds, more = deeds + len(page["deeds"]), page["more"]
            ends.append(page["seq"])
    service.journal.close()
    assert deeds == found
    assert ends == [0, 10, 20, 30, 35]
