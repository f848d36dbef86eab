"""Sites: simulated worlds that stay, and whose robots runs borrow and give back."""

import asyncio
import os
import random
import signal
from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager, suppress
from pathlib import Path
from uuid import UUID

import pytest
from broken_constraints import broken_constraints
from given_documents import given_documents
from sampled import sample
from touching_robots import touching_robots
from untruths import kinds_of

from mend.errors import ConflictError, NotFoundError, WrongInputError
from mend.robots.link.messages import Hello, Holding, Intervened, Report
from mend.server.client import MendClient
from mend.server.client_errors import RefusedError
from mend.server.composition import Service, open_service
from mend.server.errors import ImpossibleError
from mend.server.journal import events as ev
from mend.server.journal.journal import Document, Entry, Receipt
from mend.server.journal.run_index import RunPage
from mend.server.robots.process import WorldProcess
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.run import Run
from mend.server.runtime.views import RunStatus
from mend.server.settings import Settings
from mend.server.sites.requests import SiteRequest
from mend.server.sites.views import SiteView
from mend.tasks.intervention import Act, Intervention

EXAMPLES = Path(__file__).parents[2] / "examples" / "two_arms"

THERE_AND_BACK = """
name: {name}
scene: bench_for_two
tree:
  then:
    - {{behavior: pick_and_place, object: {part}, place: {place}}}
"""

BASE = """
name: base
scene: tower
tree:
  then:
    - {behavior: pick_and_place, object: base, place: base}
"""

BENCH_FOR_TWO = """
name: bench_for_two
table: {height: 0.70, center: [0.62, 0.0], size: [0.66, 1.30]}
robots:
  left: {x: 0.0, y: 0.0}
  right: {x: 1.24, y: 0.0, yaw: 3.1416}
objects:
  red_box: {color: [0.9, 0.1, 0.1], size: [0.04, 0.05, 0.05], pose: {x: 0.45, y: -0.40}}
  blue_box: {color: [0.1, 0.2, 0.9], size: [0.04, 0.05, 0.05], pose: {x: 0.79, y: 0.40}}
  green_box: {color: [0.1, 0.8, 0.1], size: [0.04, 0.05, 0.05], pose: {x: 0.62, y: 0.0}}
places:
  middle_near: {pose: {x: 0.55, y: 0.10}}
  middle_far: {pose: {x: 0.69, y: -0.10}}
  near_left: {pose: {x: 0.45, y: -0.25}}
  far_left: {pose: {x: 0.45, y: -0.40}}
  near_right: {pose: {x: 0.79, y: 0.25}}
"""


@asynccontextmanager
async def service(folder: Path) -> AsyncIterator[Service]:
    """A service whose journal is kept, with the bench and its trees."""
    settings = Settings(
        port=0, journal=folder / "journal.db", log_level="error", speech_voice="none"
    )
    trees = {
        name: THERE_AND_BACK.format(name=name, part=part, place=place)
        for name, part, place in (
            ("red_near", "red_box", "near_left"),
            ("red_back", "red_box", "far_left"),
            ("blue_near", "blue_box", "near_right"),
            ("green_near", "green_box", "middle_near"),
            ("green_far", "green_box", "middle_far"),
        )
    }
    given = given_documents({**trees, "base": BASE}, {"bench_for_two": BENCH_FOR_TWO})
    async with open_service(settings, given=given) as found:
        yield found


async def open_bench(found: Service) -> SiteView:
    request = SiteRequest(scene="bench_for_two", world="tabletop", speed="max", seed=5)
    return await found.sites.open_site(request)


async def begin(found: Service, tree: str, site: UUID, *robots: str) -> UUID:
    request = RunRequest(tree=tree, site=site, robots=list(robots), answers="none")
    return (await found.runtime.start_run(request)).id


