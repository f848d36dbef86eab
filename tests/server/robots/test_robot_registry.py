"""The service's end of the link, talking to robots that the test plays."""

import asyncio
import base64
import math
from collections.abc import AsyncIterator
from dataclasses import replace

import pytest
from dropping_channel import DroppingChannel
from full_disk import FailingConnection
from recording_sink import RecordingSink
from service_under_test import until
from ticking_clock import TickingClock

from mend.errors import ConflictError, NotFoundError
from mend.robots.link.channel import Channel, ChannelClosedError, memory_channel
from mend.robots.link.messages import (
    Ack,
    AnyRobotMessage,
    AnyServiceMessage,
    Command,
    Heartbeat,
    Held,
    Hello,
    Interrupt,
    LinkError,
    Look,
    Picture,
    PoseLayout,
    Poses,
    ReachLimits,
    Rejected,
    Report,
    ShowPoses,
    Taken,
    Welcome,
    service_message,
)
from mend.server.camera_picture import CameraPicture
from mend.server.journal.journal import JournalReadError, Receipt
from mend.server.journal.sqlite import SqliteJournal
from mend.server.limits import Limits
from mend.server.refusals import Refusals
from mend.server.robots.passes import Anyone
from mend.server.robots.registry import RobotRegistry
from mend.server.robots.session import ACK_AT_LEAST_EVERY, WAITING_REPORTS
from mend.server.robots.times import LinkTimes

A_PICTURE = b"\xff\xd8\xff a picture \xff\xd9"
PICTURE_OF_NOTHING = '{"type": "picture", "command": "c", "camera": "head", "jpeg": "PGh0bWw+"}'
QUICK = LinkTimes(heartbeat_s=0.001, silence_s=10.0, absence_s=0.001)


def hello(robot: str = "arm", boot: str = "b1", simulated: bool = False) -> Hello:
    return Hello(
        protocol=1, robot=robot, boot=boot, behaviors=["pick_and_place"], cameras=["head"],
        reach=ReachLimits(x=0.0, y=0.0, min_m=0.2, max_m=0.8), time=0.0, simulated=simulated,
    )  # fmt: skip


def report(seq: int, boot: str | None = None) -> Report:
    return Report(boot=boot, seq=seq, time=float(seq), body=Held(command=f"c{seq}"))


class PlayedRobot:
    """One connection of a robot."""

    def __init__(self, registry: RobotRegistry) -> None:
        self.channel, service_end = memory_channel()
        self.serving = asyncio.create_task(registry.serve(service_end))

    async def say(self, message: AnyRobotMessage) -> None:
        await self.channel.send(message.model_dump_json(exclude_none=True))

    async def hear(self) -> AnyServiceMessage:
        async with asyncio.timeout(60):
            return service_message.validate_json(await self.channel.receive())

    async def greet(self, message: Hello) -> Welcome:
        await self.say(message)
        welcome = await self.hear()
        assert isinstance(welcome, Welcome)
        return welcome

    async def deliver(self, message: Report) -> Ack:
        await self.say(message)
        ack = await self.hear()
        assert isinstance(ack, Ack)
        return ack

    async def leave(self) -> None:
        await self.channel.close()
        await self.serving


@pytest.fixture
async def journal() -> AsyncIterator[SqliteJournal]:
    journal = SqliteJournal(":memory:")
    yield journal
    journal.close()


@pytest.fixture
def clock() -> TickingClock:
    return TickingClock()


@pytest.fixture
def refusals() -> Refusals:
    return Refusals()


@pytest.fixture
async def registry(
    journal: SqliteJournal, clock: TickingClock, refusals: Refusals
) -> AsyncIterator[RobotRegistry]:
    registry = RobotRegistry(journal, clock, QUICK, refusals=refusals)
    yield registry
    registry.close()


@pytest.fixture
async def sink(registry: RobotRegistry, journal: SqliteJournal) -> RecordingSink:
    sink = RecordingSink(journal)
    registry.assign("arm", sink)
    return sink


