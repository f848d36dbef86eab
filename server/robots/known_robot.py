"""One robot that the service knows: what it is, what it was told, who owns it."""

import asyncio
import logging
from collections import OrderedDict
from collections.abc import Callable, Coroutine
from typing import Any
from uuid import uuid4

from mend.errors import ConflictError, MendError, NotFoundError
from mend.robots.link.jpeg import NotJpegError, read_jpeg
from mend.robots.link.messages import (
    PROTOCOL_VERSION,
    Ack,
    ClipTaken,
    Command,
    CommandBody,
    Hello,
    IssueDetected,
    Picture,
    Poses,
    Rejected,
    Report,
    ShowPoses,
    Taken,
    TakePicture,
    Welcome,
)
from mend.server.camera_picture import CameraPicture
from mend.server.journal.journal import DuplicateReceiptError, Entry, Journal, Receipt
from mend.server.limits import LimitName
from mend.server.pace import CHARS_OF_ONE
from mend.server.plain_text import plain
from mend.server.refusals import Refusals
from mend.server.robots.session import (
    MissingReportError,
    PictureError,
    RobotSession,
    TooManyReportsError,
)
from mend.server.robots.sink import FollowPoses, RobotSink
from mend.server.robots.times import LinkTimes

log = logging.getLogger(__name__)

MOST_UNTAKEN_COMMANDS = 1000
OWED_S = 30.0
"""After so long a picture that has not come is not waited for any more."""
MOST_OWED = 100

MOST_UNASKED_REPORTS = 10_000
"""What a robot has to report until its task comes on is far less: more fills the journal only."""

MOST_NEW_BOOTS = 100
"""Of each start of its program the journal keeps a number for ever."""

REPLACED = "a newer connection of this robot has replaced this one"

MISSED_HEARTBEATS = 2
"""After so many nobody can say that the program of a robot still runs."""


class ReplacedError(MendError):
    """A newer connection of the same robot has come before this one had its turn."""