async def done(found: Service, run: UUID) -> Sequence[ev.Event]:
    view = await found.runtime.wait_for_end(run)
    events = await found.journal.read(0, 100_000, run)
    assert view.status is RunStatus.FINISHED, view.result
    started = events[0]
    assert isinstance(started, ev.RunStarted)
    assert broken_constraints(events, kinds_of(started)) == []
    assert not [each for each in events if isinstance(each, ev.IssueRaised)]
    return events


def robot(site: SiteView, stands: str) -> str:
    return next(each.robot for each in site.robots if each.stands == stands)


async def test_a_run_finds_the_world_as_the_one_before_has_left_it(tmp_path: Path) -> None:
    async with service(tmp_path) as found:
        site = await open_bench(found)
        first = await done(found, await begin(found, "red_near", site.id))
        assert found.sites.view(site.id).moved == {"red_box": "near_left"}
        second = await done(found, await begin(found, "red_near", site.id))
        back = await done(found, await begin(found, "red_back", site.id))
        assert [each.run for each in found.sites.view(site.id).robots] == [None, None]
    steps = [[e for e in each if isinstance(e, ev.StepStarted)] for each in (first, second, back)]
    assert steps[0]
    assert not steps[1]
    assert steps[2]
    # Each run has a clock of its own, from 0.
    assert back[1].time < 5.0


async def test_what_a_robot_still_says_to_the_site_is_no_report_to_the_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    connected, said = Run.robot_connected, list[asyncio.Task[None]]()

    async def says_something_first(run: Run, robot: str, hello: Hello) -> None:
        rests = Report(seq=1, time=4001.0, body=Holding(execution=None, at="neutral"))
        receipt = Receipt(robot, "of the site", len(said) + 1)
        said.append(asyncio.create_task(run.robot_reported(robot, rests, receipt)))
        await asyncio.sleep(0)
        await connected(run, robot, hello)

    monkeypatch.setattr(Run, "robot_connected", says_something_first)
    async with service(tmp_path) as found, asyncio.timeout(120.0):
        site = await open_bench(found)
        run = await begin(found, "red_near", site.id, robot(site, "left"))
        events = await done(found, run)
    assert said
    assert events[1].time < 5.0
    assert events[-1].time < 1000.0


async def test_two_runs_share_a_site_and_never_touch(tmp_path: Path) -> None:
    async with service(tmp_path) as found:
        site = await open_bench(found)
        with touching_robots() as touched:
            runs = [
                await begin(found, "red_near", site.id, robot(site, "left")),
                await begin(found, "blue_near", site.id, robot(site, "right")),
            ]
            both = [await done(found, run) for run in runs]
        assert touched == []
        moved = found.sites.view(site.id).moved
    assert moved == {"red_box": "near_left", "blue_box": "near_right"}
    owners = [{each.robot for each in of if isinstance(each, ev.NodeStarted)} for of in both]
    assert owners == [{robot(site, "left")}, {robot(site, "right")}]


async def test_a_robot_is_one_runs_at_a_time_and_a_used_site_stays_open(tmp_path: Path) -> None:
    async with service(tmp_path) as found:
        site = await open_bench(found)
        run = await begin(found, "red_near", site.id, robot(site, "left"))
        with pytest.raises(ConflictError, match=f"busy with run {run}"):
            await begin(found, "red_back", site.id)
        with pytest.raises(ConflictError, match="is used by a run"):
            await found.sites.close_site(site.id)
        await done(found, run)
        await found.sites.close_site(site.id)
        with pytest.raises(NotFoundError, match="there is no site"):
            await begin(found, "red_back", site.id)
        told = [vars(each)["type"] for each in await found.sites.events(site.id, 0, 100)]
        assert await found.journal.world(site.id) is None
    assert told == ["site_opened", "site_given_back", "site_closed"]


async def test_a_site_and_what_lies_there_are_there_again_after_a_restart(tmp_path: Path) -> None:
    async with service(tmp_path) as found:
        site = await open_bench(found)
        await done(found, await begin(found, "red_near", site.id))
    async with service(tmp_path) as found:
        again = found.sites.view(site.id)
        assert [each.robot for each in again.robots] == [each.robot for each in site.robots]
        assert again.moved == {"red_box": "near_left"}
        events = await done(found, await begin(found, "red_near", site.id))
    assert not [each for each in events if isinstance(each, ev.StepStarted)]