async def test_a_hello_is_welcomed_and_told_to_the_owner(
    registry: RobotRegistry, sink: RecordingSink
) -> None:
    robot = PlayedRobot(registry)
    welcome = await robot.greet(hello())
    assert (welcome.protocol, welcome.received, welcome.heartbeat_s) == (1, 0, 0.001)
    await sink.wait_until(lambda: sink.hellos == [hello()])
    assert registry.connected("arm")
    assert registry.hello("arm") == hello()
    assert registry.known() == ["arm"]


async def test_reports_are_committed_with_their_receipts_before_they_are_acknowledged(
    registry: RobotRegistry, sink: RecordingSink, journal: SqliteJournal
) -> None:
    robot = PlayedRobot(registry)
    await robot.greet(hello())
    for seq in (1, 2, 3):
        assert (await robot.deliver(report(seq))).seq == seq
        assert await journal.received("arm", "b1") == seq
    assert sink.receipts == [Receipt("arm", "b1", seq) for seq in (1, 2, 3)]


async def test_a_report_that_comes_again_is_acknowledged_and_not_handed_on(
    registry: RobotRegistry, sink: RecordingSink
) -> None:
    robot = PlayedRobot(registry)
    await robot.greet(hello())
    await robot.deliver(report(1))
    assert (await robot.deliver(report(1))).seq == 1
    assert len(sink.reports) == 1


async def test_a_welcome_says_what_was_received_before(
    registry: RobotRegistry, sink: RecordingSink
) -> None:
    first = PlayedRobot(registry)
    await first.greet(hello())
    await first.deliver(report(1))
    await first.leave()
    again = PlayedRobot(registry)
    assert (await again.greet(hello())).received == 1
    await again.leave()
    rebooted = PlayedRobot(registry)
    assert (await rebooted.greet(hello(boot="b2"))).received == 0
    await sink.wait_until(lambda: [each.boot for each in sink.hellos] == ["b1", "b1", "b2"])


async def test_reports_of_a_robot_that_no_run_owns_are_committed_all_the_same(
    registry: RobotRegistry, journal: SqliteJournal
) -> None:
    robot = PlayedRobot(registry)
    await robot.greet(hello())
    assert (await robot.deliver(report(1))).seq == 1
    assert await journal.received("arm", "b1") == 1


async def test_reports_of_an_earlier_boot_are_acknowledged_under_their_boot(
    registry: RobotRegistry, sink: RecordingSink
) -> None:
    robot = PlayedRobot(registry)
    await robot.greet(hello(boot="b2"))
    assert await robot.deliver(report(4, boot="b1")) == Ack(boot="b1", seq=4)
    assert await robot.deliver(report(1)) == Ack(seq=1)
    assert sink.receipts == [Receipt("arm", "b1", 4), Receipt("arm", "b2", 1)]


async def test_a_report_whose_predecessor_was_left_out_is_not_taken(
    registry: RobotRegistry, sink: RecordingSink
) -> None:
    robot = PlayedRobot(registry)
    await robot.greet(hello())
    await robot.deliver(report(1))
    await robot.say(report(3))
    assert await robot.hear() == LinkError(
        detail="report 3 came, but the last one was 1; send 2 first"
    )
    assert (await robot.deliver(report(2))).seq == 2
    assert [each.seq for each in sink.reports] == [1, 2]


async def test_a_command_is_sent_when_the_robot_connects_and_again_until_it_is_taken(
    registry: RobotRegistry, sink: RecordingSink
) -> None:
    registry.send("arm", "c1", Look())
    first = PlayedRobot(registry)
    await first.greet(hello())
    assert await first.hear() == Command(id="c1", body=Look())
    await first.leave()
    second = PlayedRobot(registry)
    await second.greet(hello())
    assert await second.hear() == Command(id="c1", body=Look())
    registry.send("arm", "c2", Look())
    assert await second.hear() == Command(id="c2", body=Look())
    await second.say(Taken(command="c1"))
    await second.deliver(report(1))
    await second.leave()
    third = PlayedRobot(registry)
    await third.greet(hello())
    assert await third.hear() == Command(id="c2", body=Look())
    assert len(sink.hellos) == 3


