"""People of a building ask for things, and robots of a site do them, leg by leg."""

import asyncio
import math
from pathlib import Path

import pytest
from awaited_events import events_until
from office_with_fleet import open_office_with_fleet

from mend.errors import NotFoundError, WrongInputError
from mend.fleet.requests import (
    DeliverMessage,
    GoToRoom,
    RequestStatus,
    Transport,
    request_of,
)
from mend.server.client import MendClient
from mend.server.client_errors import RefusedError
from mend.server.composition import Service, open_service
from mend.server.fleets.asking import WordsAsked
from mend.server.journal import events as ev
from mend.server.journal.stored_event import read_event
from mend.server.journal.subscriptions import Record
from mend.server.report.fleet_history import FleetHistory
from mend.server.report.leg_times import TimeUse, time_split
from mend.server.report.span import Span
from mend.server.settings import Settings
from mend.server.sites.requests import FleetOptions, SiteRequest

PATIENCE_S = 500.0
OVER = {"done", "failed", "cancelled", "refused"}


def settings(folder: Path) -> Settings:
    return Settings(port=0, data_dir=folder, log_level="error", speech_voice="none")


async def records_of(service: Service) -> list[Record]:
    return await service.journal.read_records(0, 100_000)


def went(events: list[ev.Event]) -> dict[str, list[str]]:
    """The statuses that each request went through."""
    found: dict[str, list[str]] = {}
    for each in events:
        if isinstance(each, ev.RequestChanged):
            found.setdefault(each.request, []).append(each.status)
    return found


async def until_over(service: Service, names: set[str]) -> dict[str, list[str]]:
    """The statuses that requests went through, until all of them are over."""

    def over(events: list[ev.Event]) -> bool:
        now = went(events)
        return all(now.get(name, [""])[-1] in OVER for name in names)

    return went(await events_until(service, over))


@pytest.mark.slow(2)
async def test_rooms_that_are_asked_for_are_visited_by_all_robots(tmp_path: Path) -> None:
    async with open_service(settings(tmp_path)) as service, asyncio.timeout(PATIENCE_S):
        site = await open_office_with_fleet(service, "max", robots=2)
        for number in (1, 3, 5, 6):
            request = GoToRoom(name=f"room{number}", place=f"10{number}")
            _, booked = await service.fleets.submit(site, request, None)
            assert booked.status is RequestStatus.BOOKED
            assert booked.expected is not None
        done = await until_over(service, {"room1", "room3", "room5", "room6"})
        runs = await service.journal.index.counts()
    assert done == {name: ["booked", "under_way", "done"] for name in done}
    assert runs == {"finished": 4}


async def test_who_waits_for_a_moment_is_woken_at_it_though_the_only_robot_drives(
    tmp_path: Path,
) -> None:
    async with open_service(settings(tmp_path)) as service, asyncio.timeout(PATIENCE_S):
        site = await open_office_with_fleet(service, "max")
        fleet = await service.fleets.fleet(site)
        await service.fleets.submit(site, GoToRoom(name="room6", place="106"), None)

        def drives(events: list[ev.Event]) -> bool:
            return any(isinstance(each, ev.StepStarted) for each in events)

        events = await events_until(service, drives)
        begun_s = next(e.at_s for e in events if isinstance(e, ev.RunStarted))
        assert begun_s is not None
        moment_s = max(begun_s, fleet.now_s) + 2.0
        await fleet.wait_until(moment_s)
        assert moment_s <= fleet.now_s < moment_s + 1.0
        await until_over(service, {"room6"})


async def test_a_run_that_begins_after_a_long_rest_is_dated_by_then(tmp_path: Path) -> None:
    async with open_service(settings(tmp_path)) as service, asyncio.timeout(PATIENCE_S):
        site = await open_office_with_fleet(service, "max", robots=2)
        fleet = await service.fleets.fleet(site)
        later = GoToRoom(name="room6", place="106", earliest_s=2000.0)
        await service.fleets.submit(site, later, None)
        while fleet.shown_s < 300.0:  # noqa: ASYNC110 - only poses tell how late it is
            await asyncio.sleep(0.001)
        since_s = fleet.shown_s
        robot = next(each for each in fleet.dispatcher.fleet.robots if fleet.run_of(each) is None)
        await fleet.operators.send(robot, "104", None)

        def drives(events: list[ev.Event]) -> bool:
            return any(isinstance(each, ev.StepStarted) for each in events)

        events = await events_until(service, drives)
    begun = next(each for each in events if isinstance(each, ev.RunStarted))
    assert begun.at_s is not None
    assert begun.at_s >= since_s
    assert next(each for each in events if isinstance(each, ev.StepStarted)).time < 100.0