async def test_a_run_at_a_site_goes_on_after_a_restart(tmp_path: Path) -> None:
    async with service(tmp_path) as found:
        site = await open_bench(found)
        run = await begin(found, "red_near", site.id)
        with found.journal.subscribe(0) as events:
            async for record in events:
                if '"step_started"' in record.text:
                    break
    async with service(tmp_path) as found:
        await done(found, run)
        assert found.sites.view(site.id).moved == {"red_box": "near_left"}


@pytest.mark.parametrize(
    ("asked", "sentence"),
    [
        ({"speed": 2.0}, "'speed' is 2.0, but that of site .* is max: leave it out"),
        ({"world": "live"}, "'world' is live, but that of site .* is tabletop"),
        ({"scenario": "eket_paper"}, "'scenario' is for a run with a world of its own"),
        ({"robots": ["nobody"]}, "has no robot 'nobody'; it has left-.*, right-"),
    ],
)
async def test_what_a_site_says_a_run_does_not(
    tmp_path: Path, asked: dict[str, object], sentence: str
) -> None:
    async with service(tmp_path) as found:
        site = await open_bench(found)
        request = RunRequest.model_validate({"tree": "red_near", "site": site.id, **asked})
        with pytest.raises(WrongInputError, match=sentence):
            await found.runtime.start_run(request)


async def test_a_world_that_ends_while_nobody_uses_it_is_started_again(tmp_path: Path) -> None:
    async with service(tmp_path) as found:
        site = await open_bench(found)
        await done(found, await begin(found, "red_near", site.id))
        world = found.sites._sites[site.id].world
        world._ended(world._life, "its process was killed")
        await until_told(found, site.id, "site_restarted")
        events = await done(found, await begin(found, "red_near", site.id))
    assert not [each for each in events if isinstance(each, ev.StepStarted)]


async def test_what_people_do_while_no_run_has_a_robot_is_told_of_the_site(
    tmp_path: Path,
) -> None:
    async with service(tmp_path) as found:
        view = await open_bench(found)
        stolen = Intervention(act=Act.STEAL, object="red_box")
        body = Intervened(intervention=stolen, by="scenario", ok=False, detail="it is not there")
        receipt = Receipt(robot(view, "left"), "of the site", 1)
        site = found.sites._sites[view.id]
        await site.robot_reported(receipt.robot, Report(seq=1, time=7.0, body=body), receipt)
        told = (await found.sites.events(view.id, 0, 100))[-1]
    assert isinstance(told, ev.SiteIntervention)
    assert (told.at_s, told.intervention, told.by) == (7.0, stolen, "scenario")
    assert (told.ok, told.detail) == (False, "it is not there")


async def test_a_world_that_ends_just_before_a_run_borrows_its_robots_is_started_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with service(tmp_path) as found:
        view = await open_bench(found)
        site = found.sites._sites[view.id]
        lend = site.lend

        def lend_what_has_just_ended(run: Run) -> None:
            site.world._ended(site.world._life, "its process was killed")
            lend(run)

        monkeypatch.setattr(site, "lend", lend_what_has_just_ended)
        assert site.world._handle is not None
        await site.world._handle.stop()
        async with asyncio.timeout(30.0):
            await done(found, await begin(found, "red_near", view.id))