async def test_commands_for_an_earlier_boot_are_dropped(registry: RobotRegistry) -> None:
    first = PlayedRobot(registry)
    await first.greet(hello())
    registry.send("arm", "c1", Look())
    await first.leave()
    second = PlayedRobot(registry)
    await second.greet(hello(boot="b2"))
    registry.send("arm", "c2", Look())
    assert await second.hear() == Command(id="c2", body=Look())


async def test_a_robot_that_takes_no_commands_is_not_sent_more_and_more(
    registry: RobotRegistry, refusals: Refusals
) -> None:
    for n in range(1000):
        registry.send("arm", f"c{n}", Look())
    registry.send("arm", "c7", Look())
    with pytest.raises(ConflictError, match="has not taken its last 1000 commands"):
        registry.send("arm", "one more", Look())
    assert refusals.counts["untaken_commands"] == 1


async def test_a_robot_has_one_owner(
    registry: RobotRegistry, sink: RecordingSink, journal: SqliteJournal
) -> None:
    other = RecordingSink(journal)
    registry.assign("arm", sink)
    with pytest.raises(ConflictError, match="busy with another run"):
        registry.assign("arm", other)
    registry.unassign("arm")
    registry.assign("arm", other)


async def test_a_new_owner_of_a_connected_robot_is_told_at_once(
    registry: RobotRegistry, journal: SqliteJournal
) -> None:
    robot = PlayedRobot(registry)
    await robot.greet(hello())
    await robot.deliver(report(1))
    sink = RecordingSink(journal)
    registry.assign("arm", sink)
    await sink.wait_until(lambda: sink.hellos == [hello()])


async def test_a_newer_connection_replaces_the_older_one(
    registry: RobotRegistry, sink: RecordingSink
) -> None:
    older, newer = PlayedRobot(registry), PlayedRobot(registry)
    await older.greet(hello())
    await newer.greet(hello())
    error = await older.hear()
    assert isinstance(error, LinkError)
    assert "replaced" in error.detail
    with pytest.raises(ChannelClosedError):
        await older.hear()
    await newer.deliver(report(1))
    assert registry.connected("arm")
    assert sink.lost == []


async def test_a_second_program_with_a_robots_name_is_refused_while_the_first_is_there(
    registry: RobotRegistry, sink: RecordingSink, clock: TickingClock
) -> None:
    first, second = PlayedRobot(registry), PlayedRobot(registry)
    await first.greet(hello(boot="b1"))
    await second.say(hello(boot="b2"))
    refusal = await second.hear()
    assert isinstance(refusal, LinkError)
    assert "another program is connected as the robot 'arm'" in refusal.detail
    with pytest.raises(ChannelClosedError):
        await second.hear()
    assert (await first.deliver(report(1))).seq == 1
    # Nothing comes of the first one any more.
    clock.step_s = QUICK.heartbeat_s
    await clock.looked_at(5)
    await PlayedRobot(registry).greet(hello(boot="b2"))
    await sink.wait_until(lambda: len(sink.hellos) == 2)


async def test_a_service_that_stood_still_gives_a_robots_name_to_no_second_program(
    registry: RobotRegistry, clock: TickingClock
) -> None:
    first, second = PlayedRobot(registry), PlayedRobot(registry)
    await first.greet(hello(boot="b1"))
    clock.now_s += 60.0
    await second.say(hello(boot="b2"))
    refusal = await second.hear()
    assert isinstance(refusal, LinkError)
    assert "another program is connected as the robot 'arm'" in refusal.detail
    assert (await first.deliver(report(1))).seq == 1


async def report_that_waits(
    registry: RobotRegistry, journal: SqliteJournal
) -> tuple[FailingConnection, PlayedRobot]:
    """A robot whose report cannot be written, until the connection has no `error` any more."""
    connection = FailingConnection(journal._write_connection)
    journal._writer._connection = connection  # type: ignore[assignment]
    connection.error = "disk I/O error"
    robot = PlayedRobot(registry)
    await robot.greet(hello())
    await robot.say(report(1))
    await asyncio.wait_for(journal.trouble.begun(), timeout=60)
    return connection, robot


