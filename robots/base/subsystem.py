"""A base that drives, as a subsystem of a robot."""

import math
from collections.abc import Callable, Collection, Mapping, Sequence

from mend.robots.base.base import Base
from mend.robots.base.basket import Basket
from mend.robots.base.battery import Battery
from mend.robots.base.behaviors.behavior import (
    BaseBehavior,
    BaseSituation,
    BaseStep,
    Drive,
    RideUntilThere,
    steps_to,
)
from mend.robots.base.behaviors.execution import BaseExecution
from mend.robots.base.body import BaseBody, BasePose
from mend.robots.base.companion import Companion
from mend.robots.base.elevators import Elevators
from mend.robots.base.looks import answer, look_as_told
from mend.robots.base.made_way import MadeWay
from mend.robots.base.monitors.monitor import BaseView
from mend.robots.base.ways import StraightWays, Ways
from mend.robots.base.whereabouts import Whereabouts
from mend.robots.body import CameraImage
from mend.robots.catalogue import Catalogue
from mend.robots.execution.behavior import Behavior, of_kind, read_parameters
from mend.robots.execution.command_error import CommandError
from mend.robots.execution.execution import AnyExecution
from mend.robots.execution.monitor import AnyMonitor, for_view
from mend.robots.execution.routine import Routine
from mend.robots.link.messages import (
    Avoid,
    BaseLimits,
    Detection,
    Driven,
    Location,
    Look,
    Looked,
    MakeWay,
    NoteTaken,
    PoseLayout,
    Poses,
    ReportBody,
    Start,
)


