"""Statistics over REST."""

from collections.abc import AsyncIterator
from datetime import timedelta

import pytest
from recorded_service import recorded_events
from service_under_test import ServiceUnderTest, build

from mend.server.api.statistics_views import Statistics
from mend.server.journal.journal import Entry

RECORDED = recorded_events()
BEGAN = RECORDED[0].wall_time


@pytest.fixture
async def service() -> AsyncIterator[ServiceUnderTest]:
    service = build()
    yield service
    service.journal.close()


async def told(service: ServiceUnderTest, **chosen: str) -> Statistics:
    async with service.client() as client:
        response = await client.get("/api/statistics", params=chosen)
    assert response.status_code == 200, response.text
    return Statistics.model_validate(response.json())


async def test_each_figure_comes_with_what_it_counts(service: ServiceUnderTest) -> None:
    await service.journal.append(Entry(events=RECORDED))
    found = await told(service)
    kinds = [vars(each)["type"] for each in RECORDED]
    raised = [vars(each) for each in RECORDED if vars(each)["type"] == "issue_raised"]
    picks = sum(getattr(each, "step_name", "") == "close gripper" for each in RECORDED)
    assert (found.runs.total, found.runs.finished) == (1, 1)
    assert found.total.faults == kinds.count("issue_raised") == found.total.outcomes.resolved
    assert found.total.picks == picks > 0
    assert found.total.faults_per_1000_picks == pytest.approx(1000 * len(raised) / picks)
    assert sum(each.faults for each in found.by_part.groups) == len(raised)
    [of_tree] = found.by_tree.groups
    assert (of_tree.name, of_tree.faults, of_tree.picks) == ("eket", len(raised), picks)
    assert {each.name for each in found.by_issue.groups} == {each["issue"] for each in raised}
    assert {each.picks for each in found.by_issue.groups} == {picks}
    # Its script has answered, and nobody else.
    assert (found.total.answers.count, found.total.answers.median_s) == (0, None)


async def test_without_picks_there_is_no_rate(service: ServiceUnderTest) -> None:
    empty = await told(service)
    assert (empty.runs.total, empty.total.picks, empty.total.faults_per_1000_picks) == (0, 0, None)
    without = [each for each in RECORDED if vars(each)["type"] != "step_started"]
    await service.journal.append(Entry(events=without))
    found = await told(service)
    assert found.total.faults > 0
    rates = {each.faults_per_1000_picks for each in (found.total, *found.by_part.groups)}
    assert rates == {None}


async def test_runs_are_chosen_by_time_tree_and_robot(service: ServiceUnderTest) -> None:
    await service.journal.append(Entry(events=RECORDED))
    later = (BEGAN + timedelta(seconds=1)).isoformat()
    assert (await told(service, since=later)).runs.total == 0
    assert (await told(service, until=later, tree="eket")).runs.total == 1
    assert (await told(service, tree="tea")).total.faults == 0
    assert (await told(service, robot="nobody")).runs.total == 0


@pytest.mark.parametrize(
    "wrong", [{"since": "yesterday"}, {"until": "2026-11-20T00:00:00"}, {"tree": "x" * 201}]
)
async def test_what_cannot_be_chosen_is_refused(
    service: ServiceUnderTest, wrong: dict[str, str]
) -> None:
    async with service.client() as client:
        response = await client.get("/api/statistics", params=wrong)
    assert response.status_code == 422
    assert next(iter(wrong)) in str(response.json()["errors"])