async def test_of_connections_that_wait_for_the_journal_the_newest_alone_goes_on_waiting(
    registry: RobotRegistry, journal: SqliteJournal
) -> None:
    connection, _ = await report_that_waits(registry, journal)
    waiting = [PlayedRobot(registry) for _ in range(3)]
    for each in waiting:
        await each.say(hello())
    for each in waiting[:-1]:
        # Without an error, after which it would not come again.
        with pytest.raises(ChannelClosedError):
            await each.hear()
        await each.serving
    connection.error = None
    welcome = await waiting[-1].hear()
    assert isinstance(welcome, Welcome)
    assert welcome.received == 1


async def test_a_connection_that_waits_too_long_for_the_journal_has_to_come_again(
    journal: SqliteJournal, clock: TickingClock
) -> None:
    refusals = Refusals()
    registry = RobotRegistry(journal, clock, QUICK, Limits(hello_s=0.05), refusals)
    sink = StuckSink(journal)
    registry.assign("arm", sink)
    robot, later = PlayedRobot(registry), PlayedRobot(registry)
    await robot.greet(hello())
    await robot.say(report(1))
    await sink.stuck.wait()
    await later.say(hello())
    with pytest.raises(ChannelClosedError):
        await later.hear()
    await later.serving
    assert refusals.counts["hello_s"] == 1
    sink.go_on.set()
    await robot.serving
    assert (await PlayedRobot(registry).greet(hello())).received == 1
    registry.close()


@pytest.mark.parametrize("text", ["no hello", '{"type": "hello", "protocol": 2}'])
async def test_who_has_gone_before_being_told_what_is_wrong_is_no_fault_of_ours(
    registry: RobotRegistry, text: str
) -> None:
    await PlayedRobot(registry).greet(hello())
    for said in (text, hello(boot="b2").model_dump_json()):
        ours, theirs = memory_channel()
        await ours.send(said)
        await registry.serve(DroppingChannel(theirs, sends=0, receives=2))