@pytest.mark.slow(6)
@pytest.mark.parametrize("seed", range(sample(1, 3)))
async def test_runs_that_come_and_go_never_touch_and_all_end(tmp_path: Path, seed: int) -> None:
    """Random runs on whichever robots are free; some are aborted, and the world dies now and then.

    A run may fail, as the part may be where its robot does not reach: but it ends, and says so.
    """
    rng = random.Random(seed)
    trees = ("red_near", "red_back", "blue_near", "green_near", "green_far")
    async with service(tmp_path) as found:
        site = await open_bench(found)
        going: set[UUID] = set()
        began = 0
        with touching_robots() as touched:
            while began < 12 or going:
                free = [each.robot for each in found.sites.view(site.id).robots if not each.run]
                if free and began < 12:
                    some = rng.sample(free, rng.randint(1, len(free)))
                    with suppress(ImpossibleError):
                        going.add(await begin(found, rng.choice(trees), site.id, *some))
                        began += 1
                    await asyncio.sleep(rng.random() * 0.5)
                elif going:
                    ended = await asyncio.wait_for(a_run_has_ended(found, going), 60.0)
                    going -= ended
                if going and rng.random() < 0.15:
                    with suppress(ConflictError):
                        await found.runtime.abort(rng.choice(sorted(going)))
                if rng.random() < 0.15:
                    world = found.sites._sites[site.id].world
                    assert world._handle is not None
                    await world._handle.stop()
                    world._ended(world._life, "its process was killed")
        assert touched == []
        for run in await found.runtime.runs(RunPage()):
            events = await found.journal.read(0, 100_000, run.id)
            started = events[0]
            assert isinstance(started, ev.RunStarted)
            assert broken_constraints(events, kinds_of(started)) == []
            if run.status is RunStatus.FAILED:
                assert run.result is not None
                assert "could not be done" in run.result.reason
        await found.sites.close_site(site.id)


async def a_run_has_ended(found: Service, going: set[UUID]) -> set[UUID]:
    waits = {asyncio.create_task(found.runtime.wait_for_end(run)): run for run in going}
    done, left = await asyncio.wait(waits, return_when=asyncio.FIRST_COMPLETED)
    for each in left:
        each.cancel()
    return {waits[each] for each in done}


async def test_a_site_is_opened_used_and_closed_over_rest(tmp_path: Path) -> None:
    async with service(tmp_path) as found, MendClient(found.url) as client:
        request = SiteRequest(scene="bench_for_two", world="tabletop", speed="max")
        site = await client.open_site(request)
        assert [each.stands for each in site.robots] == ["left", "right"]
        run = await client.start_run(RunRequest(tree="red_near", site=site.id, answers="none"))
        assert (await client.wait_for_end(run.id)).status is RunStatus.FINISHED
        assert await client.sites() == [await client.site(site.id)]
        with pytest.raises(RefusedError, match="there is no scene 'nowhere'"):
            await client.open_site(SiteRequest(scene="nowhere", world="tabletop"))
        await client.close_site(site.id)
        with pytest.raises(RefusedError, match="it may have been closed"):
            await client.site(site.id)
        assert await client.sites() == []


@pytest.mark.slow(7)
async def test_a_site_outlives_its_killed_process(tmp_path: Path) -> None:
    pytest.importorskip("pybullet")
    async with service(tmp_path) as found:
        request = SiteRequest(scene="tower", world="workcell", speed="max")
        site = await found.sites.open_site(request)
        world = found.sites._sites[site.id].world
        assert isinstance(world._handle, WorldProcess)
        first = world._handle.pid
        assert first is not None
        os.kill(first, signal.SIGKILL)
        await until_told(found, site.id, "site_restarted")
        await done(found, await begin(found, "base", site.id))
        assert world._handle.pid != first


async def until_told(found: Service, site: UUID, kind: str) -> None:
    """Wait until a site has an event of this type."""
    with found.journal.subscribe(0) as events:
        async with asyncio.timeout(60.0):
            async for record in events:
                if f'"{kind}"' in record.text and str(site) in record.text:
                    return


async def test_a_site_that_cannot_be_read_does_not_keep_the_service_from_starting(
    tmp_path: Path,
) -> None:
    async with service(tmp_path) as found:
        site = await open_bench(found)
        spoilt = Document("site", "spoilt", '{"site": "?"}')
        await found.journal.append(Entry(document=spoilt))
    async with service(tmp_path) as found:
        assert [each.id for each in found.sites.sites()] == [site.id]
