"""Somebody whom a robot is to meet, and to lead from there."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import pairwise

from mend.documents.strict_model import StrictModel
from mend.sim.building.bystander import RADIUS_M
from mend.sim.building.floor_pose import FloorPose

Point = tuple[float, float]

AT_PLACE_M = 3.0
_STILL_M_S = 0.08
_LEAVES_S = 600.0
"""Whom nobody leads any more goes their own way after so long."""
_CRUMB_M = 0.25
_PASSED_M = 0.4


class GuestSnapshot(StrictModel):
    """A guest as they are kept; see `Guest`. Poses are floor, x, y."""

    person: str
    place: str
    at: tuple[str, float, float] | None
    speed_m_s: float
    late_s: float | None
    comes_s: float | None
    led: bool
    velocity: tuple[float, float]
    trail: list[tuple[float, float]]
    trail_floor: str
    paused_until_s: float
    thinks_s: float
    looks_s: float = 0.0
    left_s: float | None


@dataclass(slots=True)
class Guest:
    """Who is to be met at a `place`, and led from there.

    `where`: None until they have come, `late_s` after the robot (None: never), at `comes_s`.
    `trail`: the points by which they get to the robot, on `trail_floor`. They stand until
    `paused_until_s`, and look for another way from `looks_s` on. `left_s`: since when nobody leads
    them.
    """

    person: str
    place: str
    speed_m_s: float
    late_s: float | None
    where: FloorPose | None = None
    comes_s: float | None = None
    led: bool = False
    velocity: Point = (0.0, 0.0)
    trail: list[Point] = field(default_factory=list)
    trail_floor: str = ""
    paused_until_s: float = 0.0
    thinks_s: float = 0.0
    looks_s: float = 0.0
    left_s: float | None = None

    radius_m = RADIUS_M

    @property
    def at(self) -> FloorPose:
        assert self.where is not None, "they have come"
        return self.where

    @property
    def moving(self) -> bool:
        return math.hypot(*self.velocity) > _STILL_M_S

    def ride(self, room: str) -> None:
        self.where = replace(self.at, floor=room)

    def get_out_at(self, floor: str, shift: tuple[float, float]) -> None:
        at = self.at
        self.where = FloorPose(floor, at.x + shift[0], at.y + shift[1])

    def way_m(self, robot: FloorPose) -> float:
        """How far it is along the trail to the robot."""
        points = [(self.at.x, self.at.y), *self.trail, (robot.x, robot.y)]
        return sum(math.dist(a, b) for a, b in pairwise(points))

    def note(self, robot: FloorPose) -> None:
        """Remember where the robot is that leads them."""
        if robot.floor.startswith("/"):
            return
        if robot.floor != self.trail_floor:
            self.trail, self.trail_floor = [], robot.floor
        last = self.trail[-1] if self.trail else None
        if last is None or math.dist(last, (robot.x, robot.y)) >= _CRUMB_M:
            self.trail.append((robot.x, robot.y))

    def pass_on(self) -> None:
        """Forget what they have passed of the trail."""
        if self.at.floor != self.trail_floor:
            return
        here = self.at.x, self.at.y
        passed = [n for n, each in enumerate(self.trail) if math.dist(each, here) < _PASSED_M]
        if passed:
            del self.trail[: passed[-1] + 1]

    def waits_for(self, person: str, place: str, at: FloorPose | None) -> bool:
        """Whether they are this person and still wait at the place, which is `at`."""
        if (self.person, self.place) != (person, place):
            return False
        return self.where is None or (at is not None and is_at(self.where, at))

    def times_s(self) -> Iterator[float]:
        """When they come, think, walk on or go."""
        yield self.paused_until_s
        yield self.thinks_s
        if self.comes_s is not None:
            yield self.comes_s
        if self.left_s is not None:
            yield self.left_s + _LEAVES_S

    def has_gone(self, time_s: float) -> bool:
        return self.left_s is not None and time_s >= self.left_s + _LEAVES_S

    def snapshot(self) -> GuestSnapshot:
        """What they are rebuilt from."""
        return GuestSnapshot(
            person=self.person,
            place=self.place,
            at=None if self.where is None else (self.at.floor, self.at.x, self.at.y),
            speed_m_s=self.speed_m_s,
            late_s=self.late_s,
            comes_s=self.comes_s,
            led=self.led,
            velocity=self.velocity,
            trail=list(self.trail),
            trail_floor=self.trail_floor,
            paused_until_s=self.paused_until_s,
            thinks_s=self.thinks_s,
            looks_s=self.looks_s,
            left_s=self.left_s,
        )


def guest_of(kept: GuestSnapshot) -> Guest:
    """A guest as they were."""
    return Guest(
        person=kept.person,
        place=kept.place,
        speed_m_s=kept.speed_m_s,
        late_s=kept.late_s,
        where=None if kept.at is None else FloorPose(*kept.at),
        comes_s=kept.comes_s,
        led=kept.led,
        velocity=kept.velocity,
        trail=list(kept.trail),
        trail_floor=kept.trail_floor,
        paused_until_s=kept.paused_until_s,
        thinks_s=kept.thinks_s,
        looks_s=kept.looks_s,
        left_s=kept.left_s,
    )


def is_at(at: FloorPose, place: FloorPose) -> bool:
    """Whether somebody is where they are looked for at a place."""
    return at.floor == place.floor and math.dist((at.x, at.y), (place.x, place.y)) < AT_PLACE_M
