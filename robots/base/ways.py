"""The ways that a base knows: which points to pass to a pose."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from mend.robots.base.body import BasePose
from mend.robots.base.closed_ways import NO_WAYS, Closed, Lane
from mend.robots.base.motion.surroundings import NOTHING, Points
from mend.robots.base.open_door import Posts

NO_WAITS: Mapping[str, float] = {}


@dataclass(frozen=True, slots=True)
class Ride:
    """A ride in an elevator from floor to floor; poses in the base's frame on the link.

    One waits at `wait_at`, None for who is in the cabin already, gets in to `inside`, is `there`
    once it has arrived, and gets out to `out_at`. `called`: whether the robot itself can call it;
    people must otherwise. `between`: where it stops then, by the names of the map. `aside`: where
    in the cabin it leaves room for a person, None where there is none for both.
    """

    elevator: str
    from_floor: str
    to_floor: str
    wait_at: BasePose | None
    inside: BasePose
    there: BasePose
    out_at: BasePose
    called: bool
    between: tuple[str, str] = ("", "")
    aside: BasePose | None = None


class Ways(Protocol):
    """What knows of ways, in the base's frame on the link: a map, or none.

    They lead by what is `closed` only where no other way leads on, and then by as little of it as
    there is.
    """

    @property
    def has_places(self) -> bool:
        """Whether it knows places by names, between which ways may be closed."""
        ...

    def path(
        self, here: BasePose, to: BasePose, closed: Closed = NO_WAYS
    ) -> Sequence[tuple[float, float]]:
        """The points to pass from `here`, straight from one to the next; the last is the goal's.

        Raises `CommandError` where there is no way.
        """
        ...

    def rides(
        self,
        here: BasePose,
        to: BasePose,
        closed: Closed = NO_WAYS,
        waits_s: Mapping[str, float] = NO_WAITS,
    ) -> Sequence[Ride]:
        """The rides to take from one pose to another; none where both are on one floor.

        `waits_s`: how much longer each elevator takes now. Raises `CommandError` where there is no
        way.
        """
        ...

    def leads_round(self, here: BasePose, to: BasePose, closed: Closed) -> bool:
        """Whether a way leads to a pose on the same floor by nothing that is closed."""
        ...

    def together(self, between: tuple[str, str]) -> Collection[Lane]:
        """The ways that are closed with one: of an elevator all its rides."""
        ...

    def along(self, lane: Lane, here: BasePose) -> Mapping[str, float] | None:
        """How far a pose on a lane is from each of its ends (m); None beside it."""
        ...

    def way_out(self, here: BasePose) -> BasePose | None:
        """Where to get out of the cabin that a pose is in; None where that is in none."""
        ...

    def elevator_at(self, pose: BasePose) -> str | None:
        """The elevator in whose cabin a pose of any floor is; None where it is in none."""
        ...

    def floor(self, pose: BasePose) -> str | None:
        """What the floor of a pose is called; None where there is none."""
        ...

    def walls(self, here: BasePose) -> Points:
        """Points (n, 2) of the walls around a pose."""
        ...

    def door_at(self, here: BasePose, ahead: tuple[float, float]) -> str | None:
        """The door between a pose and a point ahead; None where there is none."""
        ...

    def posts(self, door: str, here: BasePose) -> Posts | None:
        """Where a door of the floor of a pose hangs: of an elevator right across its cabin.

        None for who is in that cabin.
        """
        ...

    def lane_at(self, here: BasePose, ahead: tuple[float, float]) -> tuple[str, str] | None:
        """The neighbouring places between which a pose and a point ahead are, the one behind first.

        None where both are on no one lane.
        """
        ...


class StraightWays:
    """The way of who knows of no walls: straight to the goal."""

    has_places = False

    def path(
        self,
        here: BasePose,  # noqa: ARG002
        to: BasePose,
        closed: Closed = NO_WAYS,  # noqa: ARG002
    ) -> Sequence[tuple[float, float]]:
        """Nothing but the goal."""
        return [(to.x, to.y)]

    def rides(
        self,
        here: BasePose,  # noqa: ARG002
        to: BasePose,  # noqa: ARG002
        closed: Closed = NO_WAYS,  # noqa: ARG002
        waits_s: Mapping[str, float] = NO_WAITS,  # noqa: ARG002
    ) -> Sequence[Ride]:
        """None: it knows one floor."""
        return ()

    def leads_round(self, here: BasePose, to: BasePose, closed: Closed) -> bool:  # noqa: ARG002
        """Never: it knows of one way."""
        return False

    def together(self, between: tuple[str, str]) -> Collection[Lane]:
        """That one alone."""
        return [frozenset(between)]

    def along(self, lane: Lane, here: BasePose) -> Mapping[str, float] | None:  # noqa: ARG002
        """None: it knows of no lanes."""
        return None

    def way_out(self, here: BasePose) -> BasePose | None:  # noqa: ARG002
        """None: it knows of no cabins."""
        return None

    def elevator_at(self, pose: BasePose) -> str | None:  # noqa: ARG002
        """None: it knows of none."""
        return None

    def floor(self, pose: BasePose) -> str | None:  # noqa: ARG002
        """It has no name."""
        return None

    def walls(self, here: BasePose) -> Points:  # noqa: ARG002
        """None: it knows of none."""
        return NOTHING

    def door_at(self, here: BasePose, ahead: tuple[float, float]) -> str | None:  # noqa: ARG002
        """None: it knows of no doors."""
        return None

    def posts(self, door: str, here: BasePose) -> Posts | None:  # noqa: ARG002
        """None: it knows of no doors."""
        return None

    def lane_at(self, here: BasePose, ahead: tuple[float, float]) -> tuple[str, str] | None:  # noqa: ARG002
        """None: it knows of no lanes."""
        return None
