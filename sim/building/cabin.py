"""The cabin of an elevator: it comes to whoever's turn it is, and takes along who is in it."""

from collections.abc import Hashable, Sequence
from dataclasses import dataclass, field
from enum import StrEnum

from mend.maps.building.building import Caller, Elevator
from mend.maps.building.cabin import CABIN_DOOR_S
from mend.tasks.transitions import Transitions

HELD_S = 60.0
"""So long it stands open for who does not get in."""


class CabinState(StrEnum):
    """What a cabin does: it stands shut or open at a floor, or is on its way to another."""

    SHUT = "shut"
    OPEN = "open"
    MOVING = "moving"


_CHANGES = Transitions(
    "a cabin",
    {
        CabinState.SHUT: {CabinState.OPEN, CabinState.MOVING},
        CabinState.OPEN: {CabinState.SHUT},
        CabinState.MOVING: {CabinState.OPEN},
    },
)


@dataclass(slots=True)
class Call:
    """A robot by its number wants from floor to floor.

    `to`: the floor whose button was pressed, None until somebody has pressed one. `stay_open`:
    who is in it waits for somebody else.
    """

    robot: int
    begin: str
    wants: str
    to: str | None
    stay_open: bool = False


@dataclass(slots=True)
class Cabin:
    """`order`: all floors, the lowest first; `floor`: where it is, or was before it left.

    `since_s`: when it opened, or left; `until_s`: when its door has moved, or it arrives. `calls`
    in the order in which they came.
    """

    name: str
    plan: Elevator
    order: Sequence[str]
    floor: str
    state: CabinState = CabinState.SHUT
    until_s: float = 0.0
    since_s: float = 0.0
    heading_for: str | None = None
    calls: list[Call] = field(default_factory=list)
    aboard: Sequence[int] = ()
    """The robots that stood in it in the last cycle."""
    misdirected: bool = False
    """Who rides next is taken to a wrong floor first."""

    def call(self, robot: int, begin: str, wants: str, *, stay_open: bool = False) -> None:
        """A robot wants a ride; it says so as often as it likes."""
        known = self.call_of(robot)
        if known is not None and known.wants == wants:
            known.stay_open = stay_open
            return
        self.withdraw(robot)
        to = wants if self.plan.called_by is Caller.ROBOTS else None
        self.calls.append(Call(robot, begin, wants, to, stay_open))

    def call_of(self, robot: int) -> Call | None:
        """What a robot wants of it."""
        return next((each for each in self.calls if each.robot == robot), None)

    def takes_s(self, call: Call) -> float:
        """How long it takes about to carry out a call."""
        floors = abs(self.order.index(call.begin) - self.order.index(call.wants))
        return self.plan.ride_s + floors * self.plan.floor_s

    def withdraw(self, robot: int) -> None:
        """A robot wants nothing of it any more."""
        self.calls = [each for each in self.calls if each.robot != robot]

    def is_open_at(self, floor: str) -> bool:
        """Whether one can get in and out there."""
        return self.state is CabinState.OPEN and self.floor == floor

    def is_open_for(self, robot: int, floor: str) -> bool:
        """Whether a robot may get in there: it is its turn, and nobody else is in it."""
        call, others = self.call_of(robot), [each for each in self.aboard if each != robot]
        is_its_turn = call is not None and self.serving(()) is call and not others
        return is_its_turn and self.is_open_at(floor)

    def share_of_way(self, time_s: float) -> float:
        """How much of its way to the next floor it has behind it."""
        if self.state is not CabinState.MOVING:
            return 0.0
        return min(1.0, (time_s - self.since_s) / max(self.until_s - self.since_s, 1e-9))

    def serving(self, inside: Sequence[int]) -> Call | None:
        """Whose turn it is: of who is in it, or else the first that was called for."""
        if inside:
            return next((each for each in self.calls if each.robot in inside and each.to), None)
        return next((each for each in self.calls if each.to), None)

    def pass_time(self, time_s: float, inside: Sequence[int], *, door_is_free: bool) -> bool:
        """One cycle; `inside` are the robots that stand in it. True when it has arrived."""
        self.aboard = inside
        if time_s < self.until_s:
            return False
        if self.state is CabinState.MOVING:
            assert self.heading_for is not None, "it moves to a floor"
            self.floor, self.heading_for = self.heading_for, None
            self._take_leave(inside)
            self._open(time_s)
            return True
        served = self.serving(inside)
        if self.state is CabinState.OPEN:
            self._hold_open(served, time_s, inside, door_is_free=door_is_free)
        elif served is not None:
            self._go(self._next_floor(served, inside), time_s)
        elif inside:
            # Whoever is in it wants nothing any more.
            self._open(time_s)
        return False

    def state_now(self) -> Hashable:
        """All that it does, for comparison."""
        calls = tuple((e.robot, e.begin, e.wants, e.to, e.stay_open) for e in self.calls)
        rest = self.since_s, self.heading_for, tuple(self.aboard), self.misdirected
        return self.floor, self.state, self.until_s, calls, *rest

    def changes_s(self) -> tuple[float, float]:
        """The times at which it may do something although nobody moves."""
        return self.until_s, self.since_s + HELD_S

    # --- Within -------------------------------------------------------------------------------

    def _hold_open(
        self, served: Call | None, time_s: float, inside: Sequence[int], *, door_is_free: bool
    ) -> None:
        """Shut once there is a reason to, and nobody stands in the door."""
        if served is None:
            # Whoever is inside wants nothing yet, or is to get out.
            if inside or not door_is_free:
                return
        elif served.robot in inside:
            if served.stay_open:
                return
            if served.to == self.floor:
                self._take_leave(inside)
                return
        elif served.begin == self.floor:
            if time_s < self.since_s + HELD_S:
                return
            self.withdraw(served.robot)
        if door_is_free:
            self.state = _CHANGES.require(self.state, CabinState.SHUT)
            self.until_s = time_s + CABIN_DOOR_S

    def _take_leave(self, inside: Sequence[int]) -> None:
        """Who is where they want to be wants nothing more; who is not waits for another button."""
        for call in [each for each in self.calls if each.robot in inside and each.to == self.floor]:
            if call.wants == self.floor:
                self.calls.remove(call)
            else:
                call.to = None

    def _next_floor(self, served: Call, inside: Sequence[int]) -> str:
        assert served.to is not None, "it was pressed"
        if served.robot not in inside:
            return served.begin
        if self.misdirected:
            self.misdirected = False
            served.to = self._wrong_floor(served)
        return served.to

    def _wrong_floor(self, served: Call) -> str:
        """The first other one; an elevator of two floors has only the one where it is."""
        others = (each for each in self.plan.stops if each not in (served.wants, self.floor))
        return next(others, self.floor)

    def _go(self, floor: str, time_s: float) -> None:
        if floor == self.floor:
            self._open(time_s)
            return
        floors = abs(self.order.index(floor) - self.order.index(self.floor))
        self.state = _CHANGES.require(self.state, CabinState.MOVING)
        self.heading_for, self.since_s = floor, time_s
        self.until_s = time_s + floors * self.plan.floor_s

    def _open(self, time_s: float) -> None:
        self.state = _CHANGES.require(self.state, CabinState.OPEN)
        self.since_s = time_s
        self.until_s = time_s + CABIN_DOOR_S