@pytest.mark.slow(2)
async def test_a_service_that_stopped_goes_on_with_what_its_robots_were_doing(
    tmp_path: Path,
) -> None:
    async with open_service(settings(tmp_path)) as service, asyncio.timeout(PATIENCE_S):
        site = await open_office_with_fleet(service, "max", robots=2)
        for number in (4, 6):
            request = GoToRoom(name=f"room{number}", place=f"10{number}")
            await service.fleets.submit(site, request, None)

        def drives(events: list[ev.Event]) -> bool:
            return sum(isinstance(each, ev.StepStarted) for each in events) > 0

        before = await events_until(service, drives)
    async with open_service(settings(tmp_path)) as service, asyncio.timeout(PATIENCE_S):
        done = await until_over(service, {"room4", "room6"})
        runs = await service.journal.index.counts()
        events = [read_event(each.seq, each.text) for each in await records_of(service)]
    begun = {(each.robot, each.number) for each in before if isinstance(each, ev.LegBegun)}
    ended = [each for each in events if isinstance(each, ev.LegEnded)]
    # What was driven before the world began anew is known by nobody.
    known = {(each.robot, each.number): each.driven_m for each in ended}
    assert {known[leg] for leg in begun} == {None}
    assert done == {name: ["booked", "under_way", "done"] for name in done}
    assert runs == {"finished": 2}


@pytest.mark.slow(3)
async def test_things_are_brought_and_messages_told_over_two_floors(tmp_path: Path) -> None:
    async with open_service(settings(tmp_path)) as service, asyncio.timeout(PATIENCE_S):
        site = await open_office_with_fleet(service, "max", robots=2, floors=2)
        parcel = Transport(name="p", what="the parcel", origin="101", destination="203")
        lunch = DeliverMessage(name="lunch", place="102", message="Lunch is ready.")
        for request in (parcel, lunch):
            await service.fleets.submit(site, request, None)
        done = await until_over(service, {"p", "lunch"})
        events = [read_event(each.seq, each.text) for each in await records_of(service)]
    assert done["p"][-1] == done["lunch"][-1] == "done"
    said = [each.text for each in events if isinstance(each, ev.Prompt)]
    assert any("Please put the parcel p into my basket" in each for each in said)
    assert any("Please take the parcel p out of my basket" in each for each in said)
    assert any('"Lunch is ready."' in each for each in said)
    deeds = [each.act for each in events if isinstance(each, ev.InterventionDone)]
    assert deeds.count("put_in") == deeds.count("take_out") == 1
    history = FleetHistory.of(site, events, Span())
    assert all((ended.driven_m or 0.0) > 1.0 for _, ended in history.ended)
    by_leg = {leg.begun.action: time_split(leg) for leg, _ in history.ended}
    assert by_leg.keys() == {"collect", "hand_over", "deliver_message"}
    assert all(split[TimeUse.NAVIGATION] > 0.0 for split in by_leg.values())
    assert by_leg["collect"][TimeUse.START] > 0.0
    assert by_leg["hand_over"][TimeUse.END] > 0.0
    assert by_leg["deliver_message"][TimeUse.END] > 0.0
    assert sum(split[TimeUse.ELEVATOR] for split in by_leg.values()) > 0.0
    assert all(split[TimeUse.UNKNOWN] == 0.0 for split in by_leg.values())


