"""One site: a simulated world with its robots, which runs borrow and give back."""

import asyncio
import logging
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import TYPE_CHECKING
from uuid import UUID, uuid4

from mend.errors import ConflictError
from mend.robots.link.messages import (
    Avoid,
    BaseLimits,
    ClosedWay,
    FailedRobot,
    Held,
    Hello,
    Holding,
    Intervened,
    MakeWay,
    NoteTaken,
    Poses,
    Report,
)
from mend.server.journal import events as ev
from mend.server.journal.journal import Entry, Journal, Receipt
from mend.server.poses.bases import SeenBase, in_scene
from mend.server.robots.registry import RobotRegistry
from mend.server.robots.sink import FollowPoses
from mend.server.runtime.robot_proxy import RobotActivity, RobotProxy
from mend.server.runtime.team import Neighbour
from mend.server.sites.odometer import Odometer
from mend.server.sites.running_world import RunningWorld
from mend.tasks.frames import Frame
from mend.tasks.potential import Point

if TYPE_CHECKING:
    from mend.server.runtime.run import Run

log = logging.getLogger(__name__)

BASES_HZ = 2.0
"""How often robots whose site is watched say where they are, by their clock."""
MAX_RESTARTS = 20
"""So often a world is started again by itself without a report of any robot since."""


