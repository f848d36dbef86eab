"""Every robot that is or was connected, and the service's end of their connections."""

import asyncio
import json
import logging
from collections.abc import Callable
from contextlib import suppress
from functools import partial

from pydantic import ValidationError

from mend.errors import ConflictError
from mend.robots.link.channel import Channel, ChannelClosedError
from mend.robots.link.messages import PROTOCOL_VERSION, CommandBody, Hello, LinkError, Poses
from mend.server.camera_picture import CameraPicture
from mend.server.journal.journal import Journal, JournalClosedError, JournalReadError
from mend.server.limits import Limits
from mend.server.pace import Pace
from mend.server.refusals import Refusals
from mend.server.robots.known_robot import KnownRobot, ReplacedError
from mend.server.robots.paced_channel import PacedChannel
from mend.server.robots.passes import Anyone, Pass
from mend.server.robots.session import NoSenseError, RobotSession, read_message, sentence
from mend.server.robots.sink import FollowPoses, RobotSink
from mend.server.robots.times import LinkTimes

__all__ = ["RobotRegistry", "RobotSink"]

log = logging.getLogger(__name__)


class RobotRegistry:
    """Hands commands to robots and their reports to whoever owns them.

    `clock` is any monotonic clock in seconds.
    """

    def __init__(
        self,
        journal: Journal,
        clock: Callable[[], float],
        times: LinkTimes | None = None,
        limits: Limits | None = None,
        refusals: Refusals | None = None,
    ) -> None:
        self._journal = journal
        self._clock = clock
        self._times = times or LinkTimes()
        self._limits = limits or Limits()
        self._refusals = refusals or Refusals()
        self._robots: dict[str, KnownRobot] = {}
        self._closed = False

    # --- What the runtime asks ----------------------------------------------------------------

    def assign(self, robot: str, sink: RobotSink) -> None:
        """Give a robot to a run; it is told at once if the robot is connected.

        Raises `ConflictError` if another run has it.
        """
        self._known(robot).assign(sink)

    def unassign(self, robot: str) -> None:
        """Take a robot from the run that has it."""
        if robot in self._robots:
            self._robots[robot].unassign()
            self._forget(robot)

    def keep(self, robot: str, keeper: RobotSink) -> None:
        """Say who has a robot whenever no run has it."""
        self._known(robot).keep(keeper)

    def keep_no_more(self, robot: str) -> None:
        """Nobody has it then."""
        if robot in self._robots:
            self._robots[robot].keep(None)
            self._forget(robot)

    def send(self, robot: str, command_id: str, body: CommandBody, *, renews: bool = True) -> None:
        """Send a command, when connected; again after a reconnect, until the robot has taken it.

        Dropped when the robot comes back with a new boot. A command id that is still waiting is
        sent once. `renews`: see `KnownRobot.command`. Raises `ConflictError` when too many wait.
        """
        self._known(robot).command(command_id, body, renews=renews)

    def show_poses(self, robot: str, rate_hz: float) -> None:
        """Have a robot send its poses at most so often, also on its later connections; 0: never."""
        if robot in self._robots:
            self._robots[robot].show_poses(rate_hz)

    def always_show_poses(self, robot: str, rate_hz: float) -> None:
        """Have a robot send them at least so often, whether or not a run wants them."""
        self._known(robot).always_show_poses(rate_hz)

    def follow_poses(self, robot: str, follow: FollowPoses | None) -> None:
        """Have it told of poses of a robot as they come, whoever has that."""
        self._known(robot).follow_poses = follow

    def poses(self, robot: str) -> Poses | None:
        """The newest poses of a robot that sends any."""
        return self._robots[robot].poses if robot in self._robots else None

    async def take_picture(self, robot: str, camera: str, timeout_s: float = 2.0) -> CameraPicture:
        """A camera's picture now.

        Raises `NotFoundError` if there is no such camera, `ConflictError` if it does not come.
        """
        if robot not in self._robots:
            raise ConflictError(f"the robot '{robot}' is not connected")
        return await self._robots[robot].take_picture(camera, timeout_s)

    def has_time(self, robot: str) -> bool:
        """Whether a robot is there, has taken all that it was told, and no picture is late."""
        return robot in self._robots and self._robots[robot].has_time

    def hello(self, robot: str) -> Hello | None:
        """The robot's last hello; None if it never said one."""
        return self._robots[robot].hello if robot in self._robots else None

    def connected(self, robot: str) -> bool:
        return robot in self._robots and self._robots[robot].session is not None

    def known(self) -> list[str]:
        """Every robot that is or was connected, by name."""
        return sorted(name for name, robot in self._robots.items() if robot.hello is not None)

    def last_heard(self, robot: str) -> float | None:
        """When something last came from a robot, by our clock; None if it is not connected."""
        session = self._robots[robot].session if robot in self._robots else None
        return None if session is None else session.last_heard

    async def end_connection(self, robot: str, reason: str) -> None:
        """The robot's program has ended: wait for nothing more of it.

        Its owner is not told that it is lost: whoever ran the program does that.
        """
        if robot in self._robots:
            await self._robots[robot].end_connection(reason)

    def close(self) -> None:
        """End every connection; robots come back when there is a service again."""
        self._closed = True
        for robot in self._robots.values():
            robot.close()

    def _known(self, name: str) -> KnownRobot:
        if name not in self._robots:
            self._robots[name] = KnownRobot(name, self._journal, self._times, self._refusals)
        return self._robots[name]

    def _forget(self, name: str) -> None:
        if name in self._robots and self._robots[name].forgettable:
            del self._robots[name]

    def _forget_the_longest_gone(self, leaving: str) -> None:
        """Of the robots that are gone only so many are kept, in the order in which they went."""
        if leaving in self._robots:
            self._robots[leaving] = self._robots.pop(leaving)
        departed = [name for name, robot in self._robots.items() if robot.departed]
        for name in departed[: -self._limits.departed_robots]:
            del self._robots[name]
            self._refusals.note("departed_robots")

    # --- Connections --------------------------------------------------------------------------

    async def serve(self, channel: Channel, shown: Pass | None = None) -> None:
        """Serve one connection of a robot until it ends.

        `shown` says as which robot it may say hello; None for a channel within this process.
        """
        await self._serve(channel, shown or Anyone(), ours=True)

    async def serve_stranger(self, channel: Channel, shown: Pass) -> None:
        """Serve one connection of a robot that this service does not run, at a bounded pace."""
        held_back = partial(self._refusals.note, "robot_messages_per_s")
        pace = Pace(self._limits.robot_messages_per_s, self._clock, held_back)
        await self._serve(PacedChannel(channel, pace), shown, ours=False)

    async def _serve(self, channel: Channel, shown: Pass, *, ours: bool) -> None:
        try:
            hello = await self._greeted(channel)
            if hello is not None and not self._closed:
                await self._serve_robot(channel, hello, shown, ours=ours)
        finally:
            with suppress(ChannelClosedError):
                await channel.close()

    async def _serve_robot(
        self, channel: Channel, hello: Hello, shown: Pass, *, ours: bool
    ) -> None:
        # First: who may not be this robot is to leave no trace of it either.
        refusal = shown.why_not(hello.robot)
        if refusal is not None:
            await _complain(channel, refusal)
            return
        robot = self._known(hello.robot)
        refusal = robot.why_refused(hello, ours=ours)
        if refusal is not None:
            await _complain(channel, refusal)
            return
        session = RobotSession(channel, robot, self._clock, self._times)
        try:
            if await self._connected(robot, session, hello, ours=ours):
                await session.run()
        except JournalClosedError:
            log.info("robot %s came while the service was shutting down", hello.robot)
        finally:
            robot.disconnect(session)
            self._forget(hello.robot)
            self._forget_the_longest_gone(hello.robot)

    async def _connected(
        self, robot: KnownRobot, session: RobotSession, hello: Hello, *, ours: bool
    ) -> bool:
        """Whether it is the robot's connection now."""
        # Who is told of a mistake before the welcome stops; this one is to come again.
        try:
            async with asyncio.timeout(self._limits.hello_s):
                await robot.connect(session, hello, ours=ours)
        except ReplacedError as error:
            log.info("robot %s has to come again: %s", robot.name, error)
            return False
        except TimeoutError:
            self._refusals.note("hello_s")
            log.info("robot %s has to come again: its last report is not committed", robot.name)
            return False
        except JournalReadError as error:
            log.info("robot %s has to come again: %s", robot.name, error)
            return False
        return True

    async def _greeted(self, channel: Channel) -> Hello | None:
        """The hello, or None if there is none to go on with."""
        try:
            async with asyncio.timeout(self._limits.hello_s):
                while True:
                    text = await channel.receive()
                    complaint = self._too_long(text) or _other_protocol(text)
                    if complaint is not None:
                        await _complain(channel, complaint)
                        return None
                    try:
                        message = read_message(text)
                    except ValidationError as error:
                        await _complain(channel, sentence(error))
                        continue
                    except NoSenseError as error:
                        self._refusals.note("robot_numbers")
                        await _complain(channel, str(error))
                        return None
                    if isinstance(message, Hello):
                        return message
                    await _complain(channel, "the first message of a connection is a hello")
        except TimeoutError:
            self._refusals.note("hello_s")
            return None
        except ChannelClosedError:
            return None

    def _too_long(self, text: str) -> str | None:
        """What to say to a first message that is too long to be kept."""
        most = self._limits.hello_chars
        if len(text) <= most:
            return None
        self._refusals.note("hello_chars")
        return f"a hello may have {most} characters; this one has {len(text)}"


async def _complain(channel: Channel, detail: str) -> None:
    """Say what is wrong to whoever is still there."""
    with suppress(ChannelClosedError):
        await channel.send(LinkError(detail=detail).model_dump_json())


def _other_protocol(text: str) -> str | None:
    """What to say to a hello of another protocol version, whatever else it holds."""
    try:
        message = json.loads(text)
    except (ValueError, RecursionError):
        return None
    if not isinstance(message, dict) or message.get("type") != "hello":
        return None
    version = message.get("protocol")
    if not isinstance(version, int) or version == PROTOCOL_VERSION:
        return None
    return (
        f"this service speaks protocol {PROTOCOL_VERSION} and the robot speaks {version}; "
        "they must be the same"
    )
