"""The body of a robot that drives through a building."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from mend.robots.base.body import STANDING, BasePose, DriveLimits, RangeScan, Velocity
from mend.robots.base.whereabouts import AlwaysKnown, Whereabouts
from mend.robots.body import Camera
from mend.sim.building.belief import Belief
from mend.sim.building.floor_pose import FloorPose
from mend.sim.building.laser import PERIOD_S as SCAN_PERIOD_S
from mend.sim.building.odometry import Odometer
from mend.tasks.frames import Frame

RADIUS_M = 0.25
PERIOD_S = 0.05
LIMITS = DriveLimits(
    speed_m_s=1.0,
    acceleration_m_s2=1.0,
    turn_rad_s=1.5,
    turn_acceleration_rad_s2=2.0,
    sideways=True,
)


@dataclass(frozen=True, slots=True)
class Senses:
    """What the world does for a robot: `scan` from where it is, and time that passes for all."""

    time_s: Callable[[], float]
    height_m: Callable[[str], float]
    scan: Callable[["BuildingRobot"], RangeScan]
    pass_cycle: Callable[[], None]


class BuildingRobot:
    """Implements `mend.robots.base.body.BaseBody`; it goes sideways.

    Without a `belief` it knows where it is.
    """

    radius_m = RADIUS_M
    limits = LIMITS
    scan_period_s = SCAN_PERIOD_S
    control_period_s = PERIOD_S
    cameras: Mapping[str, Camera] = {}

    def __init__(
        self,
        frame: Frame,
        at: FloorPose,
        senses: Senses,
        odometer: Odometer,
        belief: Belief | None = None,
    ) -> None:
        self._frame = frame
        self.odometer, self.belief = odometer, belief
        self._senses = senses
        self._wanted = self._now = STANDING
        self.time_s = senses.time_s
        self.advance_cycle = senses.pass_cycle
        self.at = at
        """Where it really is."""

    # --- What it knows ------------------------------------------------------------------------

    def pose(self) -> BasePose:
        """In its base frame: that in which it stood at the start.

        How high it is it knows by air pressure, whatever floor it believes to be on.
        """
        at = self.at if self.belief is None else self.belief.at
        x, y = self._frame.to_robot(at.x, at.y)
        yaw = math.remainder(at.yaw - self._frame.yaw, math.tau)
        return BasePose(x, y, yaw, self._senses.height_m(self.at.floor))

    def odometry(self) -> BasePose:
        """Where its wheels say that it has come to since it was switched on."""
        return BasePose(*self.odometer.pose)

    @property
    def whereabouts(self) -> Whereabouts:
        """How far it may believe its pose."""
        return AlwaysKnown() if self.belief is None else self.belief.whereabouts

    def velocity(self) -> Velocity:
        return self._now

    def scan(self) -> RangeScan:
        return self._senses.scan(self)

    @property
    def moving(self) -> bool:
        return self._now != STANDING or self._wanted != STANDING

    # --- What it is told ----------------------------------------------------------------------

    def move(self, velocity: Velocity) -> None:
        self._wanted = velocity

    def stop(self) -> None:
        self._wanted = STANDING

    # --- Time ---------------------------------------------------------------------------------

    def stand(self, at: FloorPose) -> None:
        """Be somewhere else, standing: carried there, or after a restart."""
        self.at, self._now, self._wanted = at, STANDING, STANDING

    def ride(self, room: str) -> None:
        """Be in a cabin that is shut, where its laser tells nothing of where it is."""
        self.at = replace(self.at, floor=room)

    def get_out_at(self, floor: str, shift: tuple[float, float]) -> None:
        """Be on a floor, where a shaft is so much shifted (metres), and know that."""
        x, y = shift
        self.at = replace(self.at, floor=floor, x=self.at.x + x, y=self.at.y + y)
        if self.belief is not None:
            self.belief.enter(floor, shift)

    def drive_to(self, at: FloorPose) -> None:
        """Get there, which its wheels measure."""
        x, y = at.x - self.at.x, at.y - self.at.y
        turned = math.remainder(at.yaw - self.at.yaw, math.tau)
        heading = self.at.yaw + turned / 2.0
        cos, sin = math.cos(heading), math.sin(heading)
        self.odometer.drive(cos * x + sin * y, cos * y - sin * x, turned)
        self.at = at

    def next_pose(self) -> FloorPose:
        """Where it is to be one control cycle later, if nothing holds it up."""
        now = self._now = nearest_reached(self._now, self._wanted, LIMITS, PERIOD_S)
        turned = now.turn_rad_s * PERIOD_S
        forward_m, left_m = now.forward_m_s * PERIOD_S, now.left_m_s * PERIOD_S
        heading = self.at.yaw + turned / 2.0
        return replace(
            self.at,
            x=self.at.x + forward_m * math.cos(heading) - left_m * math.sin(heading),
            y=self.at.y + forward_m * math.sin(heading) + left_m * math.cos(heading),
            yaw=math.remainder(self.at.yaw + turned, math.tau),
        )

    def bump(self) -> None:
        """It drove against something, and stands."""
        self._now = STANDING


def nearest_reached(
    now: Velocity, wanted: Velocity, limits: DriveLimits, period_s: float
) -> Velocity:
    """Of the velocities that are reached within a period the one that is nearest to the wanted."""
    forward, left = wanted.forward_m_s - now.forward_m_s, wanted.left_m_s - now.left_m_s
    share = min(1.0, limits.acceleration_m_s2 * period_s / max(math.hypot(forward, left), 1e-12))
    most = limits.turn_acceleration_rad_s2 * period_s
    turn = max(-most, min(most, wanted.turn_rad_s - now.turn_rad_s))
    return Velocity(
        now.forward_m_s + share * forward, now.left_m_s + share * left, now.turn_rad_s + turn
    )
