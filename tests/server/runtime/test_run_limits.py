"""How much a request for a run may hold."""

from typing import Any

import pytest
from pretend_service import pretend_service
from task_documents import definition_of

from server.errors import InvalidError
from server.limits import Limits
from server.runtime.context import RunSettings
from server.runtime.requests import RunRequest

ONE_PART = definition_of({"behavior": "pick_and_place", "object": "part_1", "place": "spot_1"})
LIMITS = Limits(answers=2, world_options=2, option_chars=5)


@pytest.mark.parametrize(
    ("fields", "sentence"),
    [
        ({"answers": ["yes"] * 3}, "'answers' has 3 entries; at most 2 are taken"),
        ({"world_options": {"a": 1, "b": 2, "c": 3}}, "'world_options' has 3 entries"),
        ({"world_options": {"abcdef": 1}}, "the world option 'abcdef' is too long"),
        ({"world_options": {"a": "abcdef"}}, "the world option 'a' is too long"),
    ],
)
async def test_a_request_that_holds_too_much_is_refused(
    fields: dict[str, Any], sentence: str
) -> None:
    settings = RunSettings(limits=LIMITS)
    request = {"tree": "tree", "world": "tabletop", **fields}
    async with pretend_service(ONE_PART, settings=settings) as service:
        with pytest.raises(InvalidError, match=sentence):
            await service.runtime.start_run(RunRequest.model_validate(request))
        assert service.journal.head == 0


async def test_a_request_at_its_limits_is_taken() -> None:
    settings = RunSettings(limits=LIMITS)
    options = {"abcde": "abcde", "b": 1}
    async with pretend_service(ONE_PART, settings=settings) as service:
        view, _ = await service.run_to_end(answers=["yes", "no"], world_options=options)
    assert view.status.ended