@pytest.mark.slow
async def test_what_is_cancelled_while_a_robot_is_on_its_way_is_broken_off(tmp_path: Path) -> None:
    async with open_service(settings(tmp_path)) as service, asyncio.timeout(PATIENCE_S):
        # Slow enough that it is on its way for long.
        site = await open_office_with_fleet(service, 2.0)
        await service.fleets.submit(site, GoToRoom(name="far", place="106"), None)

        def drives(events: list[ev.Event]) -> bool:
            return any(isinstance(each, ev.StepStarted) for each in events)

        await events_until(service, drives)
        await service.fleets.cancel(site, "far", None)
        await service.fleets.submit(site, GoToRoom(name="near", place="101"), None)
        done = await until_over(service, {"far", "near"})
        runs = await service.journal.index.counts()
    assert done["far"][-1] == "cancelled"
    assert done["near"] == ["booked", "under_way", "done"]
    assert runs == {"aborted": 1, "finished": 1}


@pytest.mark.slow
async def test_a_leg_that_is_broken_off_tells_what_its_robot_drove_until_then(
    tmp_path: Path,
) -> None:
    async with open_service(settings(tmp_path)) as service, asyncio.timeout(PATIENCE_S):
        site = await open_office_with_fleet(service, 4.0, robots=2)
        fleet = await service.fleets.fleet(site)
        await service.fleets.submit(site, GoToRoom(name="far", place="106"), None)
        while fleet.shown_s < 6.0:  # noqa: ASYNC110 - nobody tells of it
            await asyncio.sleep(0)
        (leg,) = fleet.dispatcher.legs_under_way()
        await fleet.operators.take_out(leg.robot, "it is stuck", None)
        await until_over(service, {"far"})
        events = [read_event(each.seq, each.text) for each in await records_of(service)]
    (told,) = [each for each in events if isinstance(each, ev.FleetTold)]
    assert told.at_s >= 6.0
    history = FleetHistory.of(site, events, Span())
    of_leg, ended = next(each for each in history.ended if each[1].robot == leg.robot)
    took_s = ended.at_s - of_leg.begun.at_s
    assert ended.outcome == "withdrawn"
    assert took_s >= 6.0
    assert ended.driven_m is not None
    assert 1.0 < ended.driven_m < 2.0 * took_s
    split = time_split(of_leg)
    assert split[TimeUse.NAVIGATION] + split[TimeUse.BLOCKED] > 0.8 * took_s


@pytest.mark.slow
async def test_requests_are_made_followed_changed_and_cancelled_over_rest(tmp_path: Path) -> None:
    async with (
        open_service(settings(tmp_path)) as service,
        MendClient(service.url) as client,
        asyncio.timeout(PATIENCE_S),
    ):
        site = await open_office_with_fleet(service, "max")
        later = GoToRoom(name="later", place="101", earliest_s=3000.0)
        booked = await client.make_request(later)
        assert (booked.site, booked.status) == (site, "booked")
        assert booked.expected is not None
        assert booked.expected.begins_s >= 3000.0
        too_soon = GoToRoom(name="soon", place="106", latest_s=1.0)
        with pytest.raises(RefusedError, match="'soon' cannot be met") as refused:
            await client.make_request(too_soon)
        problem = refused.value.problem
        assert problem.status == 409
        assert problem.next_possible_s is not None
        assert problem.next_possible_s[1] > 1.0
        with pytest.raises(RefusedError, match="no place '999'"):
            await client.make_request(GoToRoom(name="nowhere", place="999"))
        with pytest.raises(RefusedError, match="there is a request 'later' already"):
            await client.make_request(later)
        known = {each.name: each.status for each in await client.requests()}
        assert known == {"later": "booked", "soon": "refused"}
        changed = await client.change_request("later", later.model_copy(update={"place": "103"}))
        assert changed.what["place"] == "103"
        assert [each.request for each in (await client.fleet(site)).robots[0].stops] == [
            "later"
        ] * 2
        with pytest.raises(RefusedError, match="has open requests, 'later' first"):
            await client.close_site(site)
        await client.cancel_request("later")
        assert (await client.request("later")).status == "cancelled"
        await client.close_site(site)
        deeds = [each.what for each in (await client.deeds()).deeds]
    assert "asked for 'later'" in deeds
    assert "no longer wanted 'later'" in deeds