class Site:
    """The robots of one world: who has them, and which nobody has.

    Implements `mend.server.robots.sink.RobotSink` and `mend.server.runtime.team.Neighbour` for the
    robots that no run has: it has each go to rest, and keeps what it reports. `restarted` is told
    why the world was started again while no run had a robot.
    """

    def __init__(
        self,
        site: UUID,
        robots: Mapping[str, Frame],
        open_world: Callable[[Callable[[str, str], None]], RunningWorld],
        registry: RobotRegistry,
        journal: Journal,
        restarted: Callable[[str], None],
        acted: Callable[[Intervened, float], ev.Event],
    ) -> None:
        """`open_world` makes the world, given what is to be told of a robot that is lost; `acted`
        the event of what a person did at a moment of its clock (s)."""
        self.id = site
        self.world = open_world(self._lost)
        self._registry = registry
        self._journal = journal
        self._restarted = restarted
        self._acted = acted
        self._frames = dict(robots)
        self._resting = {name: self._at_rest(name) for name in robots}
        self._seen_at: dict[str, Point] = {}
        self._odometers: dict[str, Odometer] = {}
        self._handed_over: dict[str, RobotProxy] = {}
        self._runs: dict[UUID, Run] = {}
        self.forgotten = False
        """Whether its world's state is kept no more, as it is being closed."""
        self.changed: Callable[[], None] = lambda: None
        """Told when a robot has come, when a run has given robots back, and when time has passed
        for which somebody had waited."""
        self._closed: Mapping[frozenset[str], float] = {}
        self._taken: Mapping[str, Sequence[str]] = {}
        self._asks_after_s = 0.0
        self._failed: Mapping[str, Point] = {}
        self._restarts = 0
        self._tasks: set[asyncio.Task[None]] = set()

    def _at_rest(self, robot: str) -> RobotProxy:
        return RobotProxy(robot, self._registry, self._frames[robot])

    @property
    def used(self) -> bool:
        """Whether any run has a robot of it."""
        return bool(self._runs)

    def run_of(self, robot: str) -> UUID | None:
        """Which run has a robot."""
        return next((run for run, each in self._runs.items() if robot in each.proxies), None)

    def rests(self, robot: str) -> bool:
        """Whether it is connected, and no run has it."""
        proxy = self._resting.get(robot)
        return proxy is not None and (proxy.free or proxy.interruptible)

    def is_connected(self, robot: str) -> bool:
        """Whether a robot is there, whoever has it."""
        return self._registry.connected(robot)

    def whereabouts(self, robot: str) -> Point | None:
        """Where a robot says that it is, in the scene's frame; else what a run's look last said."""
        shown = self.base(robot)
        return self._seen_at.get(robot) if shown is None else shown.pose[:3]

    def show_bases(self) -> None:
        """Have its robots say where they are, also those that no run has."""
        for robot in self._frames:
            self._registry.always_show_poses(robot, BASES_HZ)

    def follow_bases(self, follow: FollowPoses | None) -> None:
        """Have it told whenever a robot says where it is, in the frame of that robot."""
        for robot in self._frames:
            self._registry.follow_poses(robot, follow)

    @property
    def frames(self) -> Mapping[str, Frame]:
        """In which each robot says where it is, in the scene's."""
        return self._frames

    @property
    def shown_s(self) -> float:
        """The world's clock, as far as reports and poses tell: for who watches it."""
        poses = [self._registry.poses(robot) for robot in self._frames]
        return max(self.world.time.latest_s, *(e.time for e in poses if e is not None), 0.0)

    def base(self, robot: str) -> SeenBase | None:
        """Where a robot says that it is, in the scene's frame; None until it has."""
        poses = self._registry.poses(robot)
        if poses is None:
            return None
        age_s = self.shown_s - poses.time
        return SeenBase(in_scene(self._frames[robot], poses.base), age_s, poses.covariance)

    def battery(self, robot: str) -> float | None:
        """What a robot's battery holds, as a share; None where it does not run out or say so."""
        poses = self._registry.poses(robot)
        return None if poses is None else poses.battery

    def odometer(self, robot: str) -> Odometer | None:
        """What a robot had driven when it last said so while no run had it, or at a run's end."""
        return self._odometers.get(robot)

    def _note_driven(self, proxy: RobotProxy) -> None:
        if proxy.hello is not None and proxy.driven is not None:
            told = Odometer(proxy.hello.boot, proxy.driven)
            self._odometers[proxy.robot] = told.later(self._odometers.get(proxy.robot))

    def let_time_pass(self, until_s: float, rate: float | None) -> bool:
        """Have the world's clock run until then, also where no run has a robot.

        `rate`: simulated seconds per second, None as fast as possible. False if nobody is free to
        wait for that.
        """
        for proxy in self._resting.values():
            if proxy.free or proxy.interruptible:
                proxy.hold(until_s, rate)
                return True
        return False

    def hear_of_ways(self, asks_after_s: float) -> None:
        """Somebody hears what its robots find of ways: each waits so long before it asks people."""
        self._asks_after_s = asks_after_s
        for robot in self._frames:
            if self.is_connected(robot):
                self._tell_ways(robot)

    def keep_off(
        self, closed: Mapping[frozenset[str], float], failed: Collection[str] = ()
    ) -> None:
        """Have its robots keep off ways between neighbouring places, each until a time (s), and
        know where robots stand that have `failed`.

        Robots that do not know of such things go on as they do.
        """
        standing = {each: at for each in failed if (at := self._stands(each)) is not None}
        if (closed, standing) == (self._closed, self._failed):
            return
        self._closed, self._failed = dict(closed), standing
        for robot in self._frames:
            if self.is_connected(robot):
                self._tell_ways(robot)

    def _stands(self, robot: str) -> Point | None:
        """About where a robot says that it is; None where it has said nothing yet."""
        where = self.whereabouts(robot)
        return None if where is None else (round(where[0], 1), round(where[1], 1), where[2])

    def note_taken(self, taken: Mapping[str, Sequence[str]]) -> None:
        """Have robots know what people have taken out of their baskets for others, by robot."""
        before, self._taken = self._taken, {each: [*items] for each, items in taken.items()}
        for robot, items in self._taken.items():
            if set(items) - set(before.get(robot, ())) and self.is_connected(robot):
                self._tell_taken(robot)

    def make_way(self, robot: str, told: MakeWay) -> None:
        """Have a robot make way, or wait for one that does, if it knows of that."""
        if self.base_of(robot) is not None and self.is_connected(robot):
            self._registry.send(robot, str(uuid4()), told, renews=False)

    def base_of(self, robot: str) -> BaseLimits | None:
        """How wide and fast a robot has said that it is; None of one that does not make way."""
        hello = self._registry.hello(robot)
        return None if hello is None else hello.base

    def _told_on_coming(self, robot: str) -> None:
        if self._closed or self._asks_after_s or self._failed:
            self._tell_ways(robot)
        if self._taken.get(robot):
            self._tell_taken(robot)

    def _tell_taken(self, robot: str) -> None:
        hello = self._registry.hello(robot)
        if hello is not None and hello.notes_taken:
            body = NoteTaken(items=[*self._taken[robot]])
            self._registry.send(robot, str(uuid4()), body, renews=False)

    def _tell_ways(self, robot: str) -> None:
        hello = self._registry.hello(robot)
        if hello is not None and hello.avoids_ways:
            ways = [
                ClosedWay(between=sorted(way), until=until_s)
                for way, until_s in self._closed.items()
            ]
            frame = self._frames[robot]
            failed = [
                FailedRobot(robot=name, x=x, y=y, z=z)
                for name, at in self._failed.items()
                if name != robot
                for (x, y), z in [(frame.to_robot(at[0], at[1]), at[2])]
            ]
            body = Avoid(ways=ways, asks_after_s=self._asks_after_s, failed=failed)
            self._registry.send(robot, str(uuid4()), body, renews=False)

    # --- Its world ----------------------------------------------------------------------------

    async def start(self) -> None:
        """Start the world, and keep its robots. Raises `WrongInputError` if it cannot run here."""
        for robot in self._frames:
            self._registry.keep(robot, self)
        await self.world.start()

    async def stop(self) -> None:
        """Stop the world for good."""
        for task in tuple(self._tasks):
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        for robot in self._frames:
            self._registry.keep_no_more(robot)
        await self.world.stop()

    def _lost(self, robot: str, reason: str) -> None:
        """The world has ended: whoever has a robot starts it again."""
        run = self.run_of(robot)
        if run is not None:
            self._runs[run].tell_lost(robot, reason)
        else:
            self._spawn_restart(robot, reason)

    def _spawn_restart(self, robot: str, reason: str) -> None:
        task = asyncio.create_task(self._restart(robot, reason))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _restart(self, robot: str, reason: str) -> None:
        proxy = self._resting.get(robot)
        if proxy is None:
            # A run has borrowed it since then: it is that which starts the world again.
            if (run := self.run_of(robot)) is not None:
                self._runs[run].tell_lost(robot, reason)
            return
        proxy.disconnect()
        proxy.area = None
        self._restarts += 1
        if self._restarts > MAX_RESTARTS:
            log.error("site %s: its world keeps ending: %s", self.id, reason)
            return
        if await self.world.restart(robot):
            self._restarted(reason)

    # --- Its robots, while no run has them (RobotSink) ----------------------------------------

    async def robot_connected(self, robot: str, hello: Hello) -> None:
        """A robot is there, with nobody who has work for it."""
        self._told_on_coming(robot)
        proxy = self._resting.get(robot)
        if proxy is None:
            return
        area, was_there = proxy.area, proxy.hello is not None and proxy.hello.boot == hello.boot
        proxy.connect(hello)
        self._note_driven(proxy)
        self.world.came(robot)
        self.world.time.heard(hello.time)
        if was_there or hello.executing is not None:
            # What it was about for a run is over; until it rests it has its space.
            proxy.area = area
            proxy.retreat()
        self.changed()

    async def robot_reported(self, robot: str, report: Report, receipt: Receipt) -> None:
        """Keep what a robot reports that comes to rest."""
        self._restarts = 0
        self.world.time.heard(report.time)
        world = None if self.forgotten else report.world
        done = (
            [self._acted(report.body, report.time)] if isinstance(report.body, Intervened) else []
        )
        kept_as = None if world is None else self.id
        entry = Entry(events=done, receipt=receipt, world_run=kept_as, world=world)
        await self._journal.append(entry, patient=True)
        proxy = self._resting.get(robot)
        if proxy is None:
            return
        proxy.driven = report.driven or proxy.driven
        self._note_driven(proxy)
        if isinstance(report.body, Holding):
            proxy.hold_execution(report.body)
            self.tell_neighbours(None)
        if isinstance(report.body, Held) and report.body.command == proxy.command:
            proxy.doing = RobotActivity.IDLE
        self.changed()

    def robot_posed(self, robot: str, poses: Poses) -> None:
        """No run watches it; what it said last the registry knows."""

    async def robot_lost(self, robot: str, reason: str) -> None:
        """A robot's connection is gone and has not come back."""
        await self._restart(robot, reason)

    # --- Who has them -------------------------------------------------------------------------

    def lend(self, run: "Run") -> None:
        """A run has its robots from now on."""
        self._runs[run.context.state.id] = run
        for robot in run.proxies:
            self._handed_over[robot] = self._resting.pop(robot)

    def came(self, proxy: RobotProxy) -> None:
        """A robot of a run has connected: it goes to rest first if it had not yet."""
        self._told_on_coming(proxy.robot)
        self.world.came(proxy.robot)
        before = self._handed_over.pop(proxy.robot, None)
        if before is not None and before.doing is RobotActivity.RETREATING:
            proxy.area = before.area
            proxy.retreat()

    def take_back(self, run: "Run") -> None:
        """A run has ended: its robots are the site's again, each with its space until it rests."""
        if self._runs.pop(run.context.state.id, None) is None:
            return
        for robot, proxy in run.proxies.items():
            self._handed_over.pop(robot, None)
            resting = self._at_rest(robot)
            resting.hello, resting.area = proxy.hello, proxy.area
            self._seen_at[robot] = proxy.gripper
            self._note_driven(proxy)
            self._resting[robot] = resting
        self.tell_neighbours(run)
        self.changed()

    def require_free(self, robots: Sequence[str]) -> None:
        """Raises `ConflictError` where a run has one of these robots."""
        for robot in robots:
            run = self.run_of(robot)
            if run is not None:
                raise ConflictError(f"the robot '{robot}' is busy with run {run}")

    # --- Who else is there (Neighbour) --------------------------------------------------------

    @property
    def proxies(self) -> Mapping[str, RobotProxy]:
        return self._resting

    def handled(self) -> set[str]:
        """Nothing: who has no run handles nothing."""
        return set()

    def neighbours_of(self, run: "Run") -> list[Neighbour]:
        """Who else has robots here."""
        others = [each for each in self._runs.values() if each is not run]
        return [*others, self]

    def tell_neighbours(self, run: "Run | None") -> None:
        """Something has changed: what others waited for may be free."""
        for each in self._runs.values():
            if each is not run:
                each.look_again()
