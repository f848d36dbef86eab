"""How much a request for a run may hold."""

import asyncio
from typing import Any

import pytest
from pretend_service import pretend_service
from task_documents import definition_of

from mend.errors import ConflictError, WrongInputError
from mend.server.journal.run_index import RunPage
from mend.server.limits import Limits
from mend.server.runtime.context import RunSettings
from mend.server.runtime.requests import RunRequest

ONE_PART = definition_of({"behavior": "pick_and_place", "object": "part_1", "place": "spot_1"})
LIMITS = Limits(answers=2, world_options=2, option_chars=5)


@pytest.mark.parametrize(
    ("fields", "sentence"),
    [
        ({"answers": ["yes"] * 3}, "'answers' has 3 entries; at most 2 are taken"),
        ({"world_options": {"a": 1, "b": 2, "c": 3}}, "'world_options' has 3 entries"),
        ({"world_options": {"abcdef": 1}}, "the world option 'abcdef' is too long"),
        ({"world_options": {"a": "abcdef"}}, "the world option 'a' is too long"),
        ({"world": "live", "world_options": {"a": 1}}, "is for simulated worlds"),
    ],
)
async def test_a_request_that_holds_too_much_is_refused(
    fields: dict[str, Any], sentence: str
) -> None:
    settings = RunSettings(limits=LIMITS)
    request = {"tree": "tree", "world": "tabletop", **fields}
    async with pretend_service(ONE_PART, settings=settings) as service:
        with pytest.raises(WrongInputError, match=sentence):
            await service.runtime.start_run(RunRequest.model_validate(request))
        assert service.journal.head == 0


async def test_a_request_at_its_limits_is_taken() -> None:
    settings = RunSettings(limits=LIMITS)
    options = {"abcde": "abcde", "b": 1}
    async with pretend_service(ONE_PART, settings=settings) as service:
        view, _ = await service.run_to_end(answers=["yes", "no"], world_options=options)
    assert view.status.ended


ONE = RunRequest.model_validate({"tree": "tree", "world": "tabletop", "speed": 1.0})


async def test_a_run_too_many_is_refused_and_nothing_of_it_is_kept() -> None:
    settings = RunSettings(limits=Limits(running_runs=2))
    async with pretend_service(ONE_PART, settings=settings) as service:
        started = [await service.runtime.start_run(ONE) for _ in range(2)]
        await service.runtime.pause(started[0].id)
        with pytest.raises(
            ConflictError, match="2 runs have not ended yet, and at most 2"
        ) as error:
            await service.runtime.start_run(ONE)
        assert error.value.limit == "running_runs"
        ids = {each.id for each in started}
        assert {each.id for each in await service.runtime.runs(RunPage())} == ids
        assert {each.run for each in await service.journal.index.page(RunPage())} == ids


async def test_runs_that_are_begun_at_the_same_moment_are_counted_too() -> None:
    settings = RunSettings(limits=Limits(running_runs=2))
    async with pretend_service(ONE_PART, settings=settings) as service:
        begun = await asyncio.gather(
            *(service.runtime.start_run(ONE) for _ in range(5)), return_exceptions=True
        )
        assert sum(isinstance(each, ConflictError) for each in begun) == 3
        assert len(await service.runtime.runs(RunPage())) == 2


async def test_a_run_that_has_ended_makes_room() -> None:
    settings = RunSettings(limits=Limits(running_runs=1))
    async with pretend_service(ONE_PART, settings=settings) as service:
        await service.run_to_end()
        first = await service.runtime.start_run(ONE)
        await service.runtime.abort(first.id)
        await service.runtime.wait_for_end(first.id)
        await service.runtime.start_run(ONE)