@pytest.mark.slow
async def test_a_robot_is_sent_over_rest_and_is_where_it_was_sent(tmp_path: Path) -> None:
    async with (
        open_service(settings(tmp_path)) as service,
        MendClient(service.url) as client,
        asyncio.timeout(PATIENCE_S),
    ):
        site = await open_office_with_fleet(service, "max")
        (known,) = (await client.fleet(site)).robots
        with pytest.raises(RefusedError, match="no place 'F1/999'"):
            await client.send_robot(site, known.robot, "F1/999")
        while not (await client.fleet(site)).robots[0].connected:  # noqa: ASYNC110 - as it is
            await asyncio.sleep(0.05)
        await client.send_robot(site, known.robot, "F1/103")
        with pytest.raises(RefusedError, match="is on its way to F1/103: wait"):
            await client.close_site(site)

        def came(events: list[ev.Event]) -> bool:
            return any(isinstance(each, ev.ErrandEnded) for each in events)

        *_, ended = [e for e in await events_until(service, came) if isinstance(e, ev.ErrandEnded)]
        assert (ended.came, ended.at, ended.reason) == (True, "F1/103", None)
        (there,) = (await client.fleet(site)).robots
        assert there.at_work is None
        assert there.pose is not None
        place = (await service.fleets.fleet(site)).dispatcher.building.floors["F1"].places["103"]
        assert math.hypot(there.pose.x - place.x, there.pose.y - place.y) < 0.5
        await client.close_site(site)
        deeds = [each.what for each in (await client.deeds()).deeds]
    assert f"sent {known.robot} to F1/103" in deeds


async def test_a_site_without_a_fleet_takes_no_requests(tmp_path: Path) -> None:
    async with open_service(settings(tmp_path)) as service:
        with pytest.raises(NotFoundError, match="open a site with 'fleet'"):
            await service.fleets.submit(None, GoToRoom(name="there", place="101"), None)
        with pytest.raises(WrongInputError, match="'fleet' is for the robots of a building"):
            await service.sites.open_site(SiteRequest(scene="eket", fleet=FleetOptions()))


@pytest.mark.slow
async def test_words_are_understood_read_back_and_asked_for_over_rest(tmp_path: Path) -> None:
    async with (
        open_service(settings(tmp_path)) as service,
        MendClient(service.url) as client,
        asyncio.timeout(PATIENCE_S),
    ):
        site = await open_office_with_fleet(service, 2.0, floors=2)
        robot = (await client.fleet(site)).robots[0].robot
        there = await client.asked_robot(site, robot)
        assert there.here is not None
        assert there.connected
        assert {"transport", "deliver_message", "go_to_room"} <= set(there.kinds)

        words = "bring this to two oh three by three o'clock"
        asked = WordsAsked(words=words, robot=robot, clock="14:20")
        found = await client.understand_request(asked)
        said = there.here.replace("/", " ")
        assert (
            found.read_back == f"I am to bring this from {said} to F2 203 by 15:00. Is that right?"
        )
        assert found.request is not None
        # Its clock goes twice as fast as that of people.
        assert found.request["latest_s"] == pytest.approx(2 * 40 * 60.0, abs=5.0)
        booked = await client.make_request(request_of(found.request))
        assert (booked.status, booked.what["destination"]) == ("booked", "F2/203")

        unclear = await client.understand_request(WordsAsked(words="bring this to 203"))
        assert unclear.question == "From where? Name a room, as I do not know where you are."
        assert (unclear.request, unclear.read_back) == (None, None)
        timeless = await client.understand_request(WordsAsked(words="come to 203 by 15:30"))
        assert timeless.question is not None
        assert timeless.question.startswith("I do not know how late it is")
        with pytest.raises(RefusedError, match="nobody"):
            await client.understand_request(WordsAsked(words="come here", robot="nobody"))


@pytest.mark.slow
async def test_a_refusal_says_why_without_the_name(tmp_path: Path) -> None:
    async with (
        open_service(settings(tmp_path)) as service,
        MendClient(service.url) as client,
        asyncio.timeout(PATIENCE_S),
    ):
        await open_office_with_fleet(service, "max")
        with pytest.raises(RefusedError) as refused:
            await client.make_request(GoToRoom(name="soon", place="106", latest_s=1.0))
        problem = refused.value.problem
        assert problem.why is not None
        assert problem.detail.startswith(f"'soon' cannot be met: {problem.why}")