async def test_a_robot_is_not_lost_while_a_newer_connection_is_being_made(
    registry: RobotRegistry,
    sink: RecordingSink,
    journal: SqliteJournal,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    older, newer = PlayedRobot(registry), PlayedRobot(registry)
    await older.greet(hello())
    absence_over = asyncio.Event()
    received = journal.received

    async def received_late(robot: str, boot: str) -> int:
        # The loop keeps to the order of its timers: that of the absence has run out by then.
        asyncio.get_running_loop().call_later(2 * QUICK.absence_s, absence_over.set)
        await absence_over.wait()
        return await received(robot, boot)

    monkeypatch.setattr(journal, "received", received_late)
    await newer.greet(hello())
    await newer.deliver(report(1))
    assert absence_over.is_set()
    assert registry.connected("arm")
    assert sink.lost == []


async def test_a_robot_is_not_lost_where_it_is_the_service_that_ends(
    registry: RobotRegistry, sink: RecordingSink
) -> None:
    robot = PlayedRobot(registry)
    await robot.greet(hello())
    await robot.deliver(report(1))
    registry.close()
    await robot.serving
    absence_over = asyncio.Event()
    asyncio.get_running_loop().call_later(2 * QUICK.absence_s, absence_over.set)
    await absence_over.wait()
    assert sink.lost == []


async def test_a_robot_whose_connection_ended_is_lost_after_a_while_and_only_once(
    registry: RobotRegistry, sink: RecordingSink
) -> None:
    robot = PlayedRobot(registry)
    await robot.greet(hello())
    await robot.deliver(report(1))
    await robot.leave()
    assert not registry.connected("arm")
    await sink.wait_until(lambda: sink.lost == ["its connection was closed"])
    assert registry.known() == ["arm"]
    await registry.end_connection("arm", "its program ended")
    assert sink.lost == ["its connection was closed"]


async def test_a_silent_robot_is_cut_off_and_lost(
    journal: SqliteJournal, clock: TickingClock
) -> None:
    registry = RobotRegistry(journal, clock, replace(QUICK, silence_s=0.01))
    sink = RecordingSink(journal)
    registry.assign("arm", sink)
    robot = PlayedRobot(registry)
    await robot.greet(hello())
    assert registry.last_heard("arm") == 0.0
    # As much as passes from one look to the next.
    clock.step_s = QUICK.heartbeat_s
    await sink.wait_until(lambda: len(sink.lost) == 1)
    assert sink.lost[0].startswith("nothing was heard of it for 0.0")
    assert registry.last_heard("arm") is None
    registry.close()


async def test_a_service_that_stood_still_does_not_count_that_against_a_robot(
    registry: RobotRegistry, sink: RecordingSink, clock: TickingClock
) -> None:
    robot = PlayedRobot(registry)
    await robot.greet(hello())
    clock.now_s += 60.0
    await clock.looked_at(5)
    assert (await robot.deliver(report(1))).seq == 1
    assert sink.lost == []


async def test_a_robot_that_beats_is_not_cut_off(
    registry: RobotRegistry, sink: RecordingSink, clock: TickingClock
) -> None:
    robot = PlayedRobot(registry)
    await robot.greet(hello())
    for _ in range(3):
        clock.now_s += 9.0
        await robot.say(Heartbeat(time=0.0))
        await robot.deliver(report(len(sink.reports) + 1))
    assert sink.lost == []


@pytest.mark.parametrize(
    ("text", "detail"),
    [
        ("not json", "the message was not understood: is not JSON"),
        ("{}", "the message was not understood: lacks 'type'"),
        ('{"type": "dance"}', "has 'dance' as 'type', not one of 'hello', 'report'"),
        ('{"type": "heartbeat"}', "at heartbeat.time: is missing"),
        ('{"type": "heartbeat", "time": "1"}', "at heartbeat.time"),
        ('{"type": "report", "seq": 1, "time": 1, "body": {}}', "at report"),
        ('{"type": "picture", "command": "c", "camera": "head", "jpeg": "!"}', "is not base64"),
        ('{"type": "picture", "command": "c", "camera": "head", "jpeg": "é"}', "is not base64"),
        (PICTURE_OF_NOTHING, "is not a JPEG"),
        ("[" * 100_000, "the message was not understood"),
    ],
)
async def test_a_malformed_message_is_answered_and_the_connection_stays(
    registry: RobotRegistry, text: str, detail: str
) -> None:
    robot = PlayedRobot(registry)
    await robot.channel.send(text)
    error = await robot.hear()
    assert isinstance(error, LinkError)
    await robot.greet(hello())
    await robot.channel.send(text)
    error = await robot.hear()
    assert isinstance(error, LinkError)
    assert detail in error.detail
    assert "\n" not in error.detail
    assert (await robot.deliver(report(1))).seq == 1


async def test_a_world_with_a_number_that_is_none_is_refused(
    registry: RobotRegistry, sink: RecordingSink
) -> None:
    robot = PlayedRobot(registry)
    await robot.greet(hello())
    bad = report(1).model_copy(update={"world": {"x": [{"y": math.nan}]}})
    await robot.channel.send(bad.model_dump_json(exclude_none=True).replace("null", "NaN"))
    assert isinstance(await robot.hear(), LinkError)
    assert sink.reports == []


async def test_a_hello_of_another_protocol_version_is_refused(registry: RobotRegistry) -> None:
    robot = PlayedRobot(registry)
    await robot.channel.send('{"type": "hello", "protocol": 2, "what": "is new"}')
    assert await robot.hear() == LinkError(
        detail="this service speaks protocol 1 and the robot speaks 2; they must be the same"
    )
    with pytest.raises(ChannelClosedError):
        await robot.hear()


async def test_a_second_hello_is_a_mistake(registry: RobotRegistry) -> None:
    robot = PlayedRobot(registry)
    await robot.greet(hello())
    await robot.say(hello())
    assert isinstance(await robot.hear(), LinkError)


async def test_a_picture_is_asked_for_and_comes(registry: RobotRegistry) -> None:
    robot = PlayedRobot(registry)
    await robot.greet(hello())
    asked = asyncio.create_task(registry.take_picture("arm", "head"))
    command = await robot.hear()
    assert isinstance(command, Command)
    jpeg = base64.b64encode(A_PICTURE).decode()
    await robot.say(Picture(command=command.id, camera="head", jpeg=jpeg))
    assert await asked == CameraPicture(A_PICTURE)


async def test_a_picture_that_does_not_come_is_a_conflict(registry: RobotRegistry) -> None:
    with pytest.raises(ConflictError, match="not connected"):
        await registry.take_picture("arm", "head")
    robot = PlayedRobot(registry)
    await robot.greet(hello())
    with pytest.raises(NotFoundError, match="no camera 'tail'"):
        await registry.take_picture("arm", "tail")
    with pytest.raises(ConflictError, match="sent no picture"):
        await registry.take_picture("arm", "head", timeout_s=0.001)
    await robot.hear()
    refused = asyncio.create_task(registry.take_picture("arm", "head"))
    command = await robot.hear()
    assert isinstance(command, Command)
    body = Rejected(command=command.id, reason="the lens cap is on")
    await robot.deliver(Report(seq=1, time=0.0, body=body))
    with pytest.raises(ConflictError, match="the lens cap is on"):
        await refused
    gone = asyncio.create_task(registry.take_picture("arm", "head"))
    await robot.hear()
    await robot.leave()
    with pytest.raises(ConflictError, match="not connected"):
        await gone


async def test_a_robot_has_time_once_it_has_taken_all_and_no_picture_is_late(
    registry: RobotRegistry,
) -> None:
    assert not registry.has_time("arm")
    robot = PlayedRobot(registry)
    await robot.greet(hello())
    assert registry.has_time("arm")
    with pytest.raises(ConflictError, match="sent no picture"):
        await registry.take_picture("arm", "head", timeout_s=0.001)
    assert not registry.has_time("arm")
    command = await robot.hear()
    assert isinstance(command, Command)
    jpeg = base64.b64encode(A_PICTURE).decode()
    await robot.say(Picture(command=command.id, camera="head", jpeg=jpeg))
    await until(lambda: registry.has_time("arm"))
    registry.send("arm", "c1", Interrupt(execution="e1", retreat=True))
    assert not registry.has_time("arm")
    await robot.hear()
    await robot.say(Taken(command="c1"))
    await until(lambda: registry.has_time("arm"))
    await robot.leave()
    await until(lambda: not registry.has_time("arm"))


class StuckSink(RecordingSink):
    """Commits nothing until it may go on."""

    def __init__(self, journal: SqliteJournal) -> None:
        super().__init__(journal)
        self.stuck, self.go_on = asyncio.Event(), asyncio.Event()

    async def robot_reported(self, robot: str, report: Report, receipt: Receipt) -> None:
        self.stuck.set()
        await self.go_on.wait()
        await super().robot_reported(robot, report, receipt)


class BrokenSink(RecordingSink):
    """Fails once to commit."""

    failures = 1

    async def robot_reported(self, robot: str, report: Report, receipt: Receipt) -> None:
        if self.failures:
            self.failures -= 1
            raise OSError("the disk is full")
        await super().robot_reported(robot, report, receipt)


async def test_a_report_that_could_not_be_committed_is_not_acknowledged(
    registry: RobotRegistry, journal: SqliteJournal
) -> None:
    sink = BrokenSink(journal)
    registry.assign("arm", sink)
    robot = PlayedRobot(registry)
    await robot.greet(hello())
    await robot.say(report(1))
    assert isinstance(await robot.hear(), LinkError)
    with pytest.raises(ChannelClosedError):
        await robot.hear()
    again = PlayedRobot(registry)
    assert (await again.greet(hello())).received == 0
    assert (await again.deliver(report(1))).seq == 1
    assert [each.seq for each in sink.reports] == [1]


async def test_a_report_waits_on_its_connection_while_the_journal_cannot_be_written(
    registry: RobotRegistry, journal: SqliteJournal
) -> None:
    connection, robot = await report_that_waits(registry, journal)
    connection.error = None
    assert await robot.hear() == Ack(seq=1)


async def test_a_simulated_robot_is_forgotten_when_nobody_owns_it(
    registry: RobotRegistry, sink: RecordingSink
) -> None:
    robot = PlayedRobot(registry)
    await robot.greet(hello(simulated=True))
    await sink.wait_until(lambda: len(sink.hellos) == 1)
    registry.unassign("arm")
    assert registry.known() == ["arm"]
    await robot.leave()
    assert registry.known() == []


async def test_a_robot_that_only_says_that_it_is_simulated_is_not_forgotten(
    registry: RobotRegistry,
) -> None:
    ours, theirs = memory_channel()
    serving = asyncio.create_task(registry.serve_stranger(theirs, Anyone()))
    await ours.send(hello(simulated=True).model_dump_json())
    await ours.receive()
    await ours.close()
    await serving
    assert registry.known() == ["arm"]


async def test_a_robot_that_makes_up_boots_is_ended(
    registry: RobotRegistry,
    journal: SqliteJournal,
    refusals: Refusals,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("mend.server.robots.known_robot.MOST_NEW_BOOTS", 3)
    robot = PlayedRobot(registry)
    await robot.greet(hello(boot="b0"))
    for number in range(5):
        await robot.say(report(1, boot=f"made-up-{number}"))
    while isinstance(last := await robot.hear(), Ack):
        pass
    assert isinstance(last, LinkError)
    assert "has sent reports of 3 boots that were not known" in last.detail
    assert await journal.received("arm", "made-up-2") == 1
    assert await journal.received("arm", "made-up-3") == 0
    assert refusals.counts["new_boots"] == 1


async def test_a_closed_registry_ends_every_connection(registry: RobotRegistry) -> None:
    robot = PlayedRobot(registry)
    await robot.greet(hello())
    registry.close()
    assert await robot.hear() == LinkError(detail="the service is shutting down")
    await robot.serving
    late: Channel = PlayedRobot(registry).channel
    await late.send(hello().model_dump_json())
    with pytest.raises(ChannelClosedError):
        await late.receive()


# --- Poses ------------------------------------------------------------------------------------

SHOWING = PoseLayout(joints=["elbow"])
POSES = Poses(time=1.0, joints=[0.5], tool=(0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0), opening_m=0.05)


async def test_poses_go_to_the_owner_and_are_not_acknowledged(
    registry: RobotRegistry, sink: RecordingSink
) -> None:
    robot = PlayedRobot(registry)
    await robot.greet(hello().model_copy(update={"shows": SHOWING}))
    await robot.say(POSES)
    assert (await robot.deliver(report(1))).seq == 1
    assert sink.posed == [POSES]
    await robot.leave()


@pytest.mark.usefixtures("sink")
async def test_a_robot_is_asked_for_poses_on_every_connection_while_they_are_wanted(
    registry: RobotRegistry,
) -> None:
    shows = hello().model_copy(update={"shows": SHOWING})
    registry.show_poses("arm", 20.0)
    for _ in range(2):
        robot = PlayedRobot(registry)
        await robot.greet(shows)
        assert await robot.hear() == ShowPoses(rate_hz=20.0)
        await robot.leave()
    robot = PlayedRobot(registry)
    await robot.greet(shows)
    assert await robot.hear() == ShowPoses(rate_hz=20.0)
    registry.show_poses("arm", 20.0)
    registry.show_poses("arm", 0.0)
    assert await robot.hear() == ShowPoses(rate_hz=0.0)
    await robot.leave()


@pytest.mark.usefixtures("sink")
async def test_poses_that_are_always_wanted_come_whatever_a_run_wants(
    registry: RobotRegistry,
) -> None:
    registry.always_show_poses("arm", 2.0)
    robot = PlayedRobot(registry)
    await robot.greet(hello().model_copy(update={"shows": SHOWING}))
    assert registry.poses("arm") is None
    assert await robot.hear() == ShowPoses(rate_hz=2.0)
    registry.show_poses("arm", 20.0)
    assert await robot.hear() == ShowPoses(rate_hz=20.0)
    registry.show_poses("arm", 0.0)
    assert await robot.hear() == ShowPoses(rate_hz=2.0)
    await robot.say(POSES)
    assert (await robot.deliver(report(1))).seq == 1
    assert registry.poses("arm") == POSES
    await robot.leave()


async def test_a_robot_that_shows_nothing_is_never_asked_for_poses(
    registry: RobotRegistry, sink: RecordingSink
) -> None:
    registry.show_poses("arm", 20.0)
    robot = PlayedRobot(registry)
    await robot.greet(hello())
    registry.show_poses("arm", 5.0)
    assert isinstance(await robot.deliver(report(1)), Ack)
    assert sink.posed == []
    await robot.leave()


@pytest.mark.parametrize("turns", range(12))
async def test_who_comes_again_as_another_goes_is_not_forgotten(
    journal: SqliteJournal, turns: int
) -> None:
    registry = RobotRegistry(journal, TickingClock(), limits=Limits(departed_robots=1))
    gone, other = PlayedRobot(registry), PlayedRobot(registry)
    await gone.greet(hello("arm"))
    await gone.channel.close()
    await gone.serving
    await other.greet(hello("leg"))
    going = asyncio.create_task(other.channel.close())
    for _ in range(turns):
        await asyncio.sleep(0)
    back = PlayedRobot(registry)
    assert isinstance(await back.greet(hello("arm")), Welcome)
    await asyncio.gather(going, other.serving)
    assert registry.connected("arm")
    registry.close()


async def test_who_comes_while_the_journal_cannot_be_read_has_to_come_again(
    registry: RobotRegistry, journal: SqliteJournal, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def unreadable(*_: object) -> int:
        raise JournalReadError("the journal could not be read: disk I/O error")

    with monkeypatch.context() as patch:
        patch.setattr(journal, "received", unreadable)
        robot = PlayedRobot(registry)
        await robot.say(hello())
        await robot.serving
    assert not registry.connected("arm")
    await PlayedRobot(registry).greet(hello())


async def test_a_robot_whose_reports_wait_for_the_journal_is_not_called_silent(
    journal: SqliteJournal, clock: TickingClock
) -> None:
    registry = RobotRegistry(journal, clock, replace(QUICK, silence_s=0.01))
    sink = StuckSink(journal)
    registry.assign("arm", sink)
    robot = PlayedRobot(registry)
    await robot.greet(hello())
    many = WAITING_REPORTS + 2
    for seq in range(1, many + 1):
        await robot.say(report(seq))
    async with asyncio.timeout(60):
        await sink.stuck.wait()
    # What it says is not read any more, for many times as long as it may say nothing.
    clock.step_s = QUICK.heartbeat_s
    await clock.looked_at(100)
    assert registry.connected("arm")
    clock.step_s = 0.0
    sink.go_on.set()
    while await robot.hear() != Ack(seq=many):
        pass
    assert sink.lost == []
    registry.close()


async def test_a_robot_that_reports_without_a_pause_is_acknowledged_now_and_then(
    registry: RobotRegistry, journal: SqliteJournal
) -> None:
    sink = StuckSink(journal)
    registry.assign("arm", sink)
    robot = PlayedRobot(registry)
    await robot.greet(hello())
    many = 2 * ACK_AT_LEAST_EVERY + 5
    for seq in range(1, many + 1):
        await robot.say(report(seq))
    await sink.stuck.wait()
    async with asyncio.timeout(60):
        while not robot.channel._outgoing.empty():  # noqa: ASYNC110 - a queue tells nobody
            await asyncio.sleep(0)
    sink.go_on.set()
    acks = [await robot.hear() for _ in range(3)]
    assert acks == [Ack(seq=seq) for seq in (ACK_AT_LEAST_EVERY, 2 * ACK_AT_LEAST_EVERY, many)]