class KnownRobot:
    """Implements `mend.server.robots.session.Receiver`."""

    def __init__(self, name: str, journal: Journal, times: LinkTimes, refusals: Refusals) -> None:
        self.name = name
        self.hello: Hello | None = None
        self.session: RobotSession | None = None
        self._taking_over = asyncio.Lock()
        self._coming: asyncio.Task[None] | None = None
        self._ours = False
        self._journal = journal
        self._times = times
        self._refusals = refusals
        self._run: RobotSink | None = None
        self._keeper: RobotSink | None = None
        self._sink_sees_it = False
        self._untaken: OrderedDict[str, Command] = OrderedDict()
        self._pictures: dict[str, asyncio.Future[CameraPicture]] = {}
        self._owed: OrderedDict[str, float] = OrderedDict()
        """Pictures that did not come in time, and when that was: they may come yet."""
        self._received: dict[str, int] = {}
        self._heard_of: set[str] = set()
        self._refused: tuple[str, str] | None = None
        self._unasked_reports = self._new_boots = 0
        self._poses_hz = self._always_hz = 0.0
        self.follow_poses: FollowPoses | None = None
        self.poses: Poses | None = None
        """The newest of this start of its program."""
        self._absence: asyncio.TimerHandle | None = None
        self._tasks: set[asyncio.Task[None]] = set()
        self._is_closed = False

    @property
    def forgettable(self) -> bool:
        """Whether nobody will ask for it again: a simulated robot of ours whose run is over."""
        ours = self._ours and self.hello is not None and self.hello.simulated
        return self.departed and (self.hello is None or ours)

    @property
    def departed(self) -> bool:
        """Whether it has no connection, also none that is coming, and no owner."""
        return self.session is None and self._sink is None and self._coming is None

    # --- Its connection -----------------------------------------------------------------------

    async def connect(self, session: RobotSession, hello: Hello, *, ours: bool) -> None:
        """Let a new connection take the place of the one there may be, once that has ended.

        Raises `ReplacedError` where a newer one comes meanwhile. `ours`: see `why_refused`.
        """
        if self._coming is not None:
            self._coming.cancel()
        coming = self._coming = asyncio.create_task(self._take_over(session, hello, ours=ours))
        try:
            await coming
        except asyncio.CancelledError:
            if self._coming is coming:
                raise
            raise ReplacedError(REPLACED) from None
        finally:
            if self._coming is coming:
                self._coming = None

    async def _take_over(self, session: RobotSession, hello: Hello, *, ours: bool) -> None:
        async with self._taking_over:
            await self._connect(session, hello)
            self._ours = ours

    async def _connect(self, session: RobotSession, hello: Hello) -> None:
        if self.session is not None:
            await self.session.end(REPLACED)
        received = await self._journal.received(self.name, hello.boot)
        self._cancel_absence()
        if self.hello is None or self.hello.boot != hello.boot:
            if self.hello is not None:
                self._untaken.clear()
            self._received.clear()
            self.poses = None
        self._heard_of.clear()
        self._received[hello.boot] = received
        self.hello, self.session = hello, session
        session.send(
            Welcome(
                protocol=PROTOCOL_VERSION, received=received, heartbeat_s=self._times.heartbeat_s
            )
        )
        for command in self._untaken.values():
            session.send(command)
        session.do(self._announce)
        if max(self._poses_hz, self._always_hz) > 0.0:
            self._ask_for_poses()

    def refuse(self, reason: str, limit: LimitName) -> None:
        """End its connection, and let this start of its program in no more.

        What it keeps in its outbox would only come again.
        """
        assert self.hello is not None, "who sends something has said hello"
        assert self.session is not None, "who sends something is connected"
        log.warning("robot %s is refused: %s", self.name, plain(reason))
        self._refusals.note(limit)
        self._refused = self.hello.boot, reason
        self.session.end_soon(reason)

    def why_refused(self, hello: Hello, *, ours: bool = True) -> str | None:
        """Why a start of its program is not let in; None if it is.

        `ours`: it is a program of this service, or a channel within its process.
        """
        boot, reason = self._refused or (None, "")
        if boot == hello.boot:
            return f"start the robot's program again: {reason}"
        if self._is_another_program(hello, ours=ours):
            return (
                f"another program is connected as the robot '{self.name}': stop it first, or take "
                "another name"
            )
        return None

    def _is_another_program(self, hello: Hello, *, ours: bool) -> bool:
        """Whether a hello is of a second program, while the first one is still there.

        A program that has ended and was started again leaves a connection on which nothing comes.
        The programs of this service's simulated robots are started and ended by it.
        """
        if self.session is None or self.hello is None or (hello.simulated and ours):
            return False
        lively = self.session.silent_s <= MISSED_HEARTBEATS * self._times.heartbeat_s
        return lively and self.hello.boot != hello.boot

    def disconnect(self, session: RobotSession) -> None:
        """A connection has ended; after a while without a new one the robot is lost."""
        if self.session is not session:
            return
        self.session = None
        self._owed.clear()
        for future in self._pictures.values():
            if not future.done():
                future.set_exception(ConflictError(f"the robot '{self.name}' is not connected"))
        if self._is_closed:
            # It is the service that goes.
            return
        reason = session.reason
        self._absence = asyncio.get_running_loop().call_later(
            self._times.absence_s, lambda: self._spawn(self._tell_lost(reason))
        )

    async def end_connection(self, reason: str) -> None:
        """Its program has ended; whoever ran it tells its owner."""
        if self.session is not None:
            session = self.session
            await session.end(reason)
            self.disconnect(session)
        self._cancel_absence()
        self._sink_sees_it = False

    def close(self) -> None:
        self._is_closed = True
        self._cancel_absence()
        if self.session is not None:
            self.session.end_soon("the service is shutting down")
        for task in self._tasks:
            task.cancel()

    def _cancel_absence(self) -> None:
        if self._absence is not None:
            self._absence.cancel()
            self._absence = None

    def _spawn(self, work: Coroutine[Any, Any, None]) -> None:
        task = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    # --- Its owner ----------------------------------------------------------------------------

    @property
    def _sink(self) -> RobotSink | None:
        return self._keeper if self._run is None else self._run

    def assign(self, run: RobotSink) -> None:
        if self._run is not None and self._run is not run:
            raise ConflictError(f"the robot '{self.name}' is busy with another run")
        self._run = run
        self._introduce()

    def unassign(self) -> None:
        self._run = None
        self._introduce()
        self.show_poses(0.0)

    def keep(self, keeper: RobotSink | None) -> None:
        """Who has it whenever no run has it."""
        self._keeper = keeper
        if self._run is None:
            self._introduce()

    def _introduce(self) -> None:
        """Whoever has it now has yet to see it."""
        self._sink_sees_it = False
        if self._sink is not None and self.session is not None:
            self.session.do(self._announce)

    async def _announce(self) -> None:
        if self._sink is not None and self.hello is not None:
            self._sink_sees_it = True
            await self._sink.robot_connected(self.name, self.hello)

    async def _tell_lost(self, reason: str) -> None:
        # Who is about to take the ended connection's place has not gone away.
        async with self._taking_over:
            gone = self.session is None
        if gone and self._sink is not None and self._sink_sees_it:
            self._sink_sees_it = False
            await self._sink.robot_lost(self.name, reason)

    # --- What it is told ----------------------------------------------------------------------

    def command(self, command_id: str, body: CommandBody, *, renews: bool = True) -> None:
        """Send a command, now or when the robot is back. Raises `ConflictError`: too many wait.

        `renews`: it is no mere repetition, so that as much may be reported of it as of all before.
        """
        if command_id in self._untaken:
            return
        if len(self._untaken) >= MOST_UNTAKEN_COMMANDS:
            # Nobody may have asked for it: so it is counted here, and by no one who hears of it.
            self._refusals.note("untaken_commands")
            raise ConflictError(
                f"the robot '{self.name}' has not taken its last {MOST_UNTAKEN_COMMANDS} commands"
            )
        if renews:
            self._unasked_reports = self._new_boots = 0
        command = self._untaken[command_id] = Command(id=command_id, body=body)
        if self.session is not None:
            self.session.send(command)

    def show_poses(self, rate_hz: float) -> None:
        """Have it send its poses at most so often; 0 is not at all. Holds until changed."""
        if rate_hz != self._poses_hz:
            self._poses_hz = rate_hz
            self._ask_for_poses()

    def always_show_poses(self, rate_hz: float) -> None:
        """Have it send them at least so often, whoever has it, and whether any run wants them."""
        if rate_hz != self._always_hz:
            self._always_hz = rate_hz
            self._ask_for_poses()

    def _ask_for_poses(self) -> None:
        shows = self.hello is not None and self.hello.shows is not None
        if self.session is not None and shows:
            self.session.send(ShowPoses(rate_hz=max(self._poses_hz, self._always_hz)))

    @property
    def has_time(self) -> bool:
        """Whether it has taken all that it was told, and no picture of it is late."""
        oldest_s = asyncio.get_running_loop().time() - OWED_S
        owes = any(since > oldest_s for since in self._owed.values())
        return self.session is not None and not self._untaken and not owes

    async def take_picture(self, camera: str, timeout_s: float) -> CameraPicture:
        """A camera's picture now. Raises `NotFoundError` or `ConflictError`."""
        if self.hello is None or self.session is None:
            raise ConflictError(f"the robot '{self.name}' is not connected")
        if camera not in self.hello.cameras:
            raise NotFoundError(f"the robot '{self.name}' has no camera '{camera}'")
        command_id = str(uuid4())
        future: asyncio.Future[CameraPicture] = asyncio.get_running_loop().create_future()
        self._pictures[command_id] = future
        self.session.send(Command(id=command_id, body=TakePicture(camera=camera)))
        try:
            async with asyncio.timeout(timeout_s):
                return await future
        except TimeoutError:
            self._owed[command_id] = asyncio.get_running_loop().time()
            while len(self._owed) > MOST_OWED:
                self._owed.popitem(last=False)
            raise ConflictError(
                f"the robot '{self.name}' sent no picture of '{camera}' within {timeout_s:g} s"
            ) from None
        finally:
            del self._pictures[command_id]

    # --- What it sends ------------------------------------------------------------------------

    def receive_taken(self, taken: Taken) -> None:
        self._untaken.pop(taken.command, None)

    def receive_picture(self, picture: Picture) -> None:
        try:
            jpeg = read_jpeg(picture.jpeg)
        except NotJpegError as error:
            raise PictureError(f"the picture of '{picture.camera}' {error}") from error
        taken = CameraPicture(jpeg, picture.detection)
        self._answer(picture.command, lambda future: future.set_result(taken))

    def receive_poses(self, poses: Poses) -> None:
        self.poses = poses
        if self.follow_poses is not None:
            self.follow_poses(self.name, poses)
        if self._sink is not None and self._sink_sees_it:
            self._sink.robot_posed(self.name, poses)

    def _answer(
        self, command: str, answer: Callable[[asyncio.Future[CameraPicture]], None]
    ) -> None:
        self._owed.pop(command, None)
        future = self._pictures.get(command)
        if future is not None and not future.done():
            answer(future)

    async def receive_report(self, report: Report) -> Ack:
        """Commit a report unless it is known; returns what may be acknowledged.

        Raises `MissingReportError` when the one before it was left out, and `TooManyReportsError`.
        """
        assert self.hello is not None, "reports only come after a hello"
        boot = report.boot or self.hello.boot
        if boot not in self._received:
            self._received[boot] = await self._journal.received(self.name, boot)
        last = self._received[boot]
        if report.seq > last:
            self._require_no_gap(boot, last, report.seq)
            self._require_bound(report, new_boot=last == 0)
            await self._commit(report, Receipt(self.name, boot, report.seq))
            last = self._received[boot] = report.seq
        self._heard_of.add(boot)
        if isinstance(report.body, Rejected):
            refusal = ConflictError(f"the robot '{self.name}' refused: {report.body.reason}")
            self._answer(report.body.command, lambda future: future.set_exception(refusal))
        return Ack(boot=report.boot, seq=last)

    def _require_no_gap(self, boot: str, last: int, seq: int) -> None:
        """The first report of a connection may be any: the journal may have been begun anew."""
        if boot in self._heard_of and seq != last + 1:
            raise MissingReportError(
                f"report {seq} came, but the last one was {last}; send {last + 1} first"
            )

    def _require_bound(self, report: Report, *, new_boot: bool) -> None:
        self._new_boots += new_boot
        if self._new_boots > MOST_NEW_BOOTS:
            raise TooManyReportsError(
                f"the robot '{self.name}' has sent reports of {MOST_NEW_BOOTS} boots that were "
                "not known since it was last told something new",
                "new_boots",
            )
        self._unasked_reports += 1 + _picture_chars(report) // CHARS_OF_ONE
        if self._unasked_reports > MOST_UNASKED_REPORTS:
            raise TooManyReportsError(
                f"the robot '{self.name}' has sent {MOST_UNASKED_REPORTS} reports since it was "
                "last told something new",
                "unasked_reports",
            )

    async def _commit(self, report: Report, receipt: Receipt) -> None:
        try:
            if self._sink is None:
                await self._journal.append(Entry(receipt=receipt), patient=True)
            else:
                await self._sink.robot_reported(self.name, report, receipt)
        except DuplicateReceiptError:
            log.info("report %d of %s was received before", receipt.seq, self.name)


def _picture_chars(report: Report) -> int:
    """How much of a report are pictures, which are kept in the journal."""
    match report.body:
        case IssueDetected(jpeg=str(jpeg)):
            return len(jpeg)
        case ClipTaken(pictures=pictures):
            return sum(len(each.jpeg) for each in pictures)
        case _:
            return 0
