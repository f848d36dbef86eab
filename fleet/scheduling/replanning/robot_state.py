"""Where a robot of a fleet at work is, or will be as soon as it is free again."""

from dataclasses import dataclass, replace
from math import inf

from mend.fleet.scheduling.problem import Robot, Window
from mend.fleet.scheduling.schedule import Task
from mend.fleet.scheduling.travel import Travel


@dataclass(frozen=True, slots=True)
class Trip:
    """A robot is on its way since `leaves_s`. `keeps`: to its next stop, which still is to be made;
    otherwise to where that was."""

    origin: int
    leaves_s: float
    keeps: bool = True


@dataclass(slots=True)
class TrackedRobot:
    """A robot with its state: at `place` from `free_s` on, which may be to come.

    `trip`: it is on its way there; `left_s`: when it first left its start; `overtime_until_s`:
    until when it works although its shift would be over. Where stops are observed, `doing` is the
    stop that it has set out for, until somebody says what came of it, and `begun_s` when it began
    with it.
    """

    robot: Robot
    place: int
    free_s: float
    trip: Trip | None = None
    works: bool = True
    left_s: float | None = None
    overtime_until_s: float = -inf
    doing: Task | None = None
    begun_s: float | None = None

    @property
    def held(self) -> bool:
        """Whether it is on its way to a stop that it keeps."""
        return self.trip is not None and self.trip.keeps

    def let_go(self) -> None:
        """It goes where it is on its way to, but has nothing to do there any more."""
        if self.trip is not None:
            self.trip = replace(self.trip, keeps=False)

    def take_up(self) -> None:
        """What it is on its way to it is to do after all."""
        if self.trip is not None:
            self.trip = replace(self.trip, keeps=True)

    def available_s(self, now_s: float) -> float:
        """From when on it can do anything else, but for what it is on its way to."""
        return self.free_s if self.trip else max(self.free_s, now_s)

    def stand_at(self, place: int, since_s: float) -> None:
        """It is at a place and does nothing."""
        self.place, self.free_s = place, since_s
        self.trip = self.doing = self.begun_s = None

    def turn_at(self, turn: tuple[int, float], travel: Travel) -> None:
        """Where its way is closed it leaves it, at a place and time, and does something else.

        Where it is observed it goes on to where it is to do something, another way if there is one.
        """
        place, there_s = turn
        if self.doing is None:
            self.place, self.free_s, self.trip = place, there_s, None
            return
        trip = travel.trip(place, self.place, there_s, self.robot.speed)
        if trip.arrival_s < inf:
            self.free_s, self.trip = trip.arrival_s, Trip(place, there_s, self.held)
        else:
            self.place, self.free_s = place, there_s
            self.let_go()

    def shift_ends_s(self) -> float:
        """When it must be at its end, once it has left."""
        latest_s = self.robot.shift.latest_s
        if self.left_s is not None:
            latest_s = min(latest_s, self.left_s + self.robot.max_duration_s)
        return max(latest_s, self.overtime_until_s)

    def home_s(self, travel: Travel, leaves_s: float) -> float:
        """When it could be at its end, if it goes there from where it is (inf: never)."""
        if self.robot.end is None:
            return leaves_s
        return travel.trip(self.place, self.robot.end, leaves_s, self.robot.speed).arrival_s

    def stay_longer(self, travel: Travel, now_s: float) -> str | None:
        """Let the shift last until it is at its end, where that is over before; says why."""
        free_s = self.available_s(now_s)
        home_s = self.home_s(travel, free_s)
        needed_s = free_s if home_s == inf else home_s
        shift_ends_s = self.shift_ends_s()
        if self.left_s is None:
            shift_ends_s = min(shift_ends_s, free_s + self.robot.max_duration_s)
        if needed_s <= shift_ends_s:
            return None
        self.overtime_until_s = needed_s
        return (
            f"{self.robot.name} had to be at its end by {shift_ends_s:g} s, but cannot be there "
            f"before {needed_s:g} s"
        )

    def residual(self, travel: Travel, now_s: float, stuck_load: float) -> Robot:
        """What the robot can do from now on, with `stuck_load` on board that stays there."""
        free_s = self.available_s(now_s)
        home_s = self.home_s(travel, free_s)
        end = None if home_s == inf else self.robot.end
        unbound = self.left_s is not None or self.overtime_until_s > -inf
        return replace(
            self.robot,
            start=self.place,
            end=end,
            capacity=max(0.0, self.robot.capacity - stuck_load),
            shift=Window(free_s, self.shift_ends_s()),
            max_duration_s=inf if unbound else self.robot.max_duration_s,
        )
