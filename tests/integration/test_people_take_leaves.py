"""People are agents too: they take a leaf, do it before the robot's eyes, or give it back."""

import asyncio
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import asynccontextmanager
from pathlib import Path
from uuid import UUID

import pytest
from broken_constraints import broken_constraints
from two_boxes import BENCH, BLUE, BOTH, RED
from untruths import kinds_of

from mend.errors import ConflictError, NotFoundError
from mend.server.composition import Service, open_service
from mend.server.journal import events as ev
from mend.server.journal.sqlite import IN_MEMORY
from mend.server.runtime.leaf_words import LeafDeed
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunStatus
from mend.server.settings import Settings
from mend.tasks.intervention import Act, Intervention


@asynccontextmanager
async def bench(**settings: object) -> AsyncIterator[Service]:
    values = {"port": 0, "log_level": "error", "speech_voice": "none", "journal": Path(IN_MEMORY)}
    async with open_service(Settings.model_validate({**values, **settings})) as service:
        if "both" not in await service.journal.documents("tree"):
            await service.library.scenes.save("small_bench", BENCH)
            await service.library.trees.save("both", BOTH)
        yield service


async def begin(service: Service) -> UUID:
    request = RunRequest(tree="both", world="tabletop", speed="max", seed=2, answers="none")
    return (await service.runtime.start_run(request)).id


async def when(service: Service, so: Callable[[ev.Event], bool]) -> ev.Event:
    """The first event of which something is so, also of those that were."""
    with service.journal.subscribe(0) as records:
        async with asyncio.timeout(60.0):
            async for record in records:
                event: ev.Event = ev.any_event.validate_json(record.text)
                if so(event):
                    return event
    raise AssertionError("the journal has ended")


async def to_the_end(service: Service, run: UUID) -> Sequence[ev.Event]:
    view = await asyncio.wait_for(service.runtime.wait_for_end(run), 60.0)
    assert view.status is RunStatus.FINISHED, view.result
    events = await service.journal.read(0, 100_000, run)
    started = events[0]
    assert isinstance(started, ev.RunStarted)
    assert broken_constraints(events, kinds_of(started)) == []
    return events


def started(events: Sequence[ev.Event]) -> set[str]:
    return {each.node for each in events if isinstance(each, ev.NodeStarted)}


def done_by(events: Sequence[ev.Event]) -> dict[str, str]:
    return {each.node: each.by for each in events if isinstance(each, ev.NodeDone)}


async def test_what_a_person_does_themselves_is_seen_and_no_robot_begins_it() -> None:
    async with bench() as service:
        run = await begin(service)
        await service.runtime.take_leaf(run, BLUE, "anna")
        await when(service, lambda each: isinstance(each, ev.NodeDone) and each.node == RED)
        deed = Intervention(act=Act.PLACE, object="blue_box", place="blue_box")
        await service.runtime.intervene(run, deed)
        events = await to_the_end(service, run)
    assert started(events) == {RED}
    assert done_by(events) == {RED: "robot", BLUE: "human"}


async def test_what_is_given_back_is_the_robots_again() -> None:
    async with bench() as service:
        run = await begin(service)
        await service.runtime.take_leaf(run, BLUE, "anna")
        with pytest.raises(ConflictError, match="is not bert's to give back"):
            await service.runtime.give_leaf_back(run, BLUE, "bert")
        await service.runtime.give_leaf_back(run, BLUE, "anna")
        events = await to_the_end(service, run)
    assert done_by(events) == {RED: "robot", BLUE: "robot"}


async def test_plain_words_take_a_leaf_and_give_it_back() -> None:
    async with bench() as service:
        run = await begin(service)
        said = await service.runtime.say_of_leaf(run, "I'll do the blue box.", "anna")
        assert (said.deed, said.node) == (LeafDeed.TAKE, BLUE)
        with pytest.raises(ConflictError, match="is not bert's to give back"):
            await service.runtime.say_of_leaf(run, "I give the blue box back", "bert")
        said = await service.runtime.say_of_leaf(run, "I give the blue box back", "anna")
        assert (said.deed, said.node) == (LeafDeed.GIVE_BACK, BLUE)
        with pytest.raises(NotFoundError, match="no part 'saucer'"):
            await service.runtime.say_of_leaf(run, "I do the saucer", "anna")
        events = await to_the_end(service, run)
    assert done_by(events) == {RED: "robot", BLUE: "robot"}


async def test_what_nobody_does_in_time_is_the_robots_again() -> None:
    async with bench(person_leaf_s=5.0) as service:
        run = await begin(service)
        await service.runtime.take_leaf(run, BLUE, "anna")
        events = await to_the_end(service, run)
    (reset,) = [each for each in events if isinstance(each, ev.NodeReset)]
    assert reset.reason == "anna has not done it in time"
    assert not reset.failed_attempt
    assert done_by(events) == {RED: "robot", BLUE: "robot"}


async def test_it_is_theirs_also_after_a_restart(tmp_path: Path) -> None:
    async with bench(journal=tmp_path / "journal.db") as service:
        run = await begin(service)
        await service.runtime.take_leaf(run, BLUE, "anna")
    async with bench(journal=tmp_path / "journal.db") as service:
        await when(service, lambda each: isinstance(each, ev.NodeDone) and each.node == RED)
        deed = Intervention(act=Act.PLACE, object="blue_box", place="blue_box")
        await service.runtime.intervene(run, deed)
        events = await to_the_end(service, run)
    assert started(events) == {RED}
    assert done_by(events)[BLUE] == "human"


async def test_what_cannot_be_taken_is_refused_with_a_sentence() -> None:
    async with bench() as service:
        run = await begin(service)
        await when(service, lambda each: isinstance(each, ev.NodeStarted))
        nodes = (await service.runtime.run(run)).nodes
        (active,) = [each for each in nodes if each.active and each.kind == "behavior"]
        with pytest.raises(ConflictError, match=f"{active.owner} is at it"):
            await service.runtime.take_leaf(run, active.node, "anna")
        with pytest.raises(NotFoundError, match="is no behavior"):
            await service.runtime.take_leaf(run, "/", "anna")
        with pytest.raises(NotFoundError):
            await service.runtime.take_leaf(run, "/7", "anna")
        await to_the_end(service, run)
        with pytest.raises(ConflictError, match="the run has ended"):
            await service.runtime.take_leaf(run, BLUE, "anna")
