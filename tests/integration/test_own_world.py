"""A package beside Mend adds a world of robots that drive: runs go on there as anywhere."""

import asyncio
import json
import random
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager
from itertools import combinations
from pathlib import Path
from typing import Any

import courtyard.adapter
import numpy as np
import pytest
from broken_constraints import broken_constraints
from courtyard.cart import RADIUS_M
from courtyard.world import Courtyard
from installed_example import EXAMPLES, install
from random_task import random_nesting
from sampled import sample
from untruths import kinds_of

from mend.server.composition import Service, open_service
from mend.server.errors import ImpossibleError
from mend.server.journal import events as ev
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunStatus
from mend.server.settings import Settings
from mend.tasks.intervention import Act, Intervention
from mend.tasks.plugins import load_plugins

COURTYARD = EXAMPLES / "courtyard"
PATIENCE_S = 60.0


@pytest.fixture(autouse=True)
def _installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    packages = tmp_path / "packages"
    packages.mkdir()
    install("courtyard", packages)
    monkeypatch.syspath_prepend(str(packages))
    load_plugins.cache_clear()
    yield
    load_plugins.cache_clear()


@asynccontextmanager
async def service(folder: Path) -> AsyncIterator[Service]:
    settings = Settings(
        port=0, journal=folder / "journal.db", log_level="error", speech_voice="none"
    )
    async with open_service(settings) as found:
        if "courtyard" not in await found.journal.documents("scene"):
            scene = (COURTYARD / "scenes" / "courtyard.yaml").read_text()
            await found.library.scenes.save("courtyard", scene)
            await found.library.trees.save("rounds", (COURTYARD / "rounds.yaml").read_text())
        yield found


async def step_started(found: Service) -> None:
    """Wait until a robot drives."""
    with found.journal.subscribe(0) as records:
        async for record in records:
            if isinstance(ev.any_event.validate_json(record.text), ev.StepStarted):
                return


async def ended(found: Service, request: RunRequest) -> list[ev.Event]:
    run = await found.runtime.start_run(request)
    async with asyncio.timeout(PATIENCE_S):
        view = await found.runtime.wait_for_end(run.id)
    events = list(await found.journal.read(0, 100_000, run.id))
    assert view.status is RunStatus.FINISHED, view.result
    started = events[0]
    assert isinstance(started, ev.RunStarted)
    assert broken_constraints(events, kinds_of(started)) == []
    return events


async def test_three_carts_drive_at_once_and_the_order_holds(tmp_path: Path) -> None:
    async with service(tmp_path) as found:
        request = RunRequest(tree="rounds", world="courtyard", speed="max", answers="none")
        events = await ended(found, request)
    begun = [each for each in events if isinstance(each, ev.NodeStarted)]
    done = [each for each in events if isinstance(each, ev.NodeDone)]
    together = begun[:3]
    assert {each.node for each in together} == {"/0/0", "/0/1", "/0/2"}
    assert len({each.robot for each in together}) == 3
    assert events.index(together[-1]) < events.index(done[0])
    assert [each.node for each in done][-1] == "/1"
    assert not [each for each in events if isinstance(each, ev.IssueRaised)]


async def test_who_stands_in_the_way_is_asked_to_step_aside(tmp_path: Path) -> None:
    async with service(tmp_path) as found:
        request = RunRequest(
            tree="rounds", world="courtyard", speed=4.0, answers=["yes", "yes", "yes"]
        )
        run = await found.runtime.start_run(request)
        block = Intervention(act=Act.BLOCK)
        async with asyncio.timeout(PATIENCE_S):
            await step_started(found)
            await found.runtime.intervene(run.id, block)
            view = await found.runtime.wait_for_end(run.id)
        events = await found.journal.read(0, 100_000, run.id)
    assert view.status is RunStatus.FINISHED, view.result
    raised = [each for each in events if isinstance(each, ev.IssueRaised)]
    (blocked,) = [each for each in raised if each.issue == "blocked"]
    assert blocked.object is None
    prompts = [each for each in events if isinstance(each, ev.Prompt)]
    texts = [each.text for each in prompts if each.issue == "blocked"]
    assert texts[0].startswith("I cannot go on. Something has stood ")
    assert texts[-1].startswith("Thank you. I see my way free.")
    assert [each for each in events if isinstance(each, ev.HelpVerified)]


async def test_what_a_world_of_arms_cannot_do_is_told_before_a_run(tmp_path: Path) -> None:
    async with service(tmp_path) as found:
        with pytest.raises(ImpossibleError, match="cannot do the tree 'rounds'"):
            await found.runtime.start_run(RunRequest(tree="rounds", world="tabletop"))


def drawn(seed: int) -> tuple[str, str]:
    """A scene with one to three carts, and a tree of errands in it."""
    rng = random.Random(seed)
    spots = rng.sample([(x, y) for x in (-4.0, -1.5, 1.5, 4.0) for y in (-4.0, -1.5, 1.5, 4.0)], 10)
    carts = spots[: rng.randint(1, 3)]
    scene = {
        "name": "drawn",
        "objects": {},
        "robots": {
            f"cart_{n}": {"x": x, "y": y, "yaw": rng.randrange(4) * 1.570796}
            for n, (x, y) in enumerate(carts)
        },
        "places": {
            f"spot_{n}": {"pose": {"x": x, "y": y, "z": 0.0, "yaw": rng.uniform(-3.0, 3.0)}}
            for n, (x, y) in enumerate(spots[3:])
        },
    }
    leaves: list[Any] = [{"behavior": "go_to", "place": name} for name in scene["places"]]
    tree = {
        "name": "drawn",
        "scene": "drawn",
        "tree": random_nesting(np.random.default_rng(seed), leaves),
    }
    return json.dumps(scene), json.dumps(tree)


@pytest.mark.slow
# One that somebody helps, and one that nobody does.
@pytest.mark.parametrize("seed", range(sample(2, 6)))
async def test_drawn_errands_all_end_and_no_two_carts_ever_touch(
    tmp_path: Path, seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    gaps_m: list[float] = []

    class Watched(Courtyard):
        def advance_cycle(self) -> None:
            super().advance_cycle()
            gaps_m.extend(a.place.distance_m(b.place) for a, b in combinations(self.carts, 2))

    monkeypatch.setattr(courtyard.adapter, "Courtyard", Watched)
    scene, tree = drawn(seed)
    async with service(tmp_path) as found:
        await found.library.scenes.save("drawn", scene)
        await found.library.trees.save("drawn", tree)
        answers = "none" if seed % 2 else ["yes"] * 200
        request = RunRequest(tree="drawn", world="courtyard", speed="max", answers=answers)
        run = await found.runtime.start_run(request)
        async with asyncio.timeout(PATIENCE_S):
            view = await found.runtime.wait_for_end(run.id)
        events = await found.journal.read(0, 100_000, run.id)
    started = events[0]
    assert isinstance(started, ev.RunStarted)
    assert view.status in (RunStatus.FINISHED, RunStatus.FAILED)
    assert broken_constraints(events, kinds_of(started)) == []
    assert min(gaps_m, default=1.0) > 2 * RADIUS_M
