"""Issues and reports over REST, and the client that reads them."""

from collections.abc import AsyncIterator
from datetime import UTC, datetime, timedelta
from uuid import UUID

import httpx
import pytest
from fake_runs import FakeRuns
from recorded_service import recorded_events
from service_under_test import ServiceUnderTest, build

from mend.errors import NotFoundError
from mend.server.journal.journal import Entry
from mend.server.journal.run_index import RunPage
from mend.server.runtime.run_views import summary_of_indexed
from mend.server.runtime.views import RunSummary

RECORDED = recorded_events()
RUN = RECORDED[0].run
RAISED = [each for each in RECORDED if vars(each)["type"] == "issue_raised"]


class IndexedRuns(FakeRuns):
    """The runs that the journal's index has."""

    async def runs(self, page: RunPage) -> list[RunSummary]:
        return [summary_of_indexed(each) for each in await self._journal.index.page(page)]

    async def run_summary(self, run: UUID) -> RunSummary:
        found = await self._journal.index.find(run)
        if found is None:
            raise NotFoundError(f"there is no run {run}")
        return summary_of_indexed(found)


@pytest.fixture
async def client() -> AsyncIterator[httpx.AsyncClient]:
    service: ServiceUnderTest = build(runs_in=IndexedRuns)
    await service.journal.append(Entry(events=RECORDED))
    async with service.client() as client:
        yield client
    service.journal.close()


async def found(client: httpx.AsyncClient, **wanted: str) -> list[str]:
    response = await client.get("/api/issues", params=wanted)
    assert response.status_code == 200, response.text
    return [f"{each['issue']} {each['object']}" for each in response.json()]


async def test_issues_are_listed_newest_first_and_found_by_what_is_known(
    client: httpx.AsyncClient,
) -> None:
    everything = await found(client)
    assert everything[0] == "unreachable purple_top"
    assert len(everything) == len(RAISED)
    assert await found(client, text="purple top") == ["unreachable purple_top"]
    assert await found(client, issue="missed") == ["missed blue_leg"]
    assert await found(client, object="pink_bar") == ["dropped pink_bar"]
    assert await found(client, outcome="gave_up", tree="eket", run=str(RUN)) == []
    assert await found(client, until=RAISED[1].wall_time.isoformat()) == ["dropped pink_bar"]
    later = RAISED[-1].wall_time.astimezone(UTC) + timedelta(seconds=1)
    assert await found(client, since=later.isoformat()) == []


async def test_a_page_goes_on_after_the_last_issue(client: httpx.AsyncClient) -> None:
    [first] = (await client.get("/api/issues", params={"limit": 1})).json()
    [second] = (await client.get("/api/issues", params={"limit": 1, "before": first["seq"]})).json()
    assert second["seq"] < first["seq"]


@pytest.mark.parametrize(
    "wrong",
    [
        {"since": "yesterday"},
        {"since": "2026-11-20T00:00:00"},
        {"outcome": "well"},
        {"limit": "0"},
        {"before": "-1"},
        {"run": "x"},
        {"text": "x" * 201},
    ],
)
async def test_what_cannot_be_searched_for_is_refused(
    client: httpx.AsyncClient, wrong: dict[str, str]
) -> None:
    response = await client.get("/api/issues", params=wrong)
    assert response.status_code == 422
    assert next(iter(wrong)) in str(response.json()["errors"])


async def test_runs_are_found_by_words_robot_and_date(client: httpx.AsyncClient) -> None:
    async def runs(**wanted: str) -> list[UUID]:
        response = await client.get("/api/runs", params=wanted)
        assert response.status_code == 200, response.text
        return [UUID(each["id"]) for each in response.json()]

    began = RECORDED[0].wall_time
    robot = vars(RAISED[0])["robot"]
    assert await runs(text="EKET") == await runs(robot=robot) == await runs(tree="eket") == [RUN]
    assert await runs(since=began.isoformat()) == [RUN]
    assert await runs(until=began.isoformat()) == await runs(robot=robot[:-1]) == []
    assert await runs(since=datetime(2100, 1, 1, tzinfo=UTC).isoformat()) == []


async def test_the_report_of_a_run_is_a_file_to_keep(client: httpx.AsyncClient) -> None:
    response = await client.get(f"/api/runs/{RUN}/report")
    assert response.status_code == 200
    kind = response.headers["content-disposition"]
    assert kind.startswith('attachment; filename="eket-2026')
    assert "purple top" in response.text.replace("_", " ")
    unknown = await client.get(f"/api/runs/{UUID(int=7)}/report")
    assert unknown.status_code == 404
