"""What a fault monitor of a base is, and all that it may look at."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import ClassVar, TypeVar

from mend.documents.strict_model import StrictModel
from mend.robots.base.body import BasePose, RangeScan
from mend.robots.base.companion import Sighting
from mend.robots.base.ways import Ride
from mend.robots.execution.monitor import Monitor, MonitorView

P = TypeVar("P", bound=StrictModel)


@dataclass(frozen=True, slots=True, kw_only=True)
class AwaitedElevator:
    """An elevator that a base waits for, or in which it waits (`aboard`), for `waited_s` so far.

    `is_open` for it; `was_shut`: it has been seen shut since. `floor`: where the base is, None
    between floors. `failed`: the robot that stands in the cabin and works no more.
    """

    ride: Ride
    aboard: bool
    is_open: bool
    was_shut: bool
    floor: str | None
    waited_s: float
    failed: str | None = None


@dataclass(frozen=True, slots=True)
class StandingFor:
    """Who stands at a place for people for `waited_s` so far: to put in or take out an item.

    Without one it has told a message, waits for a person, or is charged.
    """

    item: str | None
    place: str | None
    waited_s: float


@dataclass(frozen=True, slots=True)
class Left:
    """Whom a base leads does not follow: for `waited_s` so far; where they were seen `last`."""

    waited_s: float
    last: Sighting | None


@dataclass(frozen=True, slots=True)
class Power:
    """What the gauge of a battery tells: the `share` that it holds, and whether current comes in.

    `to_charger`: the base is on its way there, or at one.
    """

    share: float = 1.0
    charging: bool = False
    to_charger: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class BaseView(MonitorView):
    """What a base senses at one moment.

    `pose` is where it is and `goal` where the step under way leads, None before the first.
    `in_the_way_m` is how far what leaves it no way on is from its rim, None where it gets on or
    round, and `door` what its map calls that, if it is a door; `waited_s` how long it has stood
    before it. `stalled_s`: how long it has come no nearer, although nothing bars its way. `no_way`:
    why it knows no way to the goal. `elevator`: what it waits for, if that is one. `lost_s`: how
    long it has not known where it is; `guesses` says where it may be then, likeliest first (`at
    F1-101`). `standing`: what it waits for people to do. `lacks`: what it is to hand over and was
    not given; `missing_kg`: how much less there is in its basket than it was given. `between`: the
    neighbouring places between which is what leaves it no way on. `left`: it waits for whom it
    leads. `robot`: the one that has failed and leaves it no way on, if it is one.
    """

    pose: BasePose
    goal: BasePose | None
    in_the_way_m: float | None
    door: str | None
    waited_s: float
    stalled_s: float
    no_way: str | None
    elevator: AwaitedElevator | None
    scan: RangeScan
    lost_s: float = 0.0
    guesses: Callable[[], Sequence[str]] = tuple
    standing: StandingFor | None = None
    lacks: str | None = None
    missing_kg: float = 0.0
    power: Power = Power()
    between: tuple[str, str] | None = None
    left: Left | None = None
    robot: str | None = None


class BaseMonitor(Monitor[P, BaseView]):
    """A monitor of a base's behaviors; it checks at the laser's period."""

    view: ClassVar[type[MonitorView]] = BaseView
