"""One robot of a run, as the run sees it: what it was last told, and what it last saw."""

import logging
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any, Protocol
from uuid import uuid4

from shapely.geometry.base import BaseGeometry

from mend.robots.arm.shared_space import Flat
from mend.robots.link.jpeg import NotJpegError, read_jpeg
from mend.robots.link.messages import (
    CommandBody,
    Detection,
    Driven,
    FeltLoad,
    FinishedResult,
    Hello,
    Hold,
    Holding,
    Interrupt,
    Intervene,
    Location,
    Look,
    Looked,
    Resume,
    RoomLimits,
    Sighting,
    Start,
    WasDone,
)
from mend.server.runtime.livelock import Livelock
from mend.server.runtime.run_state import StartedExecution
from mend.server.runtime.team import EVERYWHERE, Team
from mend.tasks.frames import Frame
from mend.tasks.intervention import Intervention
from mend.tasks.potential import Point

log = logging.getLogger(__name__)


class RobotActivity(StrEnum):
    """What a robot is busy with."""

    ABSENT = "absent"
    IDLE = "idle"
    LOOKING = "looking"
    WAITING = "waiting"
    WORKING = "working"
    RETREATING = "retreating"


class Purpose(StrEnum):
    """Why a robot was told to look."""

    CHOOSE = "choose"
    BASELINE = "baseline"
    WATCH = "watch"
    VIEW = "view"
    HELP = "help"
    PERSON = "person"
    RESUME = "resume"
    LAST = "last"


JUDGING = (Purpose.CHOOSE, Purpose.BASELINE, Purpose.RESUME, Purpose.PERSON, Purpose.LAST)
"""Looks before something is built or asked: they judge what is finished as well."""


FRESH_S = 1.0
"""What was seen so long ago still holds (the run's clock)."""


class CommandSender(Protocol):
    """The service's end of the robot link."""

    def send(
        self, robot: str, command_id: str, body: CommandBody, *, renews: bool = True
    ) -> None: ...