class BaseSubsystem:
    """A `Subsystem`: what a base does on a floor, as its laser senses it."""

    reach = None
    room = None
    keeps_clear = True

    def __init__(
        self,
        body: BaseBody,
        catalogue: Catalogue,
        behaviors: Mapping[str, type[Behavior]],
        monitors: Mapping[str, type[AnyMonitor]],
        ways: Ways | None = None,
        elevators: Elevators | None = None,
        whereabouts: Whereabouts | None = None,
        basket: Basket | None = None,
        battery: Battery | None = None,
        companion: Companion | None = None,
    ) -> None:
        """It takes those of bases. Without `ways` it goes straight to each goal.

        Without `whereabouts` it always believes its body's pose, without `basket` it has none, and
        without `companion` it escorts nobody.
        """
        ways = ways or StraightWays()
        self.effector = Base(body, ways, elevators, whereabouts, basket, battery, companion)
        self._places = {name: _pose(each) for name, each in catalogue.places.items()}
        self._behaviors = of_kind(behaviors, BaseBehavior)  # type: ignore[type-abstract]
        self._monitors = for_view(monitors.values(), BaseView)

    @property
    def behaviors(self) -> Collection[str]:
        return self._behaviors

    @property
    def driven(self) -> Driven:
        return self.effector.driven()

    @property
    def avoids_ways(self) -> bool:
        """Whether it knows ways by names, so that it keeps off those that it is told of."""
        return self.effector.ways.has_places

    def avoid(self, told: Avoid) -> None:
        """Keep off ways where others lead."""
        ways = {frozenset(each.between): each.until for each in told.ways}
        self.effector.closed.tell(ways)
        self.effector.asks_after_s = told.asks_after_s
        self.effector.failed = {each.robot: (each.x, each.y, each.z) for each in told.failed}

    @property
    def base(self) -> BaseLimits:
        body = self.effector.body
        return BaseLimits(radius_m=body.radius_m, speed_m_s=body.limits.speed_m_s)

    def make_way(self, told: MakeWay) -> None:
        """Do so in the drive under way; who is not driving bars nobody's way for long."""
        way = [(each.x, each.y) for each in told.way]
        self.effector.made_way = MadeWay(way, told.z, told.until)

    @property
    def notes_taken(self) -> bool:
        """Whether it has a basket."""
        return self.effector.basket.most_items > 0

    def note_taken(self, told: NoteTaken) -> None:
        """Forget what was taken out of its basket for others."""
        for item in told.items:
            self.effector.basket.memory.forget(item)

    @property
    def between_floors(self) -> bool:
        """Whether it is in a cabin that is under way."""
        ways = self.effector.ways
        return ways.has_places and ways.floor(self.effector.body.pose()) is None

    def execution_of(self, start: Start, report: Callable[[ReportBody], None]) -> BaseExecution:
        """What a start command asks for, not begun. Raises `CommandError`."""
        behavior = self._behaviors[start.behavior]()
        parameters = read_parameters(type(behavior), start)
        target = self._target(getattr(parameters, "place", None), start.target)
        situation = self._situation(target)
        steps = behavior.steps(parameters, situation)
        if not self.effector.whereabouts.is_lost:
            self._check_ways(situation.here, steps)
        return BaseExecution(
            start.execution,
            behavior.monitored_as,
            steps,
            self.effector,
            [each.create({}) for each in self._monitors],
            report,
        )

    def look(
        self,
        command: str,
        look: Look,
        held: AnyExecution | None,
        report: Callable[[ReportBody], None],
    ) -> Routine[Looked]:
        """The routine of a look. Raises `CommandError`."""
        if held is None and look.expect == "way_clear" and look.place in self._places:
            held = self._way_laid_out(command, look.place, report)
        return look_as_told(self.effector, command, look, held)

    def _way_laid_out(
        self, command: str, place: str, report: Callable[[ReportBody], None]
    ) -> BaseExecution:
        """What is before one that has begun anew, and has lost what it was doing."""
        there = self._places[place]
        try:
            steps = steps_to(place, self._situation(there))
        except CommandError:
            # Whether a way comes to lead there it sees as it looks.
            steps = [Drive(f"go to {place}", there)]
        execution = BaseExecution(command, "", steps, self.effector, [], report)
        execution.pass_by()
        return execution

    def sought_in(self, camera: str, image: CameraImage) -> Detection | None:  # noqa: ARG002
        """It looks with its laser, and feels."""
        return None

    def glance(self, command: str, held: AnyExecution | None) -> Looked:  # noqa: ARG002
        """Where it is now."""
        return answer(self.effector, command, None)

    def retreat(self) -> Routine[None]:
        """A base rests where it stands."""
        self.effector.stop()
        yield from self.effector.settle()

    def film(self) -> None:
        """It has no camera that looks at what it does."""

    @property
    def clip(self) -> Sequence[CameraImage]:
        """Nothing."""
        return ()

    def layout(self, layout: PoseLayout) -> PoseLayout:
        """The base frame moves."""
        return layout.model_copy(update={"drives": True})

    def show(self, poses: Poses) -> Poses:
        """Where the base frame is, on which floor, how sure it is of that, and its battery."""
        here = self.effector.body.pose()
        half = here.yaw / 2
        base = (here.x, here.y, here.z, 0.0, 0.0, math.sin(half), math.cos(half))
        known = self.effector.whereabouts.covariance()
        covariance = None if known is None else list(known)
        battery = self.effector.battery
        share = None if battery.endless else battery.share
        following, waits = self.effector.following, self.effector.may_stand_aside
        barred = following.barred if following is not None else False if waits else None
        shown = {"base": base, "covariance": covariance, "battery": share, "barred": barred}
        return poses.model_copy(update=shown)

    def note(self, looked: Looked) -> None:
        """What others located does not concern it."""

    def _situation(self, target: BasePose | None) -> BaseSituation:
        return BaseSituation(
            here=self.effector.body.pose(),
            places=self._places,
            target=target,
            ways=self.effector.ways,
            basket=self.effector.basket,
            closed=self.effector.closed.at(self.effector.body.time_s()),
            waits_s=self.effector.elevators.waits_s(),
            companion=self.effector.companion,
        )

    def _check_ways(self, here: BasePose, steps: Sequence[BaseStep]) -> None:
        """Raises `CommandError` where there is no way from one goal to the next."""
        for step in steps:
            match step:
                case Drive():
                    self.effector.ways.path(here, step.to)
                    here = step.to
                case RideUntilThere():
                    here = step.ride.there

    def _target(self, place: str | None, told: Location | None) -> BasePose | None:
        if told is not None:
            return _pose(told)
        if place is None:
            return None
        if place not in self._places:
            raise CommandError(f"place '{place}' is unknown, and the command gives no target")
        return self._places[place]


def _pose(location: Location) -> BasePose:
    return BasePose(location.x, location.y, location.yaw, location.z or 0.0)