@dataclass(slots=True)
class RobotProxy:
    """A robot's activity; nothing here is durable, all of it follows from its next reports.

    What it sees and where it is told to place is in its own base frame on the link, and in the
    scene's here.
    """

    robot: str
    link: CommandSender
    frame: Frame = field(default_factory=Frame)
    team: Team | None = None
    stands_somewhere: bool = True
    """Whether the scene says where it stands."""
    area: BaseGeometry | None = None
    """What space it has beyond where its arm rests; `Team` says when it may have it."""
    doing: RobotActivity = RobotActivity.ABSENT
    hello: Hello | None = None
    driven: Driven | None = None
    """What its base has driven since it booted, as it said last."""
    gone_for_good: bool = False
    restarts: int = 0
    livelock: Livelock = field(default_factory=Livelock)
    silent_since: float | None = None
    """Since when nothing has come of what it was told (the run's clock); None: not yet known."""
    command: str | None = None
    purpose: Purpose | None = None
    holds_execution: bool = False
    seen: dict[str, Sighting] = field(default_factory=dict)
    last_seen: dict[str, tuple[float, Sighting]] = field(default_factory=dict)
    """When (the run's clock) and where it last saw each thing that it ever saw."""
    seen_at: float = -math.inf
    """When it last saw anything (the run's clock)."""
    brought: bool | None = None
    """Whether what its fingers had lost was seen elsewhere than at the last look, before that."""
    gripper: Point = (0.0, 0.0, 0.0)
    held: str | None = None
    looked_at: float | None = None
    """When it last judged what is finished; None if that is out of date."""
    finished: list[FinishedResult] = field(default_factory=list)
    """The results that there are to judge now."""
    there: frozenset[FinishedResult] = frozenset()
    """Of the results that the last look judged, those that it saw to be so."""
    blind: str | None = None
    """Why the last look saw nothing of the table."""
    felt: FeltLoad | None = None
    """What its basket felt at the last look, where that was not what was looked for."""
    jpeg: bytes | None = None
    """What the camera showed at the last look, where that did not see what it looked for,"""
    detection: Detection | None = None
    """and where in that picture the object was, and was to be."""
    led_round: bool = False
    """Whether the last look saw that another way leads round what is in the way."""

    @property
    def room(self) -> RoomLimits | None:
        """What room its arm takes, from where it stands; None: nobody knows."""
        return self.hello.room if self.hello is not None and self.stands_somewhere else None

    @property
    def keeps_clear(self) -> bool:
        """Whether it keeps clear of others itself, so that no space is reserved for it."""
        return self.hello is not None and self.hello.keeps_clear

    @property
    def free(self) -> bool:
        """Whether it may be told something new without cutting short what it does."""
        return self.doing is RobotActivity.IDLE

    @property
    def interruptible(self) -> bool:
        """Whether it only lets time pass, so that a new command may replace what it does."""
        return self.doing is RobotActivity.WAITING or (
            self.doing is RobotActivity.LOOKING
            and self.purpose in (Purpose.BASELINE, Purpose.WATCH, Purpose.VIEW, Purpose.PERSON)
        )

    @property
    def owes_a_report(self) -> bool:
        """Whether it was told something of which a report is still to come.

        Of one that was given up only that its arm rests, where others wait for that.
        """
        busy = self.doing in (
            RobotActivity.LOOKING,
            RobotActivity.WORKING,
            RobotActivity.RETREATING,
        )
        return busy and (not self.gone_for_good or self.area is not None)

    def suitability(self, behavior: str) -> float:
        """How well it can do a behavior; 0 if it cannot."""
        if self.gone_for_good or self.hello is None or behavior not in self.hello.behaviors:
            return 0.0
        return self.hello.suitability.get(behavior, 1.0)

    def connect(self, hello: Hello) -> None:
        self.hello = hello
        self.driven = hello.driven
        self.looked_at = None
        self.command = self.purpose = None
        executing = hello.executing
        self.holds_execution = executing is not None and executing.state == "holding"
        if executing is None:
            self.area = None
        elif self.area is None:
            self.area = EVERYWHERE
        if executing is None or self.holds_execution:
            self.doing = RobotActivity.IDLE
        elif executing.state == "retreating":
            self.doing = RobotActivity.RETREATING
        else:
            self.doing = RobotActivity.WORKING

    def hold_execution(self, holding: Holding) -> None:
        """It has stopped; away from neutral it keeps what it was executing."""
        self.holds_execution = holding.execution is not None and holding.at != "neutral"
        if holding.at == "neutral":
            self.area = None
        if self.doing in (RobotActivity.WORKING, RobotActivity.RETREATING):
            self.doing = RobotActivity.IDLE

    def finish(self) -> None:
        """It is through with what it was executing, and its arm rests."""
        self.doing = RobotActivity.IDLE
        self.area = None

    def disconnect(self) -> None:
        self.doing = RobotActivity.ABSENT

    def _tell(self, doing: RobotActivity, command: str, body: CommandBody) -> None:
        self.doing, self.command = doing, command
        self.silent_since = None
        self.link.send(self.robot, command, body, renews=self.livelock.tell())

    def look(self, purpose: Purpose, **fields: Any) -> None:
        """Look, for a purpose; `fields` are those of the `look` command."""
        self.purpose = purpose
        if purpose in JUDGING:
            fields["finished"] = [*fields.get("finished", ()), *self.finished]
        self._tell(RobotActivity.LOOKING, str(uuid4()), Look(**fields))

    def give_up_look(self) -> None:
        """Whatever it is told next replaces the look for help that is under way."""
        if self.doing is RobotActivity.LOOKING and self.purpose in (Purpose.HELP, Purpose.VIEW):
            self.doing = RobotActivity.IDLE

    def looked_just_now(self, now: float) -> bool:
        """Whether what it saw and judged last still holds."""
        return self.looked_at is not None and now - self.looked_at <= FRESH_S

    def hold(self, until: float, rate: float | None) -> None:
        """Simulated worlds: let time pass until `until` (the robot's clock)."""
        self._tell(RobotActivity.WAITING, str(uuid4()), Hold(until=until, rate=rate))

    def start(
        self,
        execution: StartedExecution,
        node: str,
        behavior: str,
        parameters: dict[str, Any],
        size: tuple[float, float, float] | None,
        target: Location | None,
        was_done: WasDone | None,
        finished: list[FinishedResult],
        object_at: Flat | None,
    ) -> None:
        """Start; `object_at`: where others expect it to take its object from (scene's frame)."""
        self.looked_at = None
        self.holds_execution = False
        self._tell(
            RobotActivity.WORKING,
            str(execution.id),
            Start(
                execution=str(execution.id),
                node=node,
                behavior=behavior,
                parameters=parameters,
                size=size,
                target=None if target is None else _in_base(self.frame, target),
                was_done=was_done,
                finished=finished,
                object_at=self._point_in_base(object_at),
            ),
        )

    def resume(self, execution: StartedExecution, object_at: Flat | None) -> None:
        """Go on; `object_at` as in `start`."""
        self.holds_execution = False
        body = Resume(execution=str(execution.id), object_at=self._point_in_base(object_at))
        self._tell(RobotActivity.WORKING, str(uuid4()), body)

    def _point_in_base(self, point: Flat | None) -> Flat | None:
        return None if point is None else self.frame.to_robot(*point)

    def stop(self) -> None:
        """Stop where it is."""
        self._tell(RobotActivity.RETREATING, str(uuid4()), Interrupt(retreat=False))

    def retreat(self) -> None:
        """Stop, let go and move to neutral; ends what it was executing."""
        self.holds_execution = False
        self._tell(RobotActivity.RETREATING, str(uuid4()), Interrupt(retreat=True))

    def intervene(self, command: str, deed: Intervention, by: str, at: float | None) -> None:
        """Simulated worlds: a person does something, now or at `at` (the robot's clock)."""
        self.link.send(self.robot, command, Intervene(intervention=deed, by=by, at=at))

    def take_look(self, looked: Looked, time: float) -> Purpose | None:
        """Note what a look saw; returns its purpose if it is the look that was last asked for."""
        self.blind = looked.blind
        if looked.blind is None:
            self.seen = _in_scene(self.frame, looked.objects)
            self.seen_at = time
            self.last_seen |= {name: (time, each) for name, each in self.seen.items()}
        self.held, self.felt = looked.held, looked.felt
        self.jpeg, self.detection = _shown_at(looked), looked.detection
        self.led_round, self.brought = looked.led_round, looked.brought
        self.there = frozenset(looked.there)
        self.gripper = (
            *self.frame.to_scene(looked.gripper.x, looked.gripper.y),
            looked.gripper.z,
        )
        if looked.command != self.command or self.doing is not RobotActivity.LOOKING:
            return None
        self.doing = RobotActivity.IDLE
        if self.purpose in JUDGING:
            self.looked_at = time
        return self.purpose


def _shown_at(looked: Looked) -> bytes | None:
    """The picture that a look came with; None where there is none that anybody could look at."""
    if looked.jpeg is None:
        return None
    try:
        return read_jpeg(looked.jpeg)
    except NotJpegError as error:
        log.warning("a robot's picture %s", error)
        return None


def _in_scene(frame: Frame, seen: Mapping[str, Sighting]) -> dict[str, Sighting]:
    if frame == Frame():
        return dict(seen)
    return {name: _turned(frame, each) for name, each in seen.items()}


def _turned(frame: Frame, seen: Sighting) -> Sighting:
    x, y = frame.to_scene(seen.x, seen.y)
    return seen.model_copy(update={"x": x, "y": y, "yaw": seen.yaw + frame.yaw})


def _in_base(frame: Frame, target: Location) -> Location:
    x, y = frame.to_robot(target.x, target.y)
    return target.model_copy(update={"x": x, "y": y, "yaw": target.yaw - frame.yaw})
